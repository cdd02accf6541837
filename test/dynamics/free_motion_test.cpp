// Bodies that nothing holds: what must be conserved.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "dynamics/dynamics.h"
#include "support/box_tissue.h"

namespace meshless_cutting {
namespace {

constexpr double kStep = 1.0 / 60;

BoxTissueConfig Box() {
  BoxTissueConfig config;
  config.cells = {4, 5, 6};
  config.size = {0.04, 0.05, 0.06};
  return config;
}

DynamicsConfig Config(Integrator integrator) {
  DynamicsConfig config;
  config.time_step_s = kStep;
  config.material = {MaterialModel::kStableNeoHookean, 2e4, 0.45, 1000};
  config.solver.integrator = integrator;
  config.solver.threads = 1;
  return config;
}

Eigen::Vector3d Momentum(const Tissue& tissue, const TissueState& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int j = 0; j < tissue.particle_count(); ++j) sum += tissue.particle_mass[j] * state.velocity[j];
  return sum;
}

Eigen::Vector3d AngularMomentum(const Tissue& tissue, const TissueState& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int j = 0; j < tissue.particle_count(); ++j) {
    sum += tissue.particle_mass[j] * state.position[j].cross(state.velocity[j]);
  }
  return sum;
}

class FreeMotionTest : public testing::TestWithParam<Integrator> {};

TEST_P(FreeMotionTest, FreeFallIsExact) {
  const Tissue tissue = MakeBoxTissue(Box());
  DynamicsConfig config = Config(GetParam());
  const Eigen::Vector3d g(0.3, -0.2, -9.81), v(1, 2, 3);
  config.gravity_m_s2 = g;
  Dynamics dynamics(config, tissue);
  TissueState state = RestState(tissue);
  for (Eigen::Vector3d& velocity : state.velocity) velocity = v;
  const int steps = 60;
  for (int n = 0; n < steps; ++n) {
    const AdvanceResult result = dynamics.Advance(tissue, {}, state);
    EXPECT_EQ(result.status, kStepOk);
    EXPECT_EQ(result.newton_iterations, 0);
  }
  const double t = steps * kStep;
  // Implicit Euler sums the velocities of the ends of its steps.
  const double way = GetParam() == Integrator::kImplicitEuler ? 0.5 * t * (t + kStep) : 0.5 * t * t;
  for (int j = 0; j < tissue.particle_count(); ++j) {
    EXPECT_LT((state.position[j] - tissue.particle_rest[j] - t * v - way * g).norm(), 1e-11);
    EXPECT_LT((state.velocity[j] - v - t * g).norm(), 1e-10);
  }
}

TEST_P(FreeMotionTest, MomentumIsConservedWhateverTheSolverLeaves) {
  const Tissue tissue = MakeBoxTissue(Box());
  Dynamics dynamics(Config(GetParam()), tissue);
  TissueState state = RestState(tissue);
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (Eigen::Vector3d& v : state.velocity) v = {uniform(generator), uniform(generator), uniform(generator)};
  const Eigen::Vector3d before = Momentum(tissue, state);
  double mass = 0;
  for (double m : tissue.particle_mass) mass += m;
  for (int n = 0; n < 60; ++n) dynamics.Advance(tissue, {}, state);
  EXPECT_LT((Momentum(tissue, state) - before).norm(), 1e-12 * mass);
}

TEST_P(FreeMotionTest, SpinsWithoutGainingEnergy) {
  const Tissue tissue = MakeBoxTissue(Box());
  DynamicsConfig config = Config(GetParam());
  config.solver.relative_tolerance = 1e-6;
  config.solver.newton_iterations = 10;
  Dynamics dynamics(config, tissue);
  TissueState state = RestState(tissue);
  const Eigen::Vector3d omega(3, 1, 5);  // rad/s
  for (int j = 0; j < tissue.particle_count(); ++j) {
    state.velocity[j] = omega.cross(tissue.particle_rest[j] - Eigen::Vector3d(0.02, 0.025, 0.03));
  }
  double start = 0;
  for (int j = 0; j < tissue.particle_count(); ++j) {
    start += 0.5 * tissue.particle_mass[j] * state.velocity[j].squaredNorm();
  }
  const Eigen::Vector3d spin = AngularMomentum(tissue, state);
  double most = 0, last = 0;
  for (int n = 0; n < 600; ++n) {
    const AdvanceResult result = dynamics.Advance(tissue, {}, state);
    last = result.kinetic_j + result.elastic_j;
    most = std::max(most, last);
  }
  EXPECT_LT(most, 1.1 * start);  // the body starts without the strain of its spin, and finds it
  // Ten seconds: generalised-alpha keeps the spin, implicit Euler brakes it.
  if (GetParam() == Integrator::kGeneralizedAlpha) {
    EXPECT_GT(last, 0.8 * start);
    EXPECT_LT((AngularMomentum(tissue, state) - spin).norm(), 0.1 * spin.norm());
  }
}

TEST_P(FreeMotionTest, UndampedVibrationStaysBounded) {
  const Tissue tissue = MakeBoxTissue(Box());
  Dynamics dynamics(Config(GetParam()), tissue);
  TissueState state = RestState(tissue);
  for (Eigen::Vector3d& x : state.position) x.x() *= 1.3;
  double start = 0;
  for (int n = 0; n < 300; ++n) {
    const AdvanceResult result = dynamics.Advance(tissue, {}, state);
    const double energy = result.kinetic_j + result.elastic_j;
    if (n == 0) start = energy;
    ASSERT_LT(energy, 1.1 * start);
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, FreeMotionTest,
                         testing::Values(Integrator::kGeneralizedAlpha, Integrator::kImplicitEuler));

/// Damping that is switched on later is that of a scene which had it from the start, and off is off.
TEST(Damping, IsWhatItIsTunedTo) {
  const Tissue tissue = MakeBoxTissue(Box());
  const auto shake = [&](double loaded, double tuned) {
    DynamicsConfig config = Config(Integrator::kGeneralizedAlpha);
    config.damping = DampingConfig{0, loaded};
    Dynamics dynamics(config, tissue);
    dynamics.Tune({Eigen::Vector3d::Zero(), {0, tuned}, config.solver.newton_iterations}, tissue);
    TissueState state = RestState(tissue);
    for (int j = 0; j < tissue.particle_count(); ++j) {
      state.velocity[j] = Eigen::Vector3d(0.3 * std::sin(200 * tissue.particle_rest[j].z()), 0.1, 0);
    }
    for (int n = 0; n < 20; ++n) dynamics.Advance(tissue, {}, state);
    return state.position;
  };
  const auto free = shake(0, 0), damped = shake(0.01, 0.01);
  EXPECT_EQ(shake(0, 0.01), damped);
  EXPECT_EQ(shake(0.01, 0), free);
  EXPECT_NE(free, damped);
}

}  // namespace
}  // namespace meshless_cutting
