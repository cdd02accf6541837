// Edges and corners of the input stay sharp where the tetrahedra allow it.
#include "lattice/feature_fit.h"

#include <gtest/gtest.h>

#include "lattice/features.h"
#include "lattice/lattice_builder.h"
#include "lattice/lattice_checks.h"
#include "lattice/meshes.h"

namespace meshless_cutting {
namespace {

TEST(FeaturesTest, ABoxHasTwelveCreasesAndEightCorners) {
  const Features features = FindFeatures(meshes::Box({0, 0, 0}, {1, 2, 3}));
  EXPECT_EQ(features.creases.size(), 12u);
  EXPECT_EQ(features.corners.size(), 8u);
}

TEST(FeaturesTest, ASphereHasNone) {
  const Features features = FindFeatures(meshes::Sphere(1));
  EXPECT_TRUE(features.creases.empty());
  EXPECT_TRUE(features.corners.empty());
}

TEST(FeaturesTest, ARimHasNoCorners) {
  const TriangleMesh cylinder = ReadTriangleMesh(MESHLESS_CUTTING_SOURCE_DIR "/meshes/cylinder.obj", 1);
  const Features features = FindFeatures(cylinder);
  EXPECT_EQ(features.creases.size(), 2u * 96u);
  EXPECT_TRUE(features.corners.empty());
}

TEST(FeatureFitTest, TheRimOfACylinderIsCrisp) {
  const TriangleMesh cylinder = ReadTriangleMesh(MESHLESS_CUTTING_SOURCE_DIR "/meshes/cylinder.obj", 1);
  const FilledLattice filled = FillWithLattice(cylinder, 0.006);
  ASSERT_EQ(CheckLattice(filled.lattice), "");
  EXPECT_LT(filled.report.input_to_skin_max_m, 0.06 * 0.006);
  EXPECT_LT(filled.report.skin_to_input_max_m, 1e-12);
  EXPECT_GT(filled.report.min_dihedral_deg, 9);
  EXPECT_LT(filled.report.max_dihedral_deg, 165);
}

TEST(FeatureFitTest, RotatedBoxesKeepTheirEdges) {
  for (int i = 0; i < 6; ++i) {
    const TriangleMesh box =
        meshes::Rotated(meshes::Box({-1, -1, -1}, {1, 1, 1}), 0.2 + 0.4 * i, {1, 2.0 + i, 3.0 - i});
    const FilledLattice filled = FillWithLattice(box, 0.25);
    ASSERT_EQ(CheckLattice(filled.lattice), "");
    EXPECT_LT(filled.report.input_to_skin_mean_m, 0.01 * 0.25);
    EXPECT_LT(filled.report.input_to_skin_max_m, 0.5 * 0.25);
    EXPECT_LT(filled.report.skin_to_input_max_m, 1e-12);
    EXPECT_NEAR(filled.report.volume_m3, 8, 0.02);
    EXPECT_GT(filled.report.min_dihedral_deg, 9);
  }
}

}  // namespace
}  // namespace meshless_cutting
