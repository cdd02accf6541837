// Free pieces smaller than a cell, spinning faster than a second order scheme can bear.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "dynamics/dynamics.h"
#include "support/box_tissue.h"

namespace meshless_cutting {
namespace {

constexpr double kStep = 1.0 / 60;
constexpr int kGrain = 27;  // first particle of the grain, after those of the block

/// A block of eight cells, clamped, and next to it a tenth of a cell on particles of its own, as a cut leaves it.
Tissue BlockAndGrain() {
  BoxTissueConfig block;
  block.cells = {2, 2, 2};
  block.size = {0.01, 0.01, 0.01};
  block.clamp_x0 = true;
  BoxTissueConfig cell;
  cell.cells = {1, 1, 1};
  cell.size = {0.005, 0.005, 0.005};
  Tissue tissue = MakeBoxTissue(block);
  const Tissue grain = MakeBoxTissue(cell);
  for (int j = 0; j < grain.particle_count(); ++j) {
    tissue.particle_rest.push_back(grain.particle_rest[j] + Eigen::Vector3d(0.02, 0, 0));
    tissue.particle_mass.push_back(0.1 * grain.particle_mass[j]);
    tissue.particle_fixed.push_back(0);
  }
  tissue.point_volume.push_back(0.1 * grain.point_volume[0]);
  tissue.point_rest.push_back(grain.point_rest[0] + Eigen::Vector3d(0.02, 0, 0));
  for (int j : grain.point_particles) tissue.point_particles.push_back(kGrain + j);
  for (const Eigen::Vector3d& gradient : grain.point_gradients) tissue.point_gradients.push_back(gradient);
  return tissue;
}

class GrainsTest : public testing::TestWithParam<Integrator> {};

TEST_P(GrainsTest, ASpinningGrainKeepsItsSizeAndItsMomentum) {
  const Tissue tissue = BlockAndGrain();
  DynamicsConfig config;
  config.time_step_s = kStep;
  config.material = {MaterialModel::kStableNeoHookean, 2e4, 0.4, 1050};
  config.solver.integrator = GetParam();
  config.solver.threads = 1;
  config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Dynamics dynamics(config, tissue);
    TissueState state = RestState(tissue);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(-1, 1);
    const auto direction = [&] { return Eigen::Vector3d(share(random), share(random), share(random)); };
    const Eigen::Vector3d spin = 70 * direction().normalized();  // rad/s: more than one a step
    Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
    double mass = 0;
    for (int j = kGrain; j < tissue.particle_count(); ++j) {
      state.velocity[j] = spin.cross(tissue.particle_rest[j] - tissue.point_rest.back()) + 0.2 * direction();
      momentum += tissue.particle_mass[j] * state.velocity[j];
      mass += tissue.particle_mass[j];
    }
    int newton = 0;
    double largest = 0;
    constexpr int kSteps = 300;
    for (int n = 0; n < kSteps; ++n) {
      newton += dynamics.Advance(tissue, {}, state).newton_iterations;
      if (n < 10) continue;  // the violence of the start
      for (int j = kGrain; j < tissue.particle_count(); ++j)
        largest = std::max(largest, (state.position[j] - state.position[kGrain]).norm());
    }
    EXPECT_LT(largest, 1.1 * 0.005 * std::sqrt(3.0)) << seed;
    EXPECT_LT(newton, 4 * kSteps) << seed;
    Eigen::Vector3d after = -kSteps * kStep * mass * *config.gravity_m_s2;
    for (int j = kGrain; j < tissue.particle_count(); ++j) after += tissue.particle_mass[j] * state.velocity[j];
    EXPECT_LT((after - momentum).norm(), 1e-10 * mass) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Schemes, GrainsTest,
                         testing::Values(Integrator::kGeneralizedAlpha, Integrator::kImplicitEuler));

}  // namespace
}  // namespace meshless_cutting
