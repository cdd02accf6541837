// Any mesh gives a valid lattice: holes, flipped and repeated faces, self-intersections, noise.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "lattice/lattice_builder.h"
#include "lattice/lattice_checks.h"
#include "lattice/lattice_quality.h"
#include "lattice/meshes.h"

namespace meshless_cutting {
namespace {

constexpr double kSize = 0.15;

/// Fills, checks, and compares the volume. Returns the report.
LatticeReport Fill(const TriangleMesh& mesh, double volume, double tolerance) {
  const FilledLattice filled = FillWithLattice(mesh, kSize);
  EXPECT_EQ(CheckLattice(filled.lattice), "");
  EXPECT_NEAR(filled.report.volume_m3 / volume, 1, tolerance);
  return filled.report;
}

TEST(FillBadMeshesTest, DirectionAndMultiplicityDoNotMatter) {
  const TriangleMesh sphere = meshes::Sphere(1);
  const LatticeReport clean = Fill(sphere, EnclosedVolume(sphere), 0.01);
  for (const TriangleMesh& mesh :
       {meshes::Flipped(sphere, 1), meshes::Flipped(sphere, 0.3), meshes::Soup(meshes::Flipped(sphere, 0.3)),
        meshes::Repeated(sphere, 2, 0), meshes::Repeated(sphere, 2, 1), meshes::Repeated(sphere, 3, 0.5)}) {
    const LatticeReport report = Fill(mesh, EnclosedVolume(sphere), 0.01);
    EXPECT_NEAR(report.volume_m3, clean.volume_m3, 1e-9);
    EXPECT_LT(report.skin_to_input_max_m, 1e-12);
  }
}

TEST(FillBadMeshesTest, OverlappingBoxes) {
  const TriangleMesh a = meshes::Box({0, 0, 0}, {1, 1, 1});
  // On lattice planes (0.15 fits ten times into 1.5), and off them.
  Fill(meshes::Joined(a, meshes::Box({0.45, 0.45, 0.45}, {1.5, 1.5, 1.5})), 1 + 1.157625 - 0.166375, 0.02);
  const LatticeReport off =
      Fill(meshes::Joined(a, meshes::Rotated(meshes::Box({0.4, 0.4, 0.4}, {1.5, 1.5, 1.5}), 0.3, {1, 2, 3})), 2.2, 0.1);
  EXPECT_LT(off.skin_to_input_max_m, 1e-12) << "cut points lie on the input also where surfaces intersect";
  EXPECT_LT(off.input_to_skin_mean_m, 0.02 * kSize) << "hidden parts do not count";
}

TEST(FillBadMeshesTest, TouchingBoxes) {
  const TriangleMesh a = meshes::Box({0, 0, 0}, {0.6, 0.6, 0.6});
  for (const Eigen::Vector3d& by : {Eigen::Vector3d(0.6, 0, 0), Eigen::Vector3d(0.6, 0.6, 0),
                                    Eigen::Vector3d(0.6, 0.6, 0.6), Eigen::Vector3d(0.6, 0.3, 0.3)}) {
    Fill(meshes::Joined(a, meshes::Moved(a, by)), 2 * 0.216, 1e-9);
  }
}

TEST(FillBadMeshesTest, HolesAreSpanned) {
  const TriangleMesh sphere = meshes::Sphere(1);
  const TriangleMesh open = meshes::Without(sphere, [](const auto& p) { return p.z() > 0.9; });  // 5 % of the area
  const LatticeReport report = Fill(open, EnclosedVolume(sphere), 0.02);
  EXPECT_LT(report.input_to_skin_mean_m, 0.03 * kSize);
  EXPECT_LT(report.skin_to_input_max_m, 0.45) << "within the hole, whose radius is 0.44";
  // 5 % of all faces, missing here and there.
  std::mt19937 random(1);
  const TriangleMesh sieve = meshes::Without(sphere, [&](const auto&) { return random() % 20 == 0; });
  Fill(sieve, EnclosedVolume(sphere), 0.02);
  // A box without its lid, exactly on lattice points.
  Fill(meshes::Without(meshes::Box({0, 0, 0}, {1, 1, 1}), [](const auto& p) { return p.z() > 0.9; }), 1, 0.05);
}

TEST(FillBadMeshesTest, Cavities) {
  const TriangleMesh outer = meshes::Sphere(1);
  const TriangleMesh inner = meshes::Sphere(0.5);
  const double hollow = EnclosedVolume(outer) - EnclosedVolume(inner);
  Fill(meshes::Joined(outer, meshes::Flipped(inner, 1)), hollow, 0.02);
  Fill(meshes::Flipped(meshes::Joined(outer, meshes::Flipped(inner, 1)), 1), hollow, 0.02);
  Fill(meshes::Joined(outer, inner), EnclosedVolume(outer), 0.02);
  Fill(meshes::Flipped(meshes::Joined(outer, inner), 0.3), EnclosedVolume(outer), 0.02);
}

TEST(FillBadMeshesTest, InnerWallsDoNotMatter) {
  const TriangleMesh box = meshes::Box({0, 0, 0}, {1, 1, 1});
  TriangleMesh walled = box;
  const int first = static_cast<int>(walled.vertices.size());
  for (const double y : {0.2, 0.8}) {
    walled.vertices.emplace_back(0.31, y, 0.2);
    walled.vertices.emplace_back(0.47, y, 0.8);
  }
  walled.triangles.push_back({first, first + 1, first + 2});
  walled.triangles.push_back({first + 1, first + 3, first + 2});
  const LatticeReport report = Fill(walled, 1, 1e-12);
  EXPECT_LT(report.input_to_skin_max_m, 1e-12);
}

class NoiseTest : public testing::TestWithParam<unsigned> {};

/// What has no inside is refused in words; all else gives a valid lattice.
void FillOrRefuse(const TriangleMesh& mesh, double lattice_size, unsigned seed) {
  try {
    const FilledLattice filled = FillWithLattice(mesh, lattice_size);
    EXPECT_EQ(CheckLattice(filled.lattice), "") << seed;
    EXPECT_TRUE(std::isfinite(filled.report.input_to_skin_max_m));
    EXPECT_GT(filled.report.volume_m3, 0);
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("nothing is inside"), std::string::npos) << error.what();
  }
}

TEST_P(NoiseTest, RandomTriangles) {
  const unsigned seed = GetParam();
  FillOrRefuse(meshes::Noise(6 + seed % 23, 4 + 3 * seed % 50, seed), 0.06, seed);
}

TEST_P(NoiseTest, ShakenBodies) {
  const unsigned seed = GetParam();
  const double amplitude = 0.02 * (seed % 12);
  FillOrRefuse(meshes::Flipped(meshes::Shaken(meshes::Sphere(1, 10, 16), amplitude, seed), 0.1 * (seed % 4), seed), 0.2,
               seed);
  FillOrRefuse(meshes::Shaken(meshes::Torus(1, 0.3, 12, 8), amplitude, seed), 0.2, seed);
}

TEST_P(NoiseTest, CoordinatesOnAGrid) {
  // Vertices on lattice points and planes: every degenerate position at once.
  const unsigned seed = GetParam();
  TriangleMesh mesh = meshes::Noise(8 + seed % 13, 10 + seed % 40, seed);
  for (Eigen::Vector3d& p : mesh.vertices) p = (4 * p).array().round() / 4;
  FillOrRefuse(mesh, 0.125, seed);
}

TEST_P(NoiseTest, RandomBoxes) {
  std::mt19937 random(GetParam());
  TriangleMesh mesh;
  for (int i = 0; i < 4; ++i) {
    Eigen::Vector3d min;
    Eigen::Vector3d size;
    for (int axis = 0; axis < 3; ++axis) {
      min[axis] = random() % 8 * 0.125;
      size[axis] = (1 + random() % 4) * 0.125;
    }
    mesh = meshes::Joined(mesh, meshes::Box(min, min + size));
  }
  FillOrRefuse(mesh, 0.125, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Seeds, NoiseTest, testing::Range(1u, 61u));

}  // namespace
}  // namespace meshless_cutting
