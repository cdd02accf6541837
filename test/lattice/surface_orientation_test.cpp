// Whatever the direction and multiplicity of triangles, the surface comes out outward.
#include "lattice/surface_orientation.h"

#include <gtest/gtest.h>

#include "lattice/lattice_quality.h"
#include "lattice/meshes.h"

namespace meshless_cutting {
namespace {

TEST(SurfaceOrientationTest, FlippedFacesTurnOutward) {
  const TriangleMesh torus = meshes::Torus(1, 0.3);
  const double volume = EnclosedVolume(torus);
  for (const double share : {0.0, 0.01, 0.3, 0.5, 0.7, 0.99, 1.0}) {
    for (const bool soup : {false, true}) {
      TriangleMesh mesh = meshes::Flipped(torus, share);
      if (soup) mesh = meshes::Soup(mesh);
      const TriangleMesh turned = OrientOutward(mesh);
      EXPECT_EQ(turned.triangles.size(), torus.triangles.size());
      EXPECT_NEAR(EnclosedVolume(turned), volume, 1e-12) << share;
    }
  }
}

TEST(SurfaceOrientationTest, EqualTrianglesCountOnce) {
  const TriangleMesh sphere = meshes::Sphere(1);
  for (const double flipped : {0.0, 0.5, 1.0}) {
    for (const int times : {2, 3}) {
      const TriangleMesh turned = OrientOutward(meshes::Repeated(sphere, times, flipped));
      EXPECT_EQ(turned.triangles.size(), sphere.triangles.size());
      EXPECT_NEAR(EnclosedVolume(turned), EnclosedVolume(sphere), 1e-12);
    }
  }
}

TEST(SurfaceOrientationTest, ShellsTurnOneByOne) {
  const TriangleMesh sphere = meshes::Sphere(1);
  const TriangleMesh other = meshes::Flipped(meshes::Moved(sphere, {3, 0, 0}), 1);
  EXPECT_NEAR(EnclosedVolume(OrientOutward(meshes::Joined(sphere, other))), 2 * EnclosedVolume(sphere), 1e-9);
}

TEST(SurfaceOrientationTest, ACavityStaysACavity) {
  const TriangleMesh outer = meshes::Sphere(1);
  const TriangleMesh inner = meshes::Sphere(0.5);
  const TriangleMesh hollow = meshes::Joined(outer, meshes::Flipped(inner, 1));
  const double volume = EnclosedVolume(outer) - EnclosedVolume(inner);
  EXPECT_NEAR(EnclosedVolume(OrientOutward(hollow)), volume, 1e-9);
  EXPECT_NEAR(EnclosedVolume(OrientOutward(meshes::Flipped(hollow, 1))), volume, 1e-9) << "turned as a whole";
}

TEST(SurfaceOrientationTest, AnUndecidedInnerShellIsSolid) {
  const TriangleMesh outer = meshes::Sphere(1);
  const TriangleMesh inner = meshes::Sphere(0.5);
  const double volume = EnclosedVolume(outer) + EnclosedVolume(inner);  // wound around twice
  const TriangleMesh mixed = meshes::Flipped(meshes::Joined(outer, inner), 0.3);
  EXPECT_NEAR(EnclosedVolume(OrientOutward(mixed)), volume, 1e-9);
}

TEST(SurfaceOrientationTest, InnerWallsGo) {
  const TriangleMesh low = meshes::Box({0, 0, 0}, {1, 1, 1});
  const TriangleMesh high = meshes::Box({0, 0, 1}, {1, 1, 2});
  const TriangleMesh turned = OrientOutward(meshes::Joined(low, high));
  EXPECT_EQ(turned.triangles.size(), 20u);
  EXPECT_NEAR(EnclosedVolume(turned), 2, 1e-12);
}

TEST(SurfaceOrientationTest, FarFromTheOrigin) {
  const TriangleMesh sphere = meshes::Moved(meshes::Flipped(meshes::Sphere(0.1), 0.4), {1000, -500, 200});
  EXPECT_NEAR(EnclosedVolume(OrientOutward(sphere)) / EnclosedVolume(meshes::Sphere(0.1)), 1, 1e-6);
}

TEST(SurfaceOrientationTest, NothingStaysNothing) { EXPECT_TRUE(OrientOutward({}).triangles.empty()); }

}  // namespace
}  // namespace meshless_cutting
