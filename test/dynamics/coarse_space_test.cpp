#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstring>
#include <random>
#include <set>
#include <utility>

#include "dynamics/aggregates.h"
#include "dynamics/dynamics.h"
#include "dynamics/fragments.h"
#include "dynamics/block_cholesky.h"
#include "support/box_tissue.h"

namespace meshless_cutting {
namespace {

TEST(BlockCholesky, SolvesWhatADenseSolverSolves) {
  const std::vector<int> first = {0, 0, 1, 0, 3, 2, 6};
  const int n = BlockCholesky::kBlock * static_cast<int>(first.size());
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  BlockCholesky factor;
  factor.Reset(first);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = BlockCholesky::kBlock * first[i / BlockCholesky::kBlock]; j < i; ++j) A(i, j) = A(j, i) = uniform(generator);
    A(i, i) = 30;
  }
  for (int i = 0; i < n; ++i) {
    for (int j = BlockCholesky::kBlock * first[i / BlockCholesky::kBlock]; j <= i; ++j) factor.At(i, j) = A(i, j);
  }
  factor.Factor();
  Eigen::VectorXd b(n);
  for (int i = 0; i < n; ++i) b[i] = uniform(generator);
  Eigen::VectorXf x = b.cast<float>();
  factor.Solve(x.data());  // in single precision
  EXPECT_LT((A * x.cast<double>() - b).norm(), 1e-7 * n);
}

TEST(BlockCholesky, TakesOutRowsWithoutPivot) {
  // Row 1 stays zero, row 15 equals row 14; of both nothing comes back, and nothing goes wrong elsewhere.
  const int n = 2 * BlockCholesky::kBlock;
  BlockCholesky factor;
  factor.Reset({0, 0});
  for (int i = 0; i < n; ++i) factor.At(i, i) = i == 1 ? 0 : 4;
  factor.At(14, 3) = factor.At(15, 3) = 1;
  factor.At(15, 14) = 4;
  factor.Factor();
  std::vector<float> x(n, 8);
  factor.Solve(x.data());
  EXPECT_EQ(x[1], 0);
  EXPECT_EQ(x[15], 0);
  EXPECT_FLOAT_EQ(x[0], 2);
  EXPECT_FLOAT_EQ(4 * x[3] + x[14], 8);
  EXPECT_FLOAT_EQ(x[3] + 4 * x[14], 8);
}

/// Two boxes side by side in one tissue, joined nowhere though their particles coincide: a cut through.
Tissue CutInTwo() {
  BoxTissueConfig box;
  box.cells = {8, 4, 4};
  box.size = {0.08, 0.04, 0.04};
  Tissue tissue = MakeBoxTissue(box);
  std::vector<int> twin(tissue.particle_count(), -1);
  for (int p = 0; p < tissue.point_count(); ++p) {
    if (tissue.point_rest[p].x() < 0.03) continue;
    for (int k = 0; k < 8; ++k) {
      int& j = tissue.point_particles[8 * p + k];
      if (std::abs(tissue.particle_rest[j].x() - 0.03) > 1e-9) continue;
      if (twin[j] < 0) {
        twin[j] = tissue.particle_count();
        tissue.particle_rest.push_back(Eigen::Vector3d(tissue.particle_rest[j]));
        tissue.particle_mass.push_back(0.5 * tissue.particle_mass[j]);
        tissue.particle_mass[j] *= 0.5;
        tissue.particle_fixed.push_back(0);
      }
      j = twin[j];
    }
  }
  return tissue;
}

TEST(Fragments, FindsThePieces) {
  Tissue tissue = CutInTwo();
  tissue.particle_fixed[0] = 1;
  Fragments fragments;
  fragments.Build(tissue);
  ASSERT_EQ(fragments.count(), 2);
  EXPECT_EQ(fragments.held[fragments.of_particle[0]], 1);
  EXPECT_EQ(fragments.held[1 - fragments.of_particle[0]], 0);
}

TEST(Aggregates, CoverWhatMovesAndSpanNoCut) {
  Tissue tissue = CutInTwo();
  std::vector<double> free(tissue.particle_count(), 1);
  free[5] = 0;
  Fragments fragments;
  fragments.Build(tissue);
  Aggregates aggregates;
  aggregates.Build(tissue, free, 6);
  EXPECT_GT(aggregates.count(), 3);
  EXPECT_EQ(aggregates.of_particle[5], -1);
  EXPECT_EQ(aggregates.begin.back(), tissue.particle_count() - 1);
  for (int a = 0; a < aggregates.count(); ++a) {
    std::set<int> pieces;
    Eigen::Matrix4d product = Eigen::Matrix4d::Zero();
    for (int i = aggregates.begin[a]; i < aggregates.begin[a + 1]; ++i) {
      const int j = aggregates.particles[i];
      EXPECT_EQ(aggregates.of_particle[j], a);
      pieces.insert(fragments.of_particle[j]);
      const Eigen::Map<const Eigen::Vector4d> b(&aggregates.basis[j].x);
      product += b * b.transpose();
    }
    EXPECT_EQ(pieces.size(), 1u);
    // Orthonormal, but for the functions that a flat aggregate does without.
    EXPECT_NEAR(product(0, 0), 1, 1e-12);
    for (int c = 1; c < 4; ++c) EXPECT_LT(std::min(std::abs(product(c, c)), std::abs(product(c, c) - 1)), 1e-6);
    EXPECT_LT((product - Eigen::Matrix4d(product.diagonal().asDiagonal())).norm(), 1e-6);
  }
}

