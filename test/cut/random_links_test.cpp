// The surface is closed and physics, mapping and surface agree for *any* set of cut links, not only for those a blade
// can make.
#include <gtest/gtest.h>

#include <random>

#include "cut/soft_body.h"
#include "simulation_checks.h"
#include "support/shapes.h"

namespace meshless_cutting {
namespace {

ObjectConfig Config(double cell_size, double radius = 0.9) {
  ObjectConfig config;
  config.cell_size_m = cell_size;
  config.material.density_kg_m3 = 1000;
  config.support_radius_cells = radius;
  config.fixed = {{{-0.001, -0.001, -0.001}, {0.0101, 0.031, 0.021}}};  // whole layers of nodes: pieces come off beside them
  return config;
}

class RandomLinks : public testing::TestWithParam<double> {};

TEST_P(RandomLinks, KeepAllInvariants) {
  const double share = GetParam();
  const Lattice lattice = FillWithLattice(BoxMesh({0, 0, 0}, {0.04, 0.03, 0.02}), 0.008).lattice;
  std::mt19937 random(static_cast<unsigned>(1000 * share));
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int trial = 0; trial < 8; ++trial) {
    SoftBody body(lattice, Config(trial % 2 ? 0.012 : 0.01), true);
    const double volume = RestVolume(body.surface());
    ASSERT_EQ(CheckBody(body), "");
    for (int round = 0; round < 4; ++round) {
      std::vector<LinkCut> cuts;
      for (size_t l = 0; l < lattice.links.size(); ++l)
        if (!body.graph().IsCut(static_cast<int>(l)) && uniform(random) < share / 4)
          cuts.push_back({static_cast<int>(l), uniform(random)});
      if (cuts.empty()) continue;
      body.CloseWindow();
      body.Cut(cuts);
      body.BeginAdvance();
      body.EndAdvance();
      ASSERT_EQ(CheckBody(body), "") << "share " << share << " trial " << trial << " round " << round;
      ASSERT_NEAR(RestVolume(body.surface()), volume, 1e-12 * volume);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shares, RandomLinks, testing::Values(0.01, 0.05, 0.2, 0.4, 0.6, 0.8, 1.0));

TEST(RandomLinks, KeepMassAndMomentum) {
  const Lattice lattice = FillWithLattice(BoxMesh({0, 0, 0}, {0.04, 0.03, 0.02}), 0.008).lattice;
  SoftBody body(lattice, Config(0.01), true);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (auto& v : body.mutable_state().velocity) v = Eigen::Vector3d::NullaryExpr([&] { return uniform(random); });
  auto momentum = [&] {
    double mass = 0;
    Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = linear;
    for (size_t j = 0; j < body.state().position.size(); ++j) {
      mass += body.tissue().particle_mass[j];
      linear += body.tissue().particle_mass[j] * body.state().velocity[j];
      angular += body.tissue().particle_mass[j] * body.state().position[j].cross(body.state().velocity[j]);
    }
    return std::make_tuple(mass, linear, angular);
  };
  const auto [mass, linear, angular] = momentum();
  std::vector<LinkCut> cuts;
  for (size_t l = 0; l < lattice.links.size(); ++l)
    if (uniform(random) > -0.6) cuts.push_back({static_cast<int>(l), 0.5});
  body.CloseWindow();
  body.Cut(cuts);
  EXPECT_GT(body.surface().fragment_volume_m3.size(), 5u);
  const auto [mass_after, linear_after, angular_after] = momentum();
  EXPECT_NEAR(mass_after, mass, 1e-12 * mass);
  EXPECT_LT((linear_after - linear).norm(), 1e-12 * mass);
  EXPECT_LT((angular_after - angular).norm(), 1e-12 * mass * 0.04);
}

TEST(RandomLinks, WideSupportsToo) {
  const Lattice lattice = FillWithLattice(BoxMesh({0, 0, 0}, {0.04, 0.03, 0.02}), 0.008).lattice;
  SoftBody body(lattice, Config(0.01, 1.75), true);
  ASSERT_EQ(CheckBody(body), "");
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<LinkCut> cuts;
  for (size_t l = 0; l < lattice.links.size(); ++l)
    if (uniform(random) < 0.3) cuts.push_back({static_cast<int>(l), uniform(random)});
  body.CloseWindow();
  body.Cut(cuts);
  body.BeginAdvance();
  body.EndAdvance();
  EXPECT_EQ(CheckBody(body), "");
}

}  // namespace
}  // namespace meshless_cutting
