// BuildLattice: links, faces and incidences from vertices and tetrahedra.
#include "lattice/lattice.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "lattice/lattice_builder.h"
#include "lattice/lattice_checks.h"
#include "lattice/meshes.h"

namespace meshless_cutting {
namespace {

const std::vector<Eigen::Vector3d> kCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};

TEST(LatticeTest, TablesFitTogether) {
  for (int f = 0; f < 4; ++f) {
    const auto& face = kTetrahedronFaces[f];
    for (const int v : face) EXPECT_NE(v, f) << "face f is opposite to vertex f";
    const Eigen::Vector3d normal = (kCorners[face[1]] - kCorners[face[0]]).cross(kCorners[face[2]] - kCorners[face[0]]);
    EXPECT_LT(normal.dot(kCorners[f] - kCorners[face[0]]), 0) << "face " << f << " looks outward";
  }
}

TEST(LatticeTest, OneTetrahedron) {
  const Lattice lattice = BuildLattice({kCorners.begin(), kCorners.begin() + 4}, {{0, 1, 2, 3}});
  EXPECT_EQ(CheckLattice(lattice), "");
  EXPECT_EQ(lattice.links.size(), 6u);
  EXPECT_EQ(lattice.faces.size(), 4u);
}

TEST(LatticeTest, TwoTetrahedraShareAFace) {
  const Lattice lattice = BuildLattice(kCorners, {{0, 1, 2, 3}, {1, 2, 3, 4}});
  EXPECT_EQ(CheckLattice(lattice), "");
  EXPECT_EQ(lattice.links.size(), 9u);
  EXPECT_EQ(lattice.faces.size(), 7u);
  const int shared = lattice.tetrahedron_faces[0][0];
  EXPECT_EQ(shared, lattice.tetrahedron_faces[1][3]);
  EXPECT_EQ(lattice.face_tetrahedra[shared], (std::array<int, 2>{0, 1}));
}

TEST(LatticeTest, ThreeTetrahedraAtAFaceAreRefused) {
  EXPECT_THROW(BuildLattice(kCorners, {{0, 1, 2, 3}, {1, 2, 3, 4}, {0, 1, 2, 3}}), std::invalid_argument);
}

TEST(LatticeTest, EmptyStaysEmpty) {
  const Lattice lattice = BuildLattice({}, {});
  EXPECT_TRUE(lattice.links.empty());
  EXPECT_EQ(CheckLattice(lattice), "there is no tetrahedron");
}

// The predicate must see what it promises to see.
TEST(LatticeTest, ChecksSeeDamage) {
  const Lattice good = FillWithLattice(meshes::Sphere(1, 12, 16), 0.4).lattice;
  ASSERT_EQ(CheckLattice(good), "");
  Lattice bad = good;
  std::swap(bad.tetrahedra[5][0], bad.tetrahedra[5][1]);
  EXPECT_NE(CheckLattice(bad), "");
  bad = good;
  std::swap(bad.faces[3][0], bad.faces[3][1]);
  EXPECT_NE(CheckLattice(bad), "");
  bad = good;
  bad.vertices.emplace_back(0, 0, 0);
  EXPECT_NE(CheckLattice(bad), "");
  bad = good;
  std::swap(bad.link_tetrahedra.items.front(), bad.link_tetrahedra.items.back());
  EXPECT_NE(CheckLattice(bad), "");
  // Two tetrahedra that share a vertex only, or an edge only: conforming, but the skin is not a manifold.
  EXPECT_NE(CheckLattice(BuildLattice({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
                                      {{0, 1, 2, 3}, {0, 5, 4, 6}})),
            "");
  EXPECT_NE(CheckLattice(BuildLattice({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, -1}},
                                      {{0, 1, 2, 3}, {0, 1, 4, 5}})),
            "");
}

}  // namespace
}  // namespace meshless_cutting