TEST(Aggregates, TwinsJoinTheAggregateOfTheParticleThatTheyCameFrom) {
  BoxTissueConfig box;
  box.cells = {8, 4, 4};
  box.size = {0.08, 0.04, 0.04};
  Tissue tissue = MakeBoxTissue(box);
  std::vector<double> free(tissue.particle_count(), 1);
  free[3] = 0;
  Aggregates aggregates;
  aggregates.Build(tissue, free, 6);
  const Aggregates before = aggregates;
  const int known = tissue.particle_count();
  for (int j : {100, 3, 17}) tissue.particle_rest.push_back(Eigen::Vector3d(tissue.particle_rest[j]));
  tissue.particle_rest.push_back(Eigen::Vector3d(1, 2, 3));  // nobody's twin
  free[100] = 0;                                             // all its points went to the twin
  free.resize(known + 4, 1);
  aggregates.Extend(tissue, free);
  EXPECT_EQ(aggregates.count(), before.count());
  EXPECT_EQ(aggregates.of_particle[100], -1);
  EXPECT_EQ(aggregates.of_particle[known], before.of_particle[100]);
  EXPECT_EQ(aggregates.of_particle[known + 1], -1);  // the twin of one that was in none
  EXPECT_EQ(aggregates.of_particle[known + 2], before.of_particle[17]);
  EXPECT_EQ(aggregates.of_particle[known + 3], -1);
  EXPECT_EQ(std::memcmp(&aggregates.basis[known], &before.basis[100], sizeof(Vector4)), 0);
  std::vector<int> listed(known + 4);
  for (int a = 0; a < aggregates.count(); ++a) {
    for (int i = aggregates.begin[a]; i < aggregates.begin[a + 1]; ++i) {
      EXPECT_EQ(aggregates.of_particle[aggregates.particles[i]], a);
      ++listed[aggregates.particles[i]];
    }
  }
  for (int j = 0; j < known + 4; ++j) EXPECT_EQ(listed[j], aggregates.of_particle[j] >= 0) << j;
}

/// How many iterations steps take some frames after a cut, and at most in any frame since, when aggregates and matrix are made
/// again on the way, against a solver that never knew the uncut object.
TEST(Preconditioner, ServesThroughACutAndIsAsGoodAsNewAfterwards) {
  BoxTissueConfig box;
  box.cells = {8, 4, 4};
  box.size = {0.08, 0.04, 0.04};
  const Tissue whole = MakeBoxTissue(box), halves = CutInTwo();
  DynamicsConfig config;
  config.material = {MaterialModel::kStableNeoHookean, 1e5, 0.45, 1000};
  config.solver.threads = 1;
  const auto iterations = [&](bool is_cut_while_running, double speed) {
    Dynamics dynamics(config, is_cut_while_running ? whole : halves);
    TissueState state;
    state.position = halves.particle_rest;
    state.position.resize(is_cut_while_running ? whole.particle_count() : halves.particle_count());
    state.velocity.assign(state.position.size(), Eigen::Vector3d::Zero());
    const auto kick = [&](const Tissue& tissue) {
      for (int j = 0; j < tissue.particle_count(); ++j) {
        state.velocity[j] += Eigen::Vector3d(0, speed * std::sin(80 * tissue.particle_rest[j].x()), 0);
      }
    };
    if (is_cut_while_running) {
      kick(whole);
      for (int n = 0; n < 5; ++n) dynamics.Advance(whole, {}, state);
      // Twins begin where their originals are.
      state.position = halves.particle_rest;
      state.velocity.assign(state.position.size(), Eigen::Vector3d::Zero());
      state.acceleration.assign(state.position.size(), Eigen::Vector3d::Zero());
      dynamics.TissueChanged(halves);
    }
    int late = 0, most = 0;
    kick(halves);
    for (int n = 0; n < 100; ++n) {
      const AdvanceResult result = dynamics.Advance(halves, {}, state);
      EXPECT_FALSE(result.status & (kStepRolledBack | kStepFrozen)) << n;
      if (n >= 60) late += result.linear_iterations;
      most = std::max(most, result.linear_iterations);
    }
    return std::pair<int, int>(late, most);
  };
  // At different speeds the steps take different numbers of solves, and the remaking falls on different ones.
  for (double speed : {0.05, 0.1, 0.15, 0.2, 0.25}) {
    const auto [fresh, most_fresh] = iterations(false, speed);
    const auto [cut, most_cut] = iterations(true, speed);
    EXPECT_LT(cut, 1.2 * fresh) << speed;
    EXPECT_LT(most_cut, 2 * most_fresh) << speed;
  }
}

}  // namespace
}  // namespace meshless_cutting
