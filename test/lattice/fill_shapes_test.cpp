// Clean surfaces: exact boxes, and round bodies with an error that falls with the square of the lattice size.
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "lattice/lattice_builder.h"
#include "lattice/lattice_checks.h"
#include "lattice/lattice_quality.h"
#include "lattice/meshes.h"

namespace meshless_cutting {
namespace {

TEST(FillShapesTest, BoxesAreExact) {
  const Eigen::Vector3d min(0.1, -0.3, 7);
  for (const Eigen::Vector3d& size : {Eigen::Vector3d(0.1, 0.04, 0.04), Eigen::Vector3d(1, 1, 1),
                                      Eigen::Vector3d(0.123, 0.0456, 0.0789), Eigen::Vector3d(0.3, 0.2, 0.001)}) {
    for (const double lattice_size : {0.21 * size.maxCoeff(), 0.06 * size.maxCoeff(), 5 * size.maxCoeff()}) {
      const Eigen::Vector3d max = min + size;
      const FilledLattice filled = FillWithLattice(meshes::Box(min, max), lattice_size);
      ASSERT_EQ(CheckLattice(filled.lattice), "");
      const double volume = (max - min).prod();
      EXPECT_NEAR(filled.report.volume_m3 / volume, 1, 1e-12);
      const TriangleMesh skin = SkinOf(filled.lattice);
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector3d& p : skin.vertices) box.extend(p);
      EXPECT_EQ(box.min(), min);
      EXPECT_EQ(box.max(), max);
      int corners = 0;
      for (const Eigen::Vector3d& p : skin.vertices) {
        corners += ((p.array() == min.array()) || (p.array() == max.array())).all();
        const bool on_plane = ((p.array() == min.array()) || (p.array() == max.array())).any();
        EXPECT_TRUE(on_plane) << p.transpose();
      }
      EXPECT_EQ(corners, 8);
      EXPECT_LT(filled.report.input_to_skin_max_m, 1e-12);
      for (int axis = 0; axis < 3; ++axis) {
        const double cubes = (max - min)[axis] / filled.report.spacing[axis];
        EXPECT_NEAR(cubes, std::max(1.0, std::round((max - min)[axis] / lattice_size)), 1e-9);
      }
    }
  }
}

TEST(FillShapesTest, SphereConverges) {
  const TriangleMesh sphere = meshes::Sphere(0.05, 96, 192);
  double previous = 0;
  for (const double lattice_size : {0.02, 0.01, 0.005}) {
    const FilledLattice filled = FillWithLattice(sphere, lattice_size);
    ASSERT_EQ(CheckLattice(filled.lattice), "");
    const double error = EnclosedVolume(sphere) - filled.report.volume_m3;
    EXPECT_GT(error, 0) << "chords of a convex body lie inside";
    EXPECT_TRUE(previous == 0 || previous / error > 3) << "second order";
    previous = error;
    EXPECT_LT(filled.report.input_to_skin_max_m, 0.6 * lattice_size * lattice_size / 0.05 + 1e-4);
    EXPECT_LT(filled.report.skin_to_input_max_m, 1e-12);
    EXPECT_GT(filled.report.min_dihedral_deg, 10.7);
    EXPECT_LT(filled.report.max_dihedral_deg, 164.8);
  }
  EXPECT_LT(previous / EnclosedVolume(sphere), 0.01);
}

TEST(FillShapesTest, Torus) {
  const TriangleMesh torus = meshes::Torus(0.1, 0.03);
  const FilledLattice filled = FillWithLattice(torus, 0.008);
  ASSERT_EQ(CheckLattice(filled.lattice), "");
  EXPECT_NEAR(filled.report.volume_m3 / EnclosedVolume(torus), 1, 0.01);
  const TriangleMesh skin = SkinOf(filled.lattice);
  EXPECT_EQ(static_cast<int>(skin.vertices.size()) - static_cast<int>(skin.triangles.size()) / 2, 0) << "one hole";
}

TEST(FillShapesTest, ThinPlates) {
  const double lattice_size = 0.02;
  for (const double thickness : {0.6, 1.0, 1.5, 2.5}) {
    const TriangleMesh plate =
        meshes::Rotated(meshes::Box({0, 0, 0}, {0.3, 0.3, thickness * lattice_size}), 0.4, {1, 2, 3});
    const FilledLattice filled = FillWithLattice(plate, lattice_size);
    ASSERT_EQ(CheckLattice(filled.lattice), "") << "with gaps below the resolution, but valid";
    if (thickness < 1.5) continue;
    EXPECT_NEAR(filled.report.volume_m3 / EnclosedVolume(plate), 1, 0.01) << thickness;
    EXPECT_LT(filled.report.skin_to_input_max_m, 1e-12);
  }
}

TEST(FillShapesTest, DeterministicToTheBit) {
  const TriangleMesh mesh = meshes::Shaken(meshes::Sphere(0.1), 0.004, 3);
  const FilledLattice a = FillWithLattice(mesh, 0.02);
  const FilledLattice b = FillWithLattice(mesh, 0.02);
  EXPECT_EQ(a.lattice.vertices, b.lattice.vertices);
  EXPECT_EQ(a.lattice.tetrahedra, b.lattice.tetrahedra);
  EXPECT_EQ(a.report.input_to_skin_max_m, b.report.input_to_skin_max_m);
}

TEST(FillShapesTest, RefusesWhatCannotBeFilled) {
  const TriangleMesh box = meshes::Box({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(FillWithLattice(box, 0), std::runtime_error);
  EXPECT_THROW(FillWithLattice(box, -1), std::runtime_error);
  EXPECT_THROW(FillWithLattice(box, 1e-4), std::runtime_error) << "10^12 cubes";
  EXPECT_THROW(FillWithLattice({}, 0.1), std::runtime_error);
  TriangleMesh not_finite = box;
  not_finite.vertices[2].x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(FillWithLattice(not_finite, 0.1), std::runtime_error);
  const TriangleMesh disc = meshes::Without(box, [](const auto& p) { return p.z() > 0.1; });
  EXPECT_THROW(FillWithLattice(disc, 0.1), std::runtime_error) << "a sheet encloses nothing";
}

}  // namespace
}  // namespace meshless_cutting
