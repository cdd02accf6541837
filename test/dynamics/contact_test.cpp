// Bodies on planes and boxes: they come to rest where they should, and stay.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>

#include "dynamics/dynamics.h"
#include "support/box_tissue.h"

namespace meshless_cutting {
namespace {

constexpr double kSize = 0.06;  // m, edge of the cube

BoxTissueConfig Cube() {
  BoxTissueConfig config;
  config.cells = {6, 6, 6};
  config.size = Eigen::Vector3d::Constant(kSize);
  config.density_kg_m3 = 1050;
  return config;
}

DynamicsConfig Config(double youngs_modulus_pa) {
  DynamicsConfig config;
  config.material = {MaterialModel::kStableNeoHookean, youngs_modulus_pa, 0.45, 1050};
  config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  config.damping = DampingConfig{1, 0.01};
  config.solver.threads = 1;
  return config;
}

struct Drop {
  Tissue tissue = MakeBoxTissue(Cube());
  SurfacePoints skin = MakeBoxSkin(Cube());
  TissueState state = RestState(tissue);
  AdvanceResult result;
  std::uint32_t status = kStepOk;

  void Advance(Dynamics& dynamics, int steps) {
    for (int n = 0; n < steps; ++n) {
      result = dynamics.Advance(tissue, skin, state);
      status |= result.status;
    }
  }
  double Lowest() const {
    double z = 1e9;
    for (const Eigen::Vector3d& x : state.position) z = std::min(z, x.z());
    return z;
  }
  Eigen::Vector3d Centre() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& x : state.position) sum += x;
    return sum / state.position.size();
  }
  double Fastest() const {
    double speed = 0;
    for (const Eigen::Vector3d& v : state.velocity) speed = std::max(speed, v.norm());
    return speed;
  }
};

class RestTest : public testing::TestWithParam<double> {};

TEST_P(RestTest, FallsOnAPlaneAndStays) {
  DynamicsConfig config = Config(GetParam());
  config.obstacles.push_back({PlaneObstacle{Eigen::Vector3d(0, 0, -0.01), Eigen::Vector3d::UnitZ()}, 0.5});
  Drop run;
  Dynamics dynamics(config, run.tissue);
  run.Advance(dynamics, 300);
  EXPECT_GT(run.result.contacts, 3);
  EXPECT_LT(std::abs(run.Lowest() + 0.01), 1e-3);
  const Eigen::Vector3d centre = run.Centre();
  run.Advance(dynamics, 600);
  EXPECT_LT((run.Centre() - centre).norm(), 1e-5);
  EXPECT_LT(run.Fastest(), 1e-4);
  EXPECT_LT(std::abs(run.Lowest() + 0.01), 1e-3);
  EXPECT_FALSE(run.status & (kStepRolledBack | kStepFrozen));
}

TEST_P(RestTest, SticksOnASlopeBelowTheFrictionAngle) {
  DynamicsConfig config = Config(GetParam());
  const Eigen::Vector3d normal(std::sin(0.1), 0, std::cos(0.1));
  config.obstacles.push_back({PlaneObstacle{Eigen::Vector3d(0, 0, -0.01), normal}, 0.3});
  Drop run;
  Dynamics dynamics(config, run.tissue);
  run.Advance(dynamics, 300);
  const Eigen::Vector3d centre = run.Centre();
  run.Advance(dynamics, 600);
  EXPECT_LT((run.Centre() - centre).norm(), 2e-5);
  EXPECT_LT(run.Fastest(), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Stiffness, RestTest, testing::Values(5e3, 1e5, 1e7));

TEST(Contact, SlidesOnASlopeAboveTheFrictionAngle) {
  DynamicsConfig config = Config(1e5);
  config.damping.reset();
  const double angle = 0.3, friction = 0.1;
  const Eigen::Vector3d normal(std::sin(angle), 0, std::cos(angle)), down(std::cos(angle), 0, -std::sin(angle));
  config.obstacles.push_back({PlaneObstacle{Eigen::Vector3d::Zero(), normal}, friction});
  Drop run;
  // Begins on the slope.
  const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
  for (Eigen::Vector3d& x : run.state.position) x = R * x;
  Dynamics dynamics(config, run.tissue);
  run.Advance(dynamics, 30);
  const Eigen::Vector3d start = run.Centre();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& v : run.state.velocity) velocity += v / run.state.velocity.size();
  run.Advance(dynamics, 30);
  const double t = 0.5, acceleration = 9.81 * (std::sin(angle) - friction * std::cos(angle));
  const double expected = velocity.dot(down) * t + 0.5 * acceleration * t * t;
  EXPECT_NEAR((run.Centre() - start).dot(down), expected, 0.05 * expected);
}

