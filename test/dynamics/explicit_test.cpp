// Steps without a solver, the choice between them and the implicit ones, sub-steps, and sleep.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "dynamics/dynamics.h"
#include "dynamics/explicit_steps.h"
#include "dynamics/solver_choice.h"
#include "support/box_tissue.h"

namespace meshless_cutting {
namespace {

BoxTissueConfig Beam() {
  BoxTissueConfig box;
  box.cells = {8, 4, 4};
  box.size = {0.08, 0.04, 0.04};
  box.clamp_x0 = true;
  return box;
}

DynamicsConfig Config(Integrator integrator) {
  DynamicsConfig config;
  config.material = {MaterialModel::kStableNeoHookean, 1e4, 0.45, 1000};
  config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  config.solver.integrator = integrator;
  config.solver.threads = 1;
  return config;
}

double Tip(const TissueState& state) { return state.position.back().z() - 0.04; }

TEST(ExplicitSteps, SwingAsTheConvergedImplicitScheme) {
  const Tissue tissue = MakeBoxTissue(Beam());
  DynamicsConfig fine = Config(Integrator::kGeneralizedAlpha);
  fine.solver.sub_steps = 16;
  fine.solver.relative_tolerance = 1e-5;
  fine.solver.newton_iterations = 10;
  Dynamics explicit_dynamics(Config(Integrator::kExplicit), tissue), implicit_dynamics(fine, tissue);
  TissueState a = RestState(tissue), b = RestState(tissue);
  double largest = 0;
  for (int n = 0; n < 40; ++n) {
    const AdvanceResult result = explicit_dynamics.Advance(tissue, {}, a);
    implicit_dynamics.Advance(tissue, {}, b);
    EXPECT_EQ(result.status, kStepOk);
    largest = std::max(largest, std::abs(Tip(b)));
    ASSERT_NEAR(Tip(a), Tip(b), 0.02 * largest + 1e-5) << n;
  }
  EXPECT_GT(largest, 0.01);
}

TEST(ExplicitSteps, KeepTheEnergyOfAnUndampedSwing) {
  const Tissue tissue = MakeBoxTissue(Beam());
  Dynamics dynamics(Config(Integrator::kExplicit), tissue);
  TissueState state = RestState(tissue);
  AdvanceResult result = dynamics.Advance(tissue, {}, state);
  double least_gravity = 0;
  const double start = result.kinetic_j + result.elastic_j + result.gravity_j, rest = result.gravity_j;
  for (int n = 0; n < 300; ++n) {
    result = dynamics.Advance(tissue, {}, state);
    least_gravity = std::min(least_gravity, result.gravity_j - rest);
    ASSERT_NEAR(result.kinetic_j + result.elastic_j + result.gravity_j, start, 0.01 * -least_gravity + 1e-5) << n;
  }
}

TEST(ExplicitSteps, ComeToRestOnAPlaneWithDampingAndFriction) {
  BoxTissueConfig box = Beam();
  box.clamp_x0 = false;
  const Tissue tissue = MakeBoxTissue(box);
  DynamicsConfig config = Config(Integrator::kExplicit);
  config.damping = DampingConfig{4, 0.001};
  config.obstacles.push_back({PlaneObstacle{Eigen::Vector3d(0, 0, -0.01), Eigen::Vector3d::UnitZ()}, 0.5});
  const SurfacePoints skin = MakeBoxSkin(box);
  Dynamics dynamics(config, tissue);
  TissueState state = RestState(tissue);
  AdvanceResult result;
  for (int n = 0; n < 400; ++n) result = dynamics.Advance(tissue, skin, state);
  EXPECT_GT(result.contacts, 10);
  EXPECT_LT(result.kinetic_j, 1e-9);
  for (const Eigen::Vector3d& x : state.position) EXPECT_GT(x.z(), -0.012);
}

TEST(ExplicitSteps, TheStableStepHoldsOverStiffnessAndDamping) {
  for (const double E : {1e3, 1e6}) {
    for (const double stiffness_s : {0.0, 0.003}) {
      const Tissue tissue = MakeBoxTissue(Beam());
      DynamicsConfig config = Config(Integrator::kExplicit);
      config.time_step_s = 1.0 / 600;
      config.material.youngs_modulus_pa = E;
      if (stiffness_s > 0) config.damping = DampingConfig{0, stiffness_s};
      config.gravity_m_s2.reset();
      Dynamics dynamics(config, tissue);
      TissueState state = RestState(tissue);
      for (int j = 0; j < tissue.particle_count(); ++j) {
        if (!tissue.particle_fixed[j]) state.velocity[j] = Eigen::Vector3d((j * 7 % 5) - 2, (j * 3 % 7) - 3, 0) * 0.001;
      }
      AdvanceResult result = dynamics.Advance(tissue, {}, state);
      const double start = result.kinetic_j + result.elastic_j;
      for (int n = 0; n < 60; ++n) {
        result = dynamics.Advance(tissue, {}, state);
        ASSERT_EQ(result.status, kStepOk) << E << " " << stiffness_s << " " << n;
      }
      EXPECT_LT(result.kinetic_j + result.elastic_j, 1.1 * start) << E << " " << stiffness_s;
    }
  }
}

TEST(SolverChoice, AutoTakesSmallStepsForSoftObjectsAndSolvesForStiffOnes) {
  SolverConfig config;
  config.integrator = Integrator::kAuto;
  SolverSituation soft;
  soft.cell_m = 0.005;
  soft.p_wave_modulus_pa = 2e4;
  soft.density_kg_m3 = 1000;
  soft.step_s = 1.0 / 60;
  SolverSituation stiff = soft;
  stiff.p_wave_modulus_pa = 1e7;
  const SolverChoice small_steps = ChooseSolver(config, soft), solve = ChooseSolver(config, stiff);
  EXPECT_EQ(small_steps.integrator, Integrator::kExplicit);
  EXPECT_NEAR(small_steps.explicit_steps, 1.0 / 60 / (0.8 * 0.005 / std::sqrt(20.0)), 1);
  EXPECT_EQ(solve.integrator, Integrator::kGeneralizedAlpha);
  EXPECT_NE(small_steps.reason.find("explicit, chosen: 19 explicit steps"), std::string::npos) << small_steps.reason;
  EXPECT_NE(solve.reason.find("generalized_alpha, chosen"), std::string::npos) << solve.reason;
  config.integrator = Integrator::kExplicit;  // what the user says stands
  EXPECT_EQ(ChooseSolver(config, stiff).integrator, Integrator::kExplicit);
}

TEST(SubSteps, AreStepsOfAShorterTime) {
  const Tissue tissue = MakeBoxTissue(Beam());
  for (const Integrator integrator :
       {Integrator::kGeneralizedAlpha, Integrator::kImplicitEuler, Integrator::kExplicit}) {
    DynamicsConfig halves = Config(integrator), short_steps = Config(integrator);
    halves.solver.sub_steps = 2;
    short_steps.time_step_s = halves.time_step_s / 2;
    Dynamics a(halves, tissue), b(short_steps, tissue);
    TissueState x = RestState(tissue), y = RestState(tissue);
    for (int n = 0; n < 10; ++n) {
      a.Advance(tissue, {}, x);
      for (int half = 0; half < 2; ++half) b.Advance(tissue, {}, y);
    }
    EXPECT_EQ(std::memcmp(x.position.data(), y.position.data(), x.position.size() * sizeof(Eigen::Vector3d)), 0);
  }
}

TEST(Sleep, LastsUntilSomethingChanges) {
  const Tissue tissue = MakeBoxTissue(Beam());
  for (const Integrator integrator : {Integrator::kGeneralizedAlpha, Integrator::kExplicit}) {
    DynamicsConfig config = Config(integrator);
    config.damping = DampingConfig{5, 0.002};
    Dynamics dynamics(config, tissue);
    TissueState state = RestState(tissue);
    AdvanceResult result;
    for (int n = 0; n < 900; ++n) result = dynamics.Advance(tissue, {}, state);
    EXPECT_EQ(result.kinetic_j, 0);
    const TissueState slept = state;
    for (int n = 0; n < 100; ++n) {
      const AdvanceResult same = dynamics.Advance(tissue, {}, state);
      EXPECT_EQ(same.elastic_j, result.elastic_j);
    }
    EXPECT_EQ(state.position, slept.position);
    state.velocity.back().z() = 1;
    dynamics.Advance(tissue, {}, state);
    EXPECT_NE(state.position, slept.position);
  }
  // Held everywhere and without gravity, it rests where it is; it does not where it floats.
  DynamicsConfig weightless = Config(Integrator::kGeneralizedAlpha);
  weightless.gravity_m_s2.reset();
  BoxTissueConfig loose_box = Beam();
  loose_box.clamp_x0 = false;
  const Tissue loose = MakeBoxTissue(loose_box);
  Dynamics floating(weightless, loose);
  TissueState drift = RestState(loose);
  for (Eigen::Vector3d& v : drift.velocity) v.x() = 1e-5;
  for (int n = 0; n < 60; ++n) floating.Advance(loose, {}, drift);
  EXPECT_NEAR(drift.position[0].x(), 1e-5, 1e-12);
}

}  // namespace
}  // namespace meshless_cutting
