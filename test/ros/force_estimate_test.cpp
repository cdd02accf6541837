#include "force_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace meshless_cutting {
namespace {

constexpr double kStep = 0.02;

ForceConfig Config() {
  ForceConfig config;
  config.toughness_j_m2 = 200;
  config.max_force_n = 3;
  config.max_slope_n_s = 1e4;
  return config;
}

// A blade of 0.04 m along z at x, which cut `area` in this frame.
ForceEstimate::Frame At(double x, double area, double depth = 0.02) {
  ForceEstimate::Frame frame;
  frame.trusted = true;
  frame.T_WT.translation().x() = x;
  frame.blade = {{x, 0, 0}, {x, 0, 0.04}};
  frame.time_step_s = kStep;
  if (area > 0) {
    StrokeEvent event;
    event.area_m2 = area;
    event.depth_m = depth;
    frame.events.push_back(event);
  }
  return frame;
}

TEST(ForceEstimateTest, CuttingTakesTheWorkOfTheToughness) {
  ForceEstimate estimate(Config());
  EXPECT_EQ(estimate.Update(At(0, 0)).force_n.norm(), 0);
  // 2 mm on, 2 mm x 20 mm cut: F = 200 J/m^2 * 4e-5 m^2 / 2e-3 m = 4 N, against the motion, limited to 3 N.
  const ToolWrench wrench = estimate.Update(At(0.002, 4e-5));
  EXPECT_NEAR(wrench.force_n.x(), -3, 1e-12);
  const ToolWrench half = estimate.Update(At(0.004, 2e-5));
  EXPECT_NEAR(half.force_n.x(), -2, 1e-12);
  // About the tool's origin, the force acts in the middle of the blade: z x (-x) = -y.
  EXPECT_NEAR(half.torque_nm.y(), -0.02 * 2, 1e-12);
  EXPECT_NEAR(estimate.Update(At(0.006, 0)).force_n.norm(), 0, 1e-12) << "nothing cut, no flat";
}

TEST(ForceEstimateTest, TheFlatIsPushedBackAndTheLipsGiveWay) {
  ForceConfig config = Config();
  config.toughness_j_m2 = 0;
  config.flat_normal = Eigen::Vector3d::UnitX();
  config.stiffness_n_m2 = 5000;
  config.relaxation_s = 0.2;
  ForceEstimate estimate(config);
  estimate.Update(At(0, 1e-6));
  // 5 mm aside, 20 mm inside: 5000 * 0.02 * 0.005 = 0.5 N, less what relaxed in the frame.
  const double pushed = estimate.Update(At(0.005, 0)).force_n.x();
  EXPECT_NEAR(pushed, -0.5 * std::exp(-kStep / 0.2), 1e-9);
  double last = pushed;
  for (int i = 0; i < 50; ++i) last = estimate.Update(At(0.005, 0)).force_n.x();
  EXPECT_NEAR(last, 0, 0.01) << "a second later";
}

TEST(ForceEstimateTest, ZeroAtOnceWhenNotTrusted) {
  ForceEstimate estimate(Config());
  estimate.Update(At(0, 0));
  EXPECT_GT(estimate.Update(At(0.002, 4e-5)).force_n.norm(), 1);
  ForceEstimate::Frame failed = At(0.004, 4e-5);
  failed.trusted = false;
  EXPECT_EQ(estimate.Update(failed).force_n.norm(), 0);
  estimate.Update(At(0.006, 0));
  EXPECT_GT(estimate.Update(At(0.008, 4e-5)).force_n.norm(), 1);
  ForceEstimate::Frame stale = At(0.010, 0);
  stale.blade.clear();
  EXPECT_EQ(estimate.Update(stale).force_n.norm(), 0);
  EXPECT_EQ(estimate.Update(At(0.5, 4e-5)).force_n.norm(), 0) << "no way is known after a gap";
}

TEST(ForceEstimateTest, NeverAboveItsLimits) {
  ForceConfig config = Config();
  config.max_slope_n_s = 20;
  config.flat_normal = Eigen::Vector3d::UnitX();
  ForceEstimate estimate(config);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (int i = 0; i < 5000; ++i) {
    ForceEstimate::Frame frame = At(0.01 * share(random), share(random) < 0.5 ? 1e-3 * share(random) : 0);
    if (share(random) < 0.01) frame.blade[0].y() = 1e200;
    if (share(random) < 0.01) frame.blade[0].y() = std::numeric_limits<double>::quiet_NaN();
    const Eigen::Vector3d force = estimate.Update(frame).force_n;
    ASSERT_TRUE(force.allFinite());
    ASSERT_LE(force.norm(), config.max_force_n * (1 + 1e-12));
    if (!force.isZero(0)) {
      ASSERT_LE((force - last).norm(), 20 * kStep * (1 + 1e-9)) << i;
    }
    last = force;
  }
}

}  // namespace
}  // namespace meshless_cutting