TEST(Contact, RestsOnAThinTrayDroppedFast) {
  DynamicsConfig config = Config(2e4);
  BoxObstacle tray;
  tray.half_extents = {0.1, 0.1, 0.002};
  tray.T_WB.translation() = Eigen::Vector3d(0.03, 0.03, -0.05);
  config.obstacles.push_back({tray, 0.5});
  Drop run;
  for (Eigen::Vector3d& v : run.state.velocity) v.z() = -3;  // 50 mm a step: more than ten times the tray
  Dynamics dynamics(config, run.tissue);
  run.Advance(dynamics, 400);
  EXPECT_GT(run.result.contacts, 3);
  EXPECT_LT(std::abs(run.Lowest() + 0.048), 1e-3);
  EXPECT_LT(run.Fastest(), 1e-3);
}

/// A tray of 1 cm or 2 mm, hit flat or with an edge at up to 10 m/s, 17 cm a step: never passed, always rested on.
TEST(Contact, ATrayIsNotPassedAtAnySpeed) {
  for (const double thickness : {0.01, 0.002}) {
    for (const double speed : {3.0, 10.0}) {
      for (const double tilt : {0.0, 0.6}) {
        DynamicsConfig config = Config(5e3);
        BoxObstacle tray;
        tray.half_extents = {0.2, 0.2, 0.5 * thickness};
        tray.T_WB.translation() = Eigen::Vector3d(0.03, 0.03, -0.06 - 0.5 * thickness);
        config.obstacles.push_back({tray, 0.5});
        Drop run;
        const Eigen::AngleAxisd turn(tilt, Eigen::Vector3d(1, 0.5, 0).normalized());
        const Eigen::Vector3d middle = Eigen::Vector3d::Constant(0.5 * kSize);
        for (Eigen::Vector3d& x : run.state.position) x = turn * (x - middle) + middle;
        for (Eigen::Vector3d& v : run.state.velocity) v.z() = -speed;
        Dynamics dynamics(config, run.tissue);
        run.Advance(dynamics, 240);
        EXPECT_GT(run.Lowest(), -0.0625) << thickness << " " << speed << " " << tilt;
        EXPECT_FALSE(run.status & kStepFrozen);
      }
    }
  }
}

TEST(Contact, HangsOverTheEdgeOfABoxWithoutBeingPushedUpBesideIt) {
  DynamicsConfig config = Config(2e4);
  BoxObstacle tray;
  tray.half_extents = {0.05, 0.1, 0.01};
  tray.T_WB.translation() = Eigen::Vector3d(-0.005, 0.03, -0.011);  // its edge at x = 0.045, below two thirds of the cube
  config.obstacles.push_back({tray, 0.5});
  Drop run;
  Dynamics dynamics(config, run.tissue);
  run.Advance(dynamics, 400);
  EXPECT_LT(run.Fastest(), 1e-3);
  // What is beside the box hangs lower than what lies on it.
  const BoxTissueConfig cube = Cube();
  EXPECT_LT(run.state.position[BoxParticle(cube, 6, 3, 0)].z(), run.state.position[BoxParticle(cube, 2, 3, 0)].z());
  EXPECT_GT(run.Centre().z(), 0);
}

TEST(Contact, FarObstaclesChangeNothing) {
  DynamicsConfig config = Config(5e3);
  Drop bare, with;
  Dynamics a(config, bare.tissue);
  config.obstacles.push_back({PlaneObstacle{Eigen::Vector3d(0, 0, -100), Eigen::Vector3d::UnitZ()}, 0.5});
  Dynamics b(config, with.tissue);
  bare.Advance(a, 20);
  with.Advance(b, 20);
  for (std::size_t j = 0; j < bare.state.position.size(); ++j) EXPECT_EQ(bare.state.position[j], with.state.position[j]);
  EXPECT_EQ(with.result.contacts, 0);
}

}  // namespace
}  // namespace meshless_cutting
