// Isosurface stuffing promises good tetrahedra for *any* signs and cut points, not only for those of a surface.
#include "lattice/stuffing.h"

#include <gtest/gtest.h>

#include <random>

#include "lattice/lattice_checks.h"
#include "lattice/lattice_quality.h"
#include "lattice/manifold_repair.h"

namespace meshless_cutting {
namespace {

LatticeSigns RandomSigns(const BccGrid& grid, double inside, double on_surface, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  LatticeSigns signs;
  signs.sign.assign(grid.point_count(), -1);
  for (int v = 0; v < grid.point_count(); ++v) {
    if (grid.IsInterior(grid.Doubled(v)) && uniform(random) < inside) signs.sign[v] = 1;
    if (uniform(random) < on_surface) signs.sign[v] = 0;
  }
  for (int v = 0; v < grid.point_count(); ++v) {
    for (int step = 0; step < BccGrid::kEdgesPerPoint; ++step) {
      const auto& s = BccGrid::kSteps[step];
      const Eigen::Vector3i upper = grid.Doubled(v) + Eigen::Vector3i(s[0], s[1], s[2]);
      if (!grid.Contains(upper) || signs.sign[v] * signs.sign[grid.Index(upper)] >= 0) continue;
      signs.cut_edges.push_back(v * BccGrid::kEdgesPerPoint + step);
      signs.cut_at.push_back(1e-9 + (1 - 2e-9) * uniform(random));
    }
  }
  return signs;
}

TEST(BccGridTest, IndicesGoBackAndForth) {
  const BccGrid grid(Eigen::AlignedBox3d(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(3, 1, 2)), 1);
  EXPECT_EQ(grid.point_count(), 4 * 2 * 3 + 5 * 3 * 4);
  for (int v = 0; v < grid.point_count(); ++v) {
    EXPECT_TRUE(grid.Contains(grid.Doubled(v)));
    EXPECT_EQ(grid.Index(grid.Doubled(v)), v);
  }
}

TEST(BccGridTest, PlanesOfTheBoxAreExact) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(0.1, -0.7, 1e3), Eigen::Vector3d(0.4, 0.2, 1e3 + 0.3));
  const BccGrid grid(box, 0.07);
  EXPECT_EQ(grid.ToLattice(box.max()), Eigen::Vector3d(grid.cubes().cast<double>()));
  EXPECT_EQ(grid.ToObject(grid.ToLattice(box.max())), box.max());
  EXPECT_EQ(grid.ToObject(grid.ToLattice(box.min())), box.min());
}

class RandomSignsTest : public testing::TestWithParam<unsigned> {};

TEST_P(RandomSignsTest, AnglesAreBoundedAndTheSkinIsClosed) {
  const unsigned seed = GetParam();
  const BccGrid grid(Eigen::AlignedBox3d(Eigen::Vector3d::Zero(), Eigen::Vector3d(6, 5, 4)), 1);
  TetrahedronSoup soup = Stuff(grid, RandomSigns(grid, 0.4 + 0.14 * (seed % 5), 0, seed));
  ASSERT_FALSE(soup.tetrahedra.empty());
  double low = 180;
  double high = 0;
  for (const auto& t : soup.tetrahedra) {
    const auto range =
        DihedralRange({soup.vertices[t[0]], soup.vertices[t[1]], soup.vertices[t[2]], soup.vertices[t[3]]});
    low = std::min(low, range[0]);
    high = std::max(high, range[1]);
  }
  EXPECT_GT(low, 10.7);  // the bounds of Labelle & Shewchuk 2007
  EXPECT_LT(high, 164.8);
  RepairManifold(&soup);
  EXPECT_EQ(CheckLattice(BuildLattice(soup.vertices, soup.tetrahedra)), "");
}

TEST_P(RandomSignsTest, PointsOnTheSurfaceKeepItValid) {
  const unsigned seed = GetParam();
  const BccGrid grid(Eigen::AlignedBox3d(Eigen::Vector3d::Zero(), Eigen::Vector3d(5, 5, 5)), 1);
  TetrahedronSoup soup = Stuff(grid, RandomSigns(grid, 0.5, 0.1 * (1 + seed % 6), seed));
  RepairManifold(&soup);
  EXPECT_EQ(CheckLattice(BuildLattice(soup.vertices, soup.tetrahedra)), "");
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomSignsTest, testing::Range(1u, 61u));

}  // namespace
}  // namespace meshless_cutting
