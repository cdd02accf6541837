#include "lattice/features.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

namespace meshless_cutting {
namespace {

/// Below it a surface counts as smooth. Lower values pin the facets of coarsely triangulated round bodies.
constexpr double kCosineOfCrease = 0.766044443118978;  // 40 degrees

}  // namespace

Features FindFeatures(const TriangleMesh& mesh) {
  struct Side {
    std::array<int, 2> ends;
    int triangle;
    bool operator<(const Side& other) const {
      return ends != other.ends ? ends < other.ends : triangle < other.triangle;
    }
  };
  std::vector<Side> sides;
  std::vector<Eigen::Vector3d> normals;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const Eigen::Vector3d& a = mesh.vertices[t[0]];
    normals.push_back((mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized());
    for (int k = 0; k < 3; ++k) {
      sides.push_back({{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}, static_cast<int>(i)});
    }
  }
  std::sort(sides.begin(), sides.end());
  Features features;
  std::map<int, std::vector<int>> others;  // vertex -> far ends of its creases
  for (size_t i = 0; i < sides.size();) {
    size_t end = i + 1;
    while (end < sides.size() && sides[end].ends == sides[i].ends) ++end;
    if (end - i == 2) {
      const Eigen::Vector3d& n0 = normals[sides[i].triangle];
      const Eigen::Vector3d& n1 = normals[sides[i + 1].triangle];
      if (!n0.isZero() && !n1.isZero() && n0.dot(n1) < kCosineOfCrease) {
        const auto [a, b] = sides[i].ends;
        features.creases.push_back(sides[i].ends);
        others[a].push_back(b);
        others[b].push_back(a);
      }
    }
    i = end;
  }
  for (const auto& [v, ends] : others) {
    bool is_corner = ends.size() != 2;
    if (!is_corner) {
      const Eigen::Vector3d in = mesh.vertices[v] - mesh.vertices[ends[0]];
      const Eigen::Vector3d out = mesh.vertices[ends[1]] - mesh.vertices[v];
      is_corner = in.normalized().dot(out.normalized()) < kCosineOfCrease;
    }
    if (is_corner) features.corners.push_back(v);
  }
  return features;
}

}  // namespace meshless_cutting
