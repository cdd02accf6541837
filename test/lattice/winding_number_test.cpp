#include "lattice/winding_number.h"

#include <gtest/gtest.h>

#include <tuple>

#include "lattice/closest_point.h"
#include "lattice/meshes.h"
#include "lattice/ray_cast.h"

namespace meshless_cutting {
namespace {

double Exact(const TriangleMesh& mesh, const Eigen::Vector3d& q) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    sum += TriangleWinding(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], q);
  }
  return sum;
}

std::vector<Eigen::Vector3d> RandomPoints(int count, double reach, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-reach, reach);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const double x = uniform(random);
    const double y = uniform(random);
    points.emplace_back(x, y, uniform(random));
  }
  return points;
}

TEST(WindingNumberTest, OneInsideZeroOutside) {
  const TriangleMesh sphere = meshes::Sphere(1);
  const TriangleTree tree(sphere);
  const WindingNumber winding(tree);
  for (const Eigen::Vector3d& q : RandomPoints(2000, 1.5, 1)) {
    if (std::abs(q.norm() - 1) < 0.01) continue;
    EXPECT_NEAR(winding(q), q.norm() < 1 ? 1 : 0, 0.05) << q.transpose();
  }
}

TEST(WindingNumberTest, DipolesAreNearTheSum) {
  for (const TriangleMesh& mesh : {meshes::Torus(1, 0.3), meshes::Noise(60, 300, 4),
                                   meshes::Without(meshes::Sphere(1), [](const auto& p) { return p.z() > 0.6; })}) {
    const TriangleTree tree(mesh);
    const WindingNumber winding(tree);
    for (const Eigen::Vector3d& q : RandomPoints(500, 1.5, 2)) EXPECT_NEAR(winding(q), Exact(mesh, q), 0.05);
  }
}

TEST(WindingNumberTest, NothingWindsAroundNothing) {
  const TriangleMesh empty;
  const TriangleTree tree(empty);
  EXPECT_EQ(WindingNumber(tree)({0, 0, 0}), 0);
  EXPECT_TRUE(Escapes(tree, {0, 0, 0}, {1, 0, 0}));
}

TEST(TriangleTreeTest, ClosestPointIsTheClosest) {
  const TriangleMesh mesh = meshes::Noise(40, 120, 7);
  const TriangleTree tree(mesh);
  for (const Eigen::Vector3d& q : RandomPoints(300, 2, 3)) {
    double best = 1e9;
    for (const auto& t : mesh.triangles) {
      const Eigen::Vector3d p =
          ClosestPointOnTriangle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], q);
      best = std::min(best, (p - q).norm());
    }
    const ClosestPoint found = FindClosestPoint(tree, q);
    EXPECT_DOUBLE_EQ(found.distance, best);
    EXPECT_NEAR((found.point - q).norm(), best, 1e-12);
  }
}

TEST(TriangleTreeTest, ClosestPointOnTriangleAgreesWithSampling) {
  std::mt19937 random(5);
  const auto points = RandomPoints(400, 1, 6);
  for (size_t i = 0; i + 3 < points.size(); i += 4) {
    const auto [a, b, c, q] = std::tie(points[i], points[i + 1], points[i + 2], points[i + 3]);
    const double found = (ClosestPointOnTriangle(a, b, c, q) - q).norm();
    double best = 1e9;
    constexpr int kSteps = 60;
    for (int u = 0; u <= kSteps; ++u) {
      for (int v = 0; u + v <= kSteps; ++v) {
        best = std::min(best, (a + (b - a) * u / kSteps + (c - a) * v / kSteps - q).norm());
      }
    }
    EXPECT_LE(found, best + 1e-12);
    EXPECT_GE(found, best - 0.1);
    // A flat triangle is a segment.
    const double on_segment = (ClosestPointOnTriangle(a, b, b, q) - q).norm();
    const double share = std::clamp((q - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    EXPECT_NEAR(on_segment, (a + share * (b - a) - q).norm(), 1e-12);
  }
}

TEST(TriangleTreeTest, NoRayLeavesAClosedBody) {
  const TriangleMesh sphere = meshes::Sphere(1);
  const TriangleTree tree(sphere);
  for (const Eigen::Vector3d& direction : RandomPoints(1000, 1, 8)) {
    const RayHit hit = FindFarthestHit(tree, {0.01, 0.02, 0.03}, direction.normalized());
    ASSERT_GE(hit.triangle, 0);
    EXPECT_NEAR(hit.at, 1, 0.05);
    EXPECT_FALSE(Escapes(tree, {0, 0, 0}, direction));
    EXPECT_TRUE(Escapes(tree, 1.5 * direction.normalized(), direction));
  }
  // Straight at vertices and along planes of boxes.
  for (const Eigen::Vector3d& v : sphere.vertices) EXPECT_FALSE(Escapes(tree, {0, 0, 0}, v));
  EXPECT_FALSE(Escapes(tree, {0, 0, 0}, {0, 0, -1}));
}

}  // namespace
}  // namespace meshless_cutting
