// The meshes of this package: closed, in metres, of the size that scenes and tests rely on.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>

#include "lattice/lattice_builder.h"
#include "lattice/lattice_checks.h"
#include "lattice/lattice_quality.h"

namespace meshless_cutting {
namespace {

TriangleMesh Read(const std::string& name) {
  return ReadTriangleMesh(std::filesystem::path(MESHLESS_CUTTING_SOURCE_DIR) / "meshes" / name, 1);
}

Eigen::AlignedBox3d BoxOf(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : mesh.vertices) box.extend(p);
  return box;
}

TEST(ShippedMeshesTest, AreClosedAndOutward) {
  for (const std::string name : {"liver.obj", "block.obj", "cylinder.obj", "sphere.obj", "scalpel.stl"}) {
    const TriangleMesh mesh = Read(name);
    std::map<std::array<int, 2>, int> sides;
    for (const auto& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
    }
    for (const auto& [side, count] : sides) {
      EXPECT_EQ(count, 1) << name;
      EXPECT_EQ(sides.count({side[1], side[0]}), 1u) << name;
    }
    EXPECT_GT(EnclosedVolume(mesh), 0) << name;
  }
}

TEST(ShippedMeshesTest, BlockIsExact) {
  const TriangleMesh block = Read("block.obj");
  EXPECT_EQ(block.triangles.size(), 12u);
  EXPECT_EQ(BoxOf(block).min(), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(BoxOf(block).max(), Eigen::Vector3d(0.1, 0.04, 0.04));
  const FilledLattice filled = FillWithLattice(block, 0.004);
  EXPECT_EQ(CheckLattice(filled.lattice), "");
  EXPECT_NEAR(filled.report.volume_m3 / 0.00016, 1, 1e-12);
}

TEST(ShippedMeshesTest, LiverIsALiverInSize) {
  const TriangleMesh liver = Read("liver.obj");
  EXPECT_GE(liver.triangles.size(), 10000u);
  EXPECT_NEAR(BoxOf(liver).sizes().x(), 0.2, 0.001);
  EXPECT_LT(BoxOf(liver).center().norm(), 1e-4);
  EXPECT_GT(EnclosedVolume(liver), 0.6e-3);
  EXPECT_LT(EnclosedVolume(liver), 0.8e-3);
  const FilledLattice filled = FillWithLattice(liver, 0.004);
  EXPECT_EQ(CheckLattice(filled.lattice), "");
  EXPECT_GE(SkinOf(filled.lattice).triangles.size(), 10000u) << "what the demo draws";
  EXPECT_NEAR(filled.report.volume_m3 / EnclosedVolume(liver), 1, 0.005);
  EXPECT_LT(filled.report.input_to_skin_mean_m, 1e-4);
  EXPECT_LT(filled.report.input_to_skin_max_m, 1.5e-3);
  EXPECT_LT(filled.report.skin_to_input_max_m, 1e-12);
  EXPECT_GT(filled.report.min_dihedral_deg, 9);
}

TEST(ShippedMeshesTest, CylinderAndSphere) {
  const TriangleMesh cylinder = Read("cylinder.obj");
  EXPECT_TRUE(BoxOf(cylinder).sizes().isApprox(Eigen::Vector3d(0.06, 0.1, 0.06), 1e-3));
  EXPECT_LT(BoxOf(cylinder).center().norm(), 1e-9);
  const TriangleMesh sphere = Read("sphere.obj");
  for (const Eigen::Vector3d& p : sphere.vertices) EXPECT_NEAR(p.norm(), 0.05, 2e-6);
}

TEST(ShippedMeshesTest, TheScalpelCutsAlongItsZAxis) {
  const TriangleMesh scalpel = Read("scalpel.stl");
  EXPECT_LT(BoxOf(scalpel).min().z(), 0.0005);
  EXPECT_GE(BoxOf(scalpel).min().x(), -0.002) << "the body of the blade is on the side of +x";
  for (const Eigen::Vector3d& p : scalpel.vertices) {
    EXPECT_GE(p.x(), p.z() < 0.03 ? -1e-9 : -0.002);
  }
}

}  // namespace
}  // namespace meshless_cutting
