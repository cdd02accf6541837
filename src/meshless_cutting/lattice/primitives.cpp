#include "lattice/primitives.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

namespace meshless_cutting {
namespace {

constexpr int kSides = 96;
constexpr double kPi = 3.14159265358979323846;

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double AreaOf(const std::vector<Eigen::Vector2d>& outline) {
  double area = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) area += 0.5 * Cross(outline[i], outline[(i + 1) % outline.size()]);
  return area;
}

/// Triangles of a simple polygon that runs counter-clockwise, by cutting off ears.
std::vector<std::array<int, 3>> Triangulate(const std::vector<Eigen::Vector2d>& outline) {
  std::vector<int> left(outline.size());
  std::iota(left.begin(), left.end(), 0);
  std::vector<std::array<int, 3>> triangles;
  while (left.size() > 2) {
    const std::size_t n = left.size();
    std::size_t ear = 0;  // of a polygon that is simple there always is one; else the first corner must do
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector2d &a = outline[left[(i + n - 1) % n]], &b = outline[left[i]], &c = outline[left[(i + 1) % n]];
      if (Cross(b - a, c - a) <= 0) continue;
      bool empty = true;
      for (std::size_t j = 0; j < n && empty; ++j) {
        if (j == i || j == (i + 1) % n || j == (i + n - 1) % n) continue;
        const Eigen::Vector2d& p = outline[left[j]];
        empty = !(Cross(b - a, p - a) >= 0 && Cross(c - b, p - b) >= 0 && Cross(a - c, p - c) >= 0);
      }
      if (!empty) continue;
      ear = i;
      break;
    }
    triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

/// The polygon at `to` (axis direction) and, reversed, at `from`, and the sides between them. `place(point, height)`.
template <class Place>
TriangleMesh Extrude(std::vector<Eigen::Vector2d> outline, double from, double to, const Place& place) {
  if (AreaOf(outline) < 0) outline = {outline.rbegin(), outline.rend()};
  const int n = static_cast<int>(outline.size());
  TriangleMesh mesh;
  for (double height : {from, to}) {
    for (const Eigen::Vector2d& p : outline) mesh.vertices.push_back(place(p, height));
  }
  for (const auto& t : Triangulate(outline)) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({n + t[0], n + t[1], n + t[2]});
  }
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n;
    mesh.triangles.push_back({i, next, n + next});
    mesh.triangles.push_back({i, n + next, n + i});
  }
  return mesh;
}

TriangleMesh MeshOfShape(const PrismPrimitive& prism) {
  return Extrude(prism.outline, prism.from, prism.to, [&](const Eigen::Vector2d& p, double height) {
    Eigen::Vector3d X;
    X[prism.axis] = height;
    X[(prism.axis + 1) % 3] = p[0];
    X[(prism.axis + 2) % 3] = p[1];
    return X;
  });
}

TriangleMesh MeshOfShape(const Box& box) {
  PrismPrimitive prism;
  prism.outline = {{box.min.x(), box.min.y()}, {box.max.x(), box.min.y()}, {box.max.x(), box.max.y()},
                   {box.min.x(), box.max.y()}};
  prism.from = box.min.z();
  prism.to = box.max.z();
  return MeshOfShape(prism);
}

TriangleMesh MeshOfShape(const CylinderPrimitive& cylinder) {
  const Eigen::Vector3d axis = (cylinder.end - cylinder.start).normalized();
  const Eigen::Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  const double angle = 2 * kPi / kSides, radius = cylinder.radius * std::sqrt(angle / std::sin(angle));
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < kSides; ++i) outline.emplace_back(radius * std::cos(i * angle), radius * std::sin(i * angle));
  return Extrude(outline, 0, (cylinder.end - cylinder.start).norm(), [&](const Eigen::Vector2d& p, double height) {
    return Eigen::Vector3d(cylinder.start + height * axis + p[0] * u + p[1] * v);
  });
}

}  // namespace

TriangleMesh MeshOf(const Primitive& primitive) {
  return std::visit([](const auto& shape) { return MeshOfShape(shape); }, primitive);
}

}  // namespace meshless_cutting
