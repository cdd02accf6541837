// States and materials that break solvers: finite throughout, and back to shape.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "dynamics/dynamics.h"
#include "dynamics/elastic_points.h"
#include "support/box_tissue.h"

namespace meshless_cutting {
namespace {

bool IsFinite(const TissueState& state) {
  for (std::size_t j = 0; j < state.position.size(); ++j) {
    if (!state.position[j].allFinite() || !state.velocity[j].allFinite() || !state.acceleration[j].allFinite()) return false;
  }
  return true;
}

BoxTissueConfig Box(bool clamped) {
  BoxTissueConfig config;
  config.cells = {6, 4, 4};
  config.size = {0.06, 0.04, 0.04};
  config.clamp_x0 = clamped;
  return config;
}

struct Start {
  const char* name;
  int come_back;  // at least so many of kSeeds, and if any the first, see below
  Eigen::Vector3d (*place)(const Eigen::Vector3d& X, std::mt19937& generator);
};
constexpr unsigned kFirstSeed = 11, kSeeds = 8;

double Uniform(std::mt19937& generator) { return std::uniform_real_distribution<double>(-1, 1)(generator); }
Eigen::Vector3d Noise(std::mt19937& generator) { return {Uniform(generator), Uniform(generator), Uniform(generator)}; }

class DegenerateStartTest : public testing::TestWithParam<Start> {};

TEST_P(DegenerateStartTest, StaysFiniteAndComesBack) {
  const Tissue tissue = MakeBoxTissue(Box(false));
  const double way = (tissue.particle_rest.back() - tissue.particle_rest.front()).norm();
  for (const Integrator integrator : {Integrator::kGeneralizedAlpha, Integrator::kImplicitEuler}) {
    int came_back = 0;
    for (unsigned seed = kFirstSeed; seed < kFirstSeed + kSeeds; ++seed) {
      DynamicsConfig config;
      config.material = {MaterialModel::kStableNeoHookean, 1e4, 0.45, 1000};
      config.damping = DampingConfig{1, 0.02};
      config.solver = {integrator, 1e-3, 8, 1};
      Dynamics dynamics(config, tissue);
      TissueState state = RestState(tissue);
      std::mt19937 generator(seed);
      for (Eigen::Vector3d& x : state.position) x = GetParam().place(x, generator);
      ThreadPool pool(1);
      ElasticPoints points(config.material, pool);
      points.TissueChanged(tissue);
      Field x, unused(tissue.particle_count());
      for (const Eigen::Vector3d& p : state.position) x.push_back(Vector4::From(p));
      const double start = points.Evaluate(x, unused);
      AdvanceResult result;
      for (int n = 0; n < 900; ++n) {
        result = dynamics.Advance(tissue, {}, state);
        ASSERT_TRUE(IsFinite(state)) << "seed " << seed << ", step " << n;
      }
      EXPECT_LT(result.elastic_j, 0.05 * start) << "seed " << seed;
      // Shape, not only energy: distances are those at rest.
      const double now = (state.position.back() - state.position.front()).norm();
      const bool is_back = result.elastic_j < 1e-9 * start && std::abs(now - way) < 0.02 * way;
      came_back += is_back;
      EXPECT_TRUE(is_back || seed > kFirstSeed || GetParam().come_back == 0);
    }
    RecordProperty(integrator == Integrator::kImplicitEuler ? "implicit_euler" : "generalized_alpha", came_back);
    EXPECT_GE(came_back, GetParam().come_back);
  }
}

// With one integration point per cell a knot (neighbouring layers turned by about half a turn against each other) can be a
// local minimum of the energy: bodies crushed to a line or scrambled over their whole size may keep one, with all cells upright,
// and so may some of those that start in a point or as their mirror image: which, is chance.
// Exactly flat, straight or collapsed states are unstable equilibria by symmetry; a breath of noise is what any scene has.
INSTANTIATE_TEST_SUITE_P(
    Smith2018, DegenerateStartTest,
    testing::Values(
        Start{"plane", 8, [](const Eigen::Vector3d& X, std::mt19937& g) {
                return Eigen::Vector3d(X.x(), X.y(), 1e-6 * Uniform(g)); }},
        Start{"line", 0, [](const Eigen::Vector3d& X, std::mt19937& g) {
                return Eigen::Vector3d(X.x(), 1e-6 * Uniform(g), 1e-6 * Uniform(g)); }},
        Start{"point", 4, [](const Eigen::Vector3d&, std::mt19937& g) { return Eigen::Vector3d(1e-4 * Noise(g)); }},
        Start{"scramble", 0, [](const Eigen::Vector3d&, std::mt19937& g) { return Eigen::Vector3d(0.03 * Noise(g)); }},
        Start{"shake", 8, [](const Eigen::Vector3d& X, std::mt19937& g) { return Eigen::Vector3d(X + 0.01 * Noise(g)); }},
        Start{"reflection", 6, [](const Eigen::Vector3d& X, std::mt19937& g) {
                return Eigen::Vector3d(Eigen::Vector3d(X.x(), X.y(), -X.z()) + 1e-6 * Noise(g)); }}),
    [](const auto& parameter) { return parameter.param.name; });

struct Extreme {
  double youngs_modulus_pa, poisson_ratio, time_step_s;
};

class ExtremeTest : public testing::TestWithParam<Extreme> {};

TEST_P(ExtremeTest, StaysFinite) {
  const Tissue tissue = MakeBoxTissue(Box(true));
  for (const MaterialModel model : {MaterialModel::kStableNeoHookean, MaterialModel::kNeoHookean}) {
    DynamicsConfig config;
    config.time_step_s = GetParam().time_step_s;
    config.material = {model, GetParam().youngs_modulus_pa, GetParam().poisson_ratio, 1000};
    config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
    config.solver.threads = 1;
    Dynamics dynamics(config, tissue);
    TissueState state = RestState(tissue);
    for (int n = 0; n < 30; ++n) {
      const AdvanceResult result = dynamics.Advance(tissue, {}, state);
      ASSERT_TRUE(IsFinite(state)) << "step " << n;
      ASSERT_TRUE(std::isfinite(result.kinetic_j + result.elastic_j + result.relative_residual));
    }
  }
}

/// Every corner of 1 Pa .. 1 GPa, 0.3 .. 0.4999 and 1/1000 .. 1/10 s, and some of what lies between.
std::vector<Extreme> Extremes() {
  std::vector<Extreme> all;
  for (const double E : {1.0, 1e3, 1e5, 1e9}) {
    for (const double nu : {0.3, 0.4999}) {
      for (const double step : {1e-3, 1.0 / 60, 0.1}) all.push_back({E, nu, step});
    }
  }
  all.push_back({1e7, 0.49, 1e-3});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Corners, ExtremeTest, testing::ValuesIn(Extremes()));

/// Every cell a fragment of one point with eight particles of its own.
Tissue Shattered(const Tissue& whole) {
  Tissue tissue = whole;
  tissue.particle_rest.clear();
  tissue.particle_mass.clear();
  for (int p = 0; p < whole.point_count(); ++p) {
    for (int k = 0; k < 8; ++k) {
      int& j = tissue.point_particles[8 * p + k];
      tissue.particle_rest.push_back(whole.particle_rest[j]);
      tissue.particle_mass.push_back(1000 * whole.point_volume[p] / 8);
      j = 8 * p + k;
    }
  }
  tissue.particle_fixed.assign(tissue.particle_rest.size(), 0);
  return tissue;
}

TEST(Robustness, HundredsOfPiecesFallAsOneAndComeToRest) {
  BoxTissueConfig box;
  box.cells = {8, 8, 5};
  box.size = {0.08, 0.08, 0.05};
  const Tissue tissue = Shattered(MakeBoxTissue(box));
  DynamicsConfig config;
  config.material = {MaterialModel::kStableNeoHookean, 1e4, 0.45, 1000};
  config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  config.solver.threads = 1;
  Dynamics falling(config, tissue);
  TissueState state = RestState(tissue);
  for (int n = 0; n < 60; ++n) falling.Advance(tissue, {}, state);
  for (int j = 0; j < tissue.particle_count(); ++j) {
    EXPECT_NEAR(state.position[j].z() - tissue.particle_rest[j].z(), -0.5 * 9.81, 1e-9);
  }
  // Onto a plane: the pieces do not know of each other.
  config.damping = DampingConfig{2, 0.01};
  config.obstacles.push_back({PlaneObstacle{Eigen::Vector3d(0, 0, -0.002), Eigen::Vector3d::UnitZ()}, 0.5});
  SurfacePoints skin;
  for (int j = 0; j < tissue.particle_count(); ++j) {
    skin.particles.insert(skin.particles.end(), 8, j);
    skin.weights.push_back(1);
    skin.weights.insert(skin.weights.end(), 7, 0.0);
  }
  Dynamics landing(config, tissue);
  state = RestState(tissue);
  AdvanceResult result;
  for (int n = 0; n < 400; ++n) result = landing.Advance(tissue, skin, state);
  EXPECT_LT(result.kinetic_j, 1e-6);
  for (const Eigen::Vector3d& x : state.position) {
    ASSERT_TRUE(x.allFinite());
    EXPECT_GT(x.z(), -0.004);
    EXPECT_LT(x.z(), 0.03);
  }
}

TEST(Robustness, WhatIsCutFreeOfAFixedRegionFalls) {
  const BoxTissueConfig box = Box(true);
  const Tissue whole = MakeBoxTissue(box);
  Tissue cut = whole;
  // The first layer of cells keeps the particles at x = 1/6 of the box; the others get twins of them.
  std::vector<int> twin(whole.particle_count(), -1);
  for (int p = 0; p < whole.point_count(); ++p) {
    if (whole.point_rest[p].x() < 0.01) continue;
    for (int k = 0; k < 8; ++k) {
      int& j = cut.point_particles[8 * p + k];
      if (whole.particle_rest[j].x() > 0.0101) continue;
      if (twin[j] < 0) {
        twin[j] = cut.particle_count();
        cut.particle_rest.push_back(Eigen::Vector3d(whole.particle_rest[j]));
        cut.particle_mass.push_back(0.5 * whole.particle_mass[j]);
        cut.particle_mass[j] *= 0.5;
        cut.particle_fixed.push_back(0);
      }
      j = twin[j];
    }
  }
  DynamicsConfig config;
  config.material = {MaterialModel::kStableNeoHookean, 1e4, 0.45, 1000};
  config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  config.damping = DampingConfig{0, 0.01};
  config.solver.threads = 1;
  Dynamics dynamics(config, whole);
  TissueState state = RestState(whole);
  for (int n = 0; n < 200; ++n) dynamics.Advance(whole, {}, state);
  for (int j = 0; j < whole.particle_count(); ++j) {
    if (twin[j] < 0) continue;
    state.position.push_back(Eigen::Vector3d(state.position[j]));
    state.velocity.push_back(Eigen::Vector3d(state.velocity[j]));
    state.acceleration.push_back(Eigen::Vector3d(state.acceleration[j]));
  }
  // The order of twins above is that of their first use, not of j.
  for (int j = 0; j < whole.particle_count(); ++j) {
    if (twin[j] >= 0) state.position[twin[j]] = state.position[j];
  }
  const auto height = [&] {
    double sum = 0, mass = 0;
    for (int p = 0; p < cut.point_count(); ++p) {
      if (cut.point_rest[p].x() < 0.01) continue;
      for (int k = 0; k < 8; ++k) sum += state.position[cut.point_particles[8 * p + k]].z(), mass += 1;
    }
    return sum / mass;
  };
  const double start = height();
  dynamics.TissueChanged(cut);
  for (int n = 0; n < 60; ++n) {
    dynamics.Advance(cut, {}, state);
    ASSERT_TRUE(IsFinite(state));
  }
  EXPECT_NEAR(height() - start, -0.5 * 9.81, 0.02 * 4.9);
  for (int j = 0; j < whole.particle_count(); ++j) {
    if (!whole.particle_fixed[j]) continue;
    EXPECT_EQ(state.position[j], whole.particle_rest[j]);
  }
}

TEST(Robustness, UndampedEnergyOfAFreeBodyIsBounded) {
  const Tissue tissue = MakeBoxTissue(Box(false));
  DynamicsConfig config;
  config.material = {MaterialModel::kStableNeoHookean, 1e4, 0.45, 1000};
  config.solver.threads = 1;
  Dynamics dynamics(config, tissue);
  TissueState state = RestState(tissue);
  std::mt19937 generator(5);
  for (Eigen::Vector3d& v : state.velocity) v = 0.3 * Noise(generator) + Eigen::Vector3d(0.1, 0, 0);
  AdvanceResult result = dynamics.Advance(tissue, {}, state);
  const double start = result.kinetic_j + result.elastic_j;
  for (int n = 0; n < 1200; ++n) {
    result = dynamics.Advance(tissue, {}, state);
    ASSERT_LT(result.kinetic_j + result.elastic_j, 1.02 * start) << n;
  }
}

TEST(Robustness, ClampDraggedAtTenMetresPerSecondComesBack) {
  const BoxTissueConfig box = Box(true);
  const Tissue tissue = MakeBoxTissue(box);
  DynamicsConfig config;
  config.material = {MaterialModel::kStableNeoHookean, 1e4, 0.45, 1000};
  config.damping = DampingConfig{1, 0.02};
  config.solver.threads = 1;
  Dynamics dynamics(config, tissue);
  TissueState state = RestState(tissue);
  for (int n = 0; n < 600; ++n) {
    for (int j = 0; j < tissue.particle_count(); ++j) {
      if (n < 30 && tissue.particle_fixed[j]) state.position[j] += (n % 2 == 0 ? 1 : -1) * Eigen::Vector3d(0, 10.0 / 60, 0);
    }
    dynamics.Advance(tissue, {}, state);
    ASSERT_TRUE(IsFinite(state));
  }
  for (int j = 0; j < tissue.particle_count(); ++j) {
    EXPECT_LT((state.position[j] - tissue.particle_rest[j]).norm(), 1e-4);
  }
}

TEST(Robustness, PoisonedInputIsReplacedByTheLastGoodPositions) {
  const Tissue tissue = MakeBoxTissue(Box(true));
  DynamicsConfig config;
  config.material = {MaterialModel::kStableNeoHookean, 1e4, 0.45, 1000};
  config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  config.solver.threads = 1;
  Dynamics dynamics(config, tissue);
  TissueState state = RestState(tissue);
  dynamics.Advance(tissue, {}, state);
  state.position[7].y() = std::numeric_limits<double>::quiet_NaN();
  state.velocity[9].x() = std::numeric_limits<double>::infinity();
  dynamics.Advance(tissue, {}, state);
  EXPECT_TRUE(IsFinite(state));
}

TEST(Robustness, AnUnusableStartIsFrozenOrRepairedNeverNaN) {
  // Log neo-Hookean has no energy for inverted cells: nothing can be done but to keep still, and to say so.
  const Tissue tissue = MakeBoxTissue(Box(false));
  DynamicsConfig config;
  config.material = {MaterialModel::kNeoHookean, 1e4, 0.45, 1000};
  config.solver.threads = 1;
  Dynamics dynamics(config, tissue);
  TissueState state = RestState(tissue);
  for (Eigen::Vector3d& x : state.position) x.z() = -x.z();
  for (Eigen::Vector3d& v : state.velocity) v = Eigen::Vector3d(1, 1, 1);
  const AdvanceResult result = dynamics.Advance(tissue, {}, state);
  EXPECT_TRUE(result.status & kStepFrozen);
  EXPECT_TRUE(IsFinite(state));
  for (std::size_t j = 0; j < state.velocity.size(); ++j) EXPECT_EQ(state.velocity[j].norm(), 0);
}

/// A particle that all its points have left, light twins, and a fragment of one point.
TEST(Robustness, OrphansAndCrumbsFallWithTheRest) {
  Tissue tissue = MakeBoxTissue(Box(false));
  // The last cell becomes a fragment of one thousandth of a cell with eight twins; its far corner particle is left without mass.
  const int last = tissue.point_count() - 1;
  tissue.point_volume[last] *= 1e-3;
  for (int k = 0; k < 8; ++k) {
    int& j = tissue.point_particles[8 * last + k];
    const double share = 1000 * 1e-6 / 8;
    tissue.particle_mass[j] = std::max(0.0, tissue.particle_mass[j] - share);
    if (tissue.particle_mass[j] < 1e-12) tissue.particle_mass[j] = 0;
    tissue.particle_rest.push_back(Eigen::Vector3d(tissue.particle_rest[j]));
    tissue.particle_mass.push_back(1e-3 * share);
    tissue.particle_fixed.push_back(0);
    j = tissue.particle_count() - 1;
  }
  DynamicsConfig config;
  config.material = {MaterialModel::kStableNeoHookean, 1e4, 0.45, 1000};
  config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  config.solver.threads = 1;
  Dynamics dynamics(config, tissue);
  TissueState state = RestState(tissue);
  for (int n = 0; n < 60; ++n) dynamics.Advance(tissue, {}, state);
  for (int j = 0; j < tissue.particle_count(); ++j) {
    if (tissue.particle_mass[j] == 0) continue;
    EXPECT_NEAR(state.position[j].z() - tissue.particle_rest[j].z(), -0.5 * 9.81, 1e-10);
  }
}

}  // namespace
}  // namespace meshless_cutting
