#include "drawn_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace meshless_cutting {
namespace {

constexpr float kCrease = 0.8f;

// A cube of 12 triangles, 8 vertices.
SurfaceTopology Cube() {
  SurfaceTopology cube;
  for (int v = 0; v < 8; ++v) {
    for (const int bit : {1, 2, 4}) cube.rest_positions.push_back(v & bit ? 1.f : 0.f);
  }
  cube.triangles = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                    2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  cube.region.assign(12, SurfaceTopology::SKIN);
  cube.fragment.assign(12, 0);
  return cube;
}

TEST(DrawnMeshTest, ABoxKeepsItsEdges) {
  const SurfaceTopology cube = Cube();
  const DrawnMesh mesh(cube, kCrease);
  EXPECT_EQ(mesh.vertex().size(), 24u) << "three normals at each corner";
  std::vector<std::array<float, 3>> normals;
  mesh.Normals(cube.rest_positions, &normals);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const float largest = std::max({std::abs(normals[i][0]), std::abs(normals[i][1]), std::abs(normals[i][2])});
    EXPECT_NEAR(largest, 1, 1e-6) << "along an axis";
    float outward = 0;
    for (int axis = 0; axis < 3; ++axis) {
      outward += normals[i][axis] * (cube.rest_positions[3 * mesh.vertex()[i] + axis] - 0.5f);
    }
    EXPECT_NEAR(outward, 0.5f, 1e-6);
  }
}

TEST(DrawnMeshTest, IsSmoothWhereTheSkinIs) {
  const SurfaceTopology cube = Cube();
  const DrawnMesh mesh(cube, 2.0f);  // right angles count as smooth
  EXPECT_EQ(mesh.vertex().size(), 8u);
  std::vector<std::array<float, 3>> normals;
  mesh.Normals(cube.rest_positions, &normals);
  for (const auto& n : normals) EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-5);
}

TEST(DrawnMeshTest, SkinAndCutFaceDoNotShareVertices) {
  SurfaceTopology cube = Cube();
  cube.region[2] = cube.region[3] = SurfaceTopology::CUT_FACE;
  const DrawnMesh mesh(cube, 2.0f);
  EXPECT_EQ(mesh.vertex().size(), 12u) << "the four corners of the cut face twice";
  for (std::size_t t = 0; t < 12; ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t drawn = mesh.triangles()[3 * t + k];
      EXPECT_EQ(mesh.region()[drawn], cube.region[t]);
      EXPECT_EQ(mesh.vertex()[drawn], cube.triangles[3 * t + k]);
    }
  }
}

TEST(DrawnMeshTest, TrianglesWithoutAreaGiveAUnitNormal) {
  SurfaceTopology cube = Cube();
  std::vector<float> point(cube.rest_positions.size(), 0.5f);
  std::vector<std::array<float, 3>> normals;
  DrawnMesh(cube, kCrease).Normals(point, &normals);
  for (const auto& n : normals) EXPECT_EQ(n[2], 1);
}

TEST(DrawnMeshTest, NothingIsNothing) {
  const DrawnMesh mesh(SurfaceTopology(), kCrease);
  std::vector<std::array<float, 3>> normals(3);
  mesh.Normals({}, &normals);
  EXPECT_TRUE(normals.empty());
}

}  // namespace
}  // namespace meshless_cutting
