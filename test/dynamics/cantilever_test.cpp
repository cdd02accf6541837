// A clamped beam under its own weight, against finite element solutions: references/solutions/a_cantilever_*.json ("extrapolated",
// tip_centre_u) and e_dynamic_*.json ("runs_graded", last: extrema of the tip's path).
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/dynamics.h"
#include "support/box_tissue.h"

namespace meshless_cutting {
namespace {

BoxTissueConfig Beam(int cells_across) {
  BoxTissueConfig config;
  config.cells = {5 * cells_across, cells_across, cells_across};
  config.size = {0.1, 0.02, 0.02};
  config.density_kg_m3 = 1000;
  config.clamp_x0 = true;
  return config;
}

Eigen::Vector3d TipDisplacement(const BoxTissueConfig& beam, const Tissue& tissue, const TissueState& state) {
  const int tip = BoxParticle(beam, beam.cells.x(), beam.cells.y() / 2, beam.cells.z() / 2);
  return state.position[tip] - tissue.particle_rest[tip];
}

struct StaticCase {
  MaterialModel model;
  double youngs_modulus_pa, poisson_ratio;
  double tip_x, tip_z;  // m, reference
};

class StaticCantileverTest : public testing::TestWithParam<StaticCase> {};

TEST_P(StaticCantileverTest, TipIsWithinTwoPerCentAt1519Particles) {
  const StaticCase& c = GetParam();
  const BoxTissueConfig beam = Beam(6);
  const Tissue tissue = MakeBoxTissue(beam);
  ASSERT_EQ(tissue.particle_count(), 31 * 7 * 7);
  DynamicsConfig config;
  config.material = {c.model, c.youngs_modulus_pa, c.poisson_ratio, 1000};
  config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  // Steps so long that inertia damps without mattering.
  config.time_step_s = 0.5;
  config.solver = {Integrator::kImplicitEuler, 1e-8, 40, 1};
  Dynamics dynamics(config, tissue);
  TissueState state = RestState(tissue);
  AdvanceResult result;
  for (int n = 0; n < 12; ++n) result = dynamics.Advance(tissue, {}, state);
  EXPECT_EQ(result.status, kStepOk);
  const Eigen::Vector3d tip = TipDisplacement(beam, tissue, state), reference(c.tip_x, 0, c.tip_z);
  EXPECT_LT((tip - reference).norm(), 0.02 * reference.norm()) << tip.transpose();
  RecordProperty("error_percent", std::to_string(100 * (tip - reference).norm() / reference.norm()));
}

INSTANTIATE_TEST_SUITE_P(
    References, StaticCantileverTest,
    testing::Values(StaticCase{MaterialModel::kStableNeoHookean, 1e5, 0.45, -0.0064210827, -0.0340113451},
                    StaticCase{MaterialModel::kNeoHookean, 1e5, 0.45, -0.0064296148, -0.0340460892},
                    StaticCase{MaterialModel::kStVenantKirchhoff, 1e5, 0.45, -0.0067510806, -0.0340475946},
                    StaticCase{MaterialModel::kLinear, 1e5, 0.45, -1.0314737e-07, -0.0369571816},
                    StaticCase{MaterialModel::kNeoHookean, 1e5, 0.49, -0.0063464914, -0.0338454996},
                    StaticCase{MaterialModel::kNeoHookean, 1e4, 0.3, -0.0691623571, -0.0967574825},
                    StaticCase{MaterialModel::kNeoHookean, 1e6, 0.45, -7.3312915e-05, -0.0036923763}));

/// Gravity is switched on at t = 0; undamped. The first trough and the crest after it.
TEST(DynamicCantilever, SwingsLikeTheReference) {
  const BoxTissueConfig beam = Beam(6);
  const Tissue tissue = MakeBoxTissue(beam);
  DynamicsConfig config;
  config.material = {MaterialModel::kNeoHookean, 1e5, 0.45, 1000};
  config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  config.time_step_s = 1.0 / 120;
  config.solver.threads = 1;
  Dynamics dynamics(config, tissue);
  TissueState state = RestState(tissue);
  std::vector<double> z{0};
  for (int n = 0; n < 60; ++n) {
    dynamics.Advance(tissue, {}, state);
    z.push_back(TipDisplacement(beam, tissue, state).z());
  }
  // Extrema by a parabola through three samples.
  std::vector<std::pair<double, double>> extrema;
  for (std::size_t n = 1; n + 1 < z.size(); ++n) {
    if ((z[n] - z[n - 1]) * (z[n + 1] - z[n]) > 0) continue;
    const double curvature = z[n - 1] - 2 * z[n] + z[n + 1], shift = 0.5 * (z[n - 1] - z[n + 1]) / curvature;
    extrema.emplace_back((n + shift) * config.time_step_s, z[n] - 0.125 * std::pow(z[n + 1] - z[n - 1], 2) / curvature);
  }
  ASSERT_GE(extrema.size(), 3u);
  EXPECT_NEAR(extrema[0].second, -0.062301, 0.02 * 0.062301);
  EXPECT_NEAR(extrema[1].second, 0.000407, 0.02 * 0.062301);
  EXPECT_NEAR(extrema[2].second, -0.062499, 0.03 * 0.062499);
  EXPECT_NEAR(extrema[2].first, 0.444798, 0.02 * 0.444798);
  RecordProperty("second_trough_m", std::to_string(extrema[2].second));
  RecordProperty("second_trough_s", std::to_string(extrema[2].first));
}

}  // namespace
}  // namespace meshless_cutting
