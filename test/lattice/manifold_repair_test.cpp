#include "lattice/manifold_repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "lattice/lattice_builder.h"
#include "lattice/lattice_checks.h"
#include "lattice/lattice_quality.h"
#include "lattice/meshes.h"

namespace meshless_cutting {
namespace {

double Volume(const TetrahedronSoup& soup) {
  double volume = 0;
  for (const auto& t : soup.tetrahedra) {
    const Eigen::Vector3d& a = soup.vertices[t[0]];
    volume += (soup.vertices[t[1]] - a).cross(soup.vertices[t[2]] - a).dot(soup.vertices[t[3]] - a) / 6;
  }
  return volume;
}

std::string Check(const TetrahedronSoup& soup) { return CheckLattice(BuildLattice(soup.vertices, soup.tetrahedra)); }

TEST(ManifoldRepairTest, SharedVertexIsSplit) {
  TetrahedronSoup soup{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
                       {{0, 1, 2, 3}, {0, 5, 4, 6}}};
  EXPECT_EQ(RepairManifold(&soup), 0);
  EXPECT_EQ(soup.vertices.size(), 8u);
  EXPECT_EQ(soup.tetrahedra.size(), 2u);
  EXPECT_EQ(Check(soup), "");
}

TEST(ManifoldRepairTest, SharedEdgeIsSplit) {
  TetrahedronSoup soup{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, -1}},
                       {{0, 1, 2, 3}, {0, 1, 4, 5}}};
  EXPECT_EQ(RepairManifold(&soup), 0);
  EXPECT_EQ(soup.vertices.size(), 8u);
  EXPECT_EQ(Check(soup), "");
}

/// 4 x 4 x 4 unit cubes of six tetrahedra each (Kuhn 1960), without the cubes (i, j, k) for which `is_removed`.
template <typename Predicate>
TetrahedronSoup CubesWithout(const Predicate& is_removed) {
  TetrahedronSoup soup;
  for (int i = 0; i < 125; ++i) soup.vertices.emplace_back(i / 25, i / 5 % 5, i % 5);
  for (int cube = 0; cube < 64; ++cube) {
    const Eigen::Vector3i low(cube / 16, cube / 4 % 4, cube % 4);
    if (is_removed(low)) continue;
    std::array<int, 3> axes = {0, 1, 2};
    do {
      std::array<int, 4> t;
      Eigen::Vector3i at = low;
      for (int k = 0; k < 4; ++k) {
        t[k] = at.dot(Eigen::Vector3i(25, 5, 1));
        if (k < 3) at += Eigen::Vector3i::Unit(axes[k]);
      }
      if ((axes[1] - axes[0] + 3) % 3 != 1) std::swap(t[2], t[3]);
      soup.tetrahedra.push_back(t);
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
  return soup;
}

bool IsIn(const Eigen::Vector3i& cube, const Eigen::Vector3i& low, const Eigen::Vector3i& high) {
  return (cube.array() >= low.array()).all() && (cube.array() <= high.array()).all();
}

TEST(ManifoldRepairTest, CavitiesThatTouchAlongALineKeepTheirVolume) {
  TetrahedronSoup soup = CubesWithout([](const auto& cube) {
    return IsIn(cube, {1, 1, 1}, {1, 1, 2}) || IsIn(cube, {2, 2, 1}, {2, 2, 2});
  });
  ASSERT_NE(Check(soup), "");
  EXPECT_EQ(RepairManifold(&soup), 0);
  EXPECT_EQ(Check(soup), "");
  EXPECT_NEAR(Volume(soup), 60, 1e-9);
}

TEST(ManifoldRepairTest, FansThatMeetElsewhereKeepTheirVolume) {
  // One link between the cavities: its ends are not split, their tetrahedra are joined all around.
  TetrahedronSoup soup = CubesWithout([](const auto& cube) {
    return IsIn(cube, {1, 1, 1}, {1, 1, 1}) || IsIn(cube, {2, 2, 1}, {2, 2, 1});
  });
  ASSERT_NE(Check(soup), "");
  EXPECT_EQ(RepairManifold(&soup), 0);
  EXPECT_EQ(soup.vertices.size(), 126u);
  EXPECT_EQ(Check(soup), "");
  EXPECT_NEAR(Volume(soup), 62, 1e-9);
}

TEST(ManifoldRepairTest, CavitiesThatMeetAtAVertexAreJoined) {
  TetrahedronSoup soup = CubesWithout([](const auto& cube) {
    return IsIn(cube, {1, 1, 1}, {1, 1, 1}) || IsIn(cube, {2, 2, 2}, {2, 2, 2});
  });
  ASSERT_NE(Check(soup), "");
  EXPECT_GT(RepairManifold(&soup), 0);
  EXPECT_EQ(Check(soup), "");
  EXPECT_GT(Volume(soup), 61);
}

TEST(ManifoldRepairTest, AnySetOfTetrahedraBecomesAManifold) {
  const Lattice box = FillWithLattice(meshes::Box({0, 0, 0}, {4, 4, 4}), 1).lattice;
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    TetrahedronSoup soup = seed % 2 ? CubesWithout([&](const auto&) { return random() % 2 == 0; })
                                    : TetrahedronSoup{box.vertices, box.tetrahedra};
    const double share = seed / 60.0;
    std::vector<std::array<int, 4>> kept;
    for (const auto& t : soup.tetrahedra) {
      if (random() >= share * 4294967296.0) kept.push_back(t);
    }
    soup.tetrahedra = kept;
    RepairManifold(&soup);
    EXPECT_EQ(Check(soup), "") << seed;
  }
}

TEST(ManifoldRepairTest, NothingStaysNothing) {
  TetrahedronSoup soup;
  EXPECT_EQ(RepairManifold(&soup), 0);
}

}  // namespace
}  // namespace meshless_cutting
