// Prony series: closed forms of relaxation and creep, rotations, energy, and cuts.
#include "dynamics/viscous_term.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "dynamics/dynamics.h"
#include "support/box_tissue.h"
#include "tissue/materials.h"

namespace meshless_cutting {
namespace {

constexpr double kStep = 0.02;  // s

MaterialConfig Viscous(MaterialModel model = MaterialModel::kStableNeoHookean) {
  MaterialConfig material{model, 1e4, 0.3, 1000};
  material.prony = {{0.8, 0.05}, {0.4, 0.7}};
  return material;
}

DynamicsConfig Config(Integrator integrator) {
  DynamicsConfig config;
  config.time_step_s = kStep;
  config.material = Viscous();
  config.solver = {integrator, 1e-9, 50, 2};
  return config;
}

/// All particles held: what moves is what the test moves.
Tissue HeldBox() {
  BoxTissueConfig box;
  box.cells = {2, 2, 2};
  box.size = {0.04, 0.04, 0.04};
  Tissue tissue = MakeBoxTissue(box);
  tissue.particle_fixed.assign(tissue.particle_count(), 1);
  return tissue;
}

void Drive(const Tissue& tissue, const Eigen::Matrix3d& F, Dynamics& dynamics, TissueState& state) {
  std::vector<int> particles;
  std::vector<Eigen::Vector3d> at_end;
  for (int j = 0; j < tissue.particle_count(); ++j) {
    particles.push_back(j);
    at_end.push_back(F * tissue.particle_rest[j]);
  }
  dynamics.SetDriven(particles, at_end);
  EXPECT_EQ(dynamics.Advance(tissue, {}, state).status, kStepOk);
}

std::vector<Eigen::Vector3d> Forces(const Tissue& tissue, const Dynamics& dynamics) {
  std::vector<Eigen::Vector3d> forces;
  for (int j = 0; j < tissue.particle_count(); ++j) forces.push_back(dynamics.ElasticForce(j));
  return forces;
}

/// Along x, on the face at the end of x, N.
double Pull(const Tissue& tissue, const Dynamics& dynamics) {
  double sum = 0;
  for (int j = 0; j < tissue.particle_count(); ++j) {
    if (tissue.particle_rest[j].x() > 0.039) sum += dynamics.ElasticForce(j).x();
  }
  return sum;
}

TEST(Viscous, AHeldStretchRelaxesAsTheSeries) {
  const Tissue tissue = HeldBox();
  const Eigen::Matrix3d F = Eigen::Vector3d(1.3, 1, 1).asDiagonal();
  const double mu = LameConstantsOf(Viscous()).mu, strain = 0.5 * (1.3 * 1.3 - 1), area = 0.04 * 0.04;
  for (const Integrator integrator :
       {Integrator::kGeneralizedAlpha, Integrator::kImplicitEuler, Integrator::kQuasiStatic}) {
    DynamicsConfig elastic = Config(integrator);
    elastic.material.prony.clear();
    Dynamics viscous(Config(integrator), tissue), relaxed(elastic, tissue);
    TissueState state = RestState(tissue), other = RestState(tissue);
    Drive(tissue, F, relaxed, other);
    const double rest = Pull(tissue, relaxed);
    for (int n = 0; n < 200; ++n) {
      Drive(tissue, F, viscous, state);  // one frame of constant strain rate, then held
      double expected = rest;
      for (const PronyBranch& branch : Viscous().prony) {
        const double x = kStep / branch.relaxation_time_s;
        expected += area * 1.3 * 2 * mu * branch.modulus_ratio * (2.0 / 3 * strain) * (1 - std::exp(-x)) / x * std::exp(-n * x);
      }
      ASSERT_NEAR(Pull(tissue, viscous), expected, 1e-9 * rest) << n;
    }
  }
}

TEST(Viscous, ExplicitStepsRelaxAsTheSeries) {
  const Tissue tissue = HeldBox();
  const Eigen::Matrix3d F = Eigen::Vector3d(1.1, 1, 1).asDiagonal();
  Dynamics dynamics(Config(Integrator::kExplicit), tissue);
  TissueState state = RestState(tissue);
  Drive(tissue, F, dynamics, state);
  const double start = Pull(tissue, dynamics);
  double last = start;
  for (int n = 0; n < 20; ++n) Drive(tissue, F, dynamics, state);
  const double later = Pull(tissue, dynamics);
  DynamicsConfig elastic = Config(Integrator::kExplicit);
  elastic.material.prony.clear();
  Dynamics relaxed(elastic, tissue);
  TissueState other = RestState(tissue);
  Drive(tissue, F, relaxed, other);
  const double rest = Pull(tissue, relaxed);
  const double mu = LameConstantsOf(Viscous()).mu, strain = 0.5 * (1.1 * 1.1 - 1), area = 0.04 * 0.04;
  for (double time : {0.0, 20 * kStep}) {
    double expected = rest;
    for (const PronyBranch& branch : Viscous().prony) {
      const double x = kStep / branch.relaxation_time_s;
      expected += area * 1.1 * 2 * mu * branch.modulus_ratio * (2.0 / 3 * strain) * (1 - std::exp(-x)) / x *
                  std::exp(-time / branch.relaxation_time_s);
    }
    // The blade of time is cut finer here: the strain, quadratic in the way, is not linear over the frame.
    EXPECT_NEAR(time == 0 ? start : later, expected, 0.01 * (expected - rest) + 1e-6 * rest) << time;
  }
  EXPECT_LT(later, last);
}

/// Small strain, one branch: the compliance in shear is (1 - g / (1 + g) exp(-t / ((1 + g) tau))) / mu, that in volume constant.
TEST(Viscous, ALoadedBarCreepsAsTheStandardSolid) {
  BoxTissueConfig box;
  box.cells = {16, 2, 2};
  box.size = {0.16, 0.02, 0.02};
  box.clamp_x0 = true;
  const Tissue tissue = MakeBoxTissue(box);
  DynamicsConfig config = Config(Integrator::kQuasiStatic);
  config.material.prony = {{1.5, 0.2}};
  Dynamics dynamics(config, tissue);
  TissueState state = RestState(tissue);
  const double stress = 20, g = 1.5, tau = 0.2;
  std::vector<Eigen::Vector3d> forces(tissue.particle_count(), Eigen::Vector3d::Zero());
  for (int j : {0, 1, 2}) {
    for (int k : {0, 1, 2}) {
      const double share = (j == 1 ? 0.5 : 0.25) * (k == 1 ? 0.5 : 0.25);
      forces[BoxParticle(box, 16, j, k)].x() = stress * 0.02 * 0.02 * share;
    }
  }
  dynamics.SetForces(forces);
  const LameConstants lame = LameConstantsOf(config.material);
  const double bulk = lame.lambda + 2.0 / 3 * lame.mu;
  for (int n = 1; n <= 80; ++n) {
    dynamics.Advance(tissue, {}, state);
    const auto x = [&](int i) { return state.position[BoxParticle(box, i, 1, 1)].x(); };
    const double strain = (x(12) - x(6)) / 0.06 - 1;
    if (n < 5 || n % 15 != 0) continue;  // the load sets in over the first frame, not at once
    const double time = (n - 0.5) * kStep;
    const double shear = (1 - g / (1 + g) * std::exp(-time / ((1 + g) * tau))) / lame.mu;
    const double expected = stress * (shear / 3 + 1 / (9 * bulk));
    EXPECT_NEAR(strain, expected, 0.01 * expected) << n;
  }
}

TEST(Viscous, ARigidRotationAddsNoStress) {
  const Tissue tissue = HeldBox();
  Dynamics still(Config(Integrator::kGeneralizedAlpha), tissue), turning(Config(Integrator::kGeneralizedAlpha), tissue);
  TissueState a = RestState(tissue), b = RestState(tissue);
  Eigen::Matrix3d F;
  F << 1.2, 0.1, 0, 0, 0.9, 0.05, 0.02, 0, 1.05;
  for (int n = 0; n < 20; ++n) {
    const Eigen::Matrix3d R = Eigen::AngleAxisd(0.3 * n, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    Drive(tissue, F, still, a);
    Drive(tissue, R * F, turning, b);
    const auto expected = Forces(tissue, still), found = Forces(tissue, turning);
    for (std::size_t j = 0; j < found.size(); ++j) {
      ASSERT_LT((found[j] - R * expected[j]).norm(), 1e-10 * (1 + expected[j].norm())) << n;
    }
  }
  // Nor does it where nothing is stretched.
  Dynamics rigid(Config(Integrator::kGeneralizedAlpha), tissue);
  TissueState c = RestState(tissue);
  for (int n = 0; n < 20; ++n) {
    Drive(tissue, Eigen::AngleAxisd(0.3 * n, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(), rigid, c);
    for (const Eigen::Vector3d& f : Forces(tissue, rigid)) ASSERT_LT(f.norm(), 1e-10);
  }
}

TEST(Viscous, TheEnergyOfAFreeBodyOnlyFalls) {
  BoxTissueConfig box;
  box.cells = {4, 3, 3};
  box.size = {0.04, 0.03, 0.03};
  const Tissue tissue = MakeBoxTissue(box);
  for (const Integrator integrator : {Integrator::kImplicitEuler, Integrator::kGeneralizedAlpha, Integrator::kExplicit}) {
    DynamicsConfig config = Config(integrator);
    config.material.prony = {{1, 0.02}, {0.5, 0.3}};
    config.time_step_s = 1.0 / 60;
    config.solver.relative_tolerance = 1e-6;
    Dynamics dynamics(config, tissue);
    TissueState state = RestState(tissue);
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> uniform(-0.2, 0.2);
    for (Eigen::Vector3d& v : state.velocity) v = {uniform(generator), uniform(generator), uniform(generator)};
    double start = 0;
    for (int j = 0; j < tissue.particle_count(); ++j) start += 0.5 * tissue.particle_mass[j] * state.velocity[j].squaredNorm();
    double last = start;
    for (int n = 0; n < 300; ++n) {
      const AdvanceResult result = dynamics.Advance(tissue, {}, state);
      const double energy = result.kinetic_j + result.elastic_j;
      ASSERT_FALSE(result.status & (kStepFrozen | kStepRolledBack));
      // But for second order in the way of a step: strains are quadratic in the positions.
      ASSERT_LT(energy, last + (integrator == Integrator::kImplicitEuler ? 1e-3 : 1e-2) * start) << n << " " << static_cast<int>(integrator);
      last = std::min(last, energy);
    }
    EXPECT_LT(last, 0.4 * start);  // what is left is rigid motion and modes that strain no point
  }
}

TEST(Viscous, APointThatWasSplitKeepsItsHistory) {
  const Tissue whole = HeldBox();
  Tissue cut = whole;
  cut.point_origin.assign(whole.point_count(), -1);
  for (int p = 0; p < whole.point_count(); ++p) {  // into 1/4 and 3/4, on the same particles: nothing may change
    cut.point_volume[p] *= 0.75;
    cut.point_volume.push_back(0.25 * whole.point_volume[p]);
    cut.point_rest.push_back(Eigen::Vector3d(whole.point_rest[p]));
    cut.point_origin.push_back(p);
    for (int k = 0; k < 8; ++k) {
      cut.point_particles.push_back(int{whole.point_particles[8 * p + k]});
      cut.point_gradients.push_back(Eigen::Vector3d(whole.point_gradients[8 * p + k]));
    }
  }
  Dynamics uncut(Config(Integrator::kGeneralizedAlpha), whole), split(Config(Integrator::kGeneralizedAlpha), whole);
  TissueState a = RestState(whole), b = RestState(whole);
  Eigen::Matrix3d F;
  F << 1.2, 0.1, 0, 0, 0.9, 0.05, 0.02, 0, 1.05;
  for (int n = 0; n < 4; ++n) {
    Drive(whole, F, uncut, a);
    Drive(whole, F, split, b);
  }
  split.TissueChanged(cut);
  for (int n = 0; n < 4; ++n) {
    Drive(whole, F, uncut, a);
    Drive(cut, F, split, b);
    const auto expected = Forces(whole, uncut), found = Forces(cut, split);
    for (std::size_t j = 0; j < found.size(); ++j) ASSERT_LT((found[j] - expected[j]).norm(), 1e-12 * (1 + expected[j].norm()));
  }
}

/// The gradient of the potential, and at rest, where no eigenvalue is lifted, that of the gradient, by differences.
TEST(Viscous, GradientAndTangentAreDerivativesOfThePotential) {
  const Tissue tissue = HeldBox();
  ThreadPool pool(1);
  ViscousTerm term({Viscous()}, pool);
  term.TissueChanged(tissue);
  const int count = tissue.particle_count();
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto random = [&](double size) {
    Field field(count);
    for (Vector4& v : field) v = {size * uniform(generator), size * uniform(generator), size * uniform(generator), 0};
    return field;
  };
  Field rest(count), start(count);
  for (int j = 0; j < count; ++j) rest[j] = Vector4::From(tissue.particle_rest[j]);
  StageMotion motion;
  motion.start = &rest;
  motion.stage = 0.6;
  motion.elapsed_s = kStep;
  const auto along = [&](const Field& x, const Field& d, double h) {
    Field y(count);
    for (int j = 0; j < count; ++j) y[j] = x[j] + h * d[j];
    return y;
  };
  const Field direction = random(1), other = random(1);
  const double h = 1e-6;
  const auto check = [&](const Field& x, bool tangent) {
    Field gradient(count), unused(count), plus(count), minus(count), product(count);
    term.Evaluate(x, gradient);
    double slope = 0;
    for (int j = 0; j < count; ++j) slope += Dot(gradient[j], direction[j]);
    const double difference =
        (term.Evaluate(along(x, direction, h), plus) - term.Evaluate(along(x, direction, -h), minus)) / (2 * h);
    EXPECT_NEAR(slope, difference, 1e-5 * (std::abs(slope) + 1e-3));
    term.Linearise(x);
    term.AddProduct(direction, product);
    double curvature = 0, by_difference = 0, symmetric[2] = {};
    for (int j = 0; j < count; ++j) {
      curvature += Dot(product[j], direction[j]);
      by_difference += Dot(plus[j] - minus[j], direction[j]) / (2 * h);
      symmetric[0] += Dot(product[j], other[j]);
    }
    term.AddProduct(other, unused);
    for (int j = 0; j < count; ++j) symmetric[1] += Dot(unused[j], direction[j]);
    EXPECT_GE(curvature, 0);
    EXPECT_NEAR(symmetric[0], symmetric[1], 1e-9 * std::abs(curvature));
    if (tangent) {
      EXPECT_NEAR(curvature, by_difference, 1e-5 * curvature);
    }
  };
  term.BeginStep(motion);
  check(rest, true);
  const Field moved = along(rest, random(0.004), 1);
  check(moved, false);
  term.EndStep(moved);
  motion.start = &moved;
  term.BeginStep(motion);
  check(along(moved, random(0.004), 1), false);
}

}  // namespace
}  // namespace meshless_cutting
