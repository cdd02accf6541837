#include "drawn_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace meshless_cutting {
namespace {

using Vector = Eigen::Vector3f;

Vector At(const std::vector<float>& xyz, std::uint32_t i) { return {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]}; }

// Of a triangle, as long as twice its area.
Vector Normal(const std::vector<float>& xyz, const std::uint32_t* v) {
  const Vector a = At(xyz, v[0]);
  return (At(xyz, v[1]) - a).cross(At(xyz, v[2]) - a);
}

// Sets of corners that share a drawn vertex.
class Corners {
 public:
  explicit Corners(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t Find(std::uint32_t corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }
  void Join(std::uint32_t a, std::uint32_t b) { parent_[Find(a)] = Find(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

// An edge of a triangle: its vertices in rising order, and the corner from which the triangle runs along it.
struct Edge {
  std::uint32_t low, high, corner;
  bool operator<(const Edge& other) const {
    return std::tie(low, high, corner) < std::tie(other.low, other.high, other.corner);
  }
};

std::uint32_t Next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

std::vector<Edge> SortedEdges(const std::vector<std::uint32_t>& triangles) {
  std::vector<Edge> edges;
  edges.reserve(triangles.size());
  for (std::uint32_t corner = 0; corner < triangles.size(); ++corner) {
    const std::uint32_t a = triangles[corner], b = triangles[Next(corner)];
    edges.push_back({std::min(a, b), std::max(a, b), corner});
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace

DrawnMesh::DrawnMesh(const SurfaceTopology& topology, float crease_angle) {
  const std::vector<std::uint32_t>& triangles = topology.triangles;
  const float crease_cosine = std::cos(crease_angle);
  const auto smooth = [&](std::uint32_t t, std::uint32_t u) {
    if (topology.region[t] != topology.region[u]) return false;
    if (topology.region[t] != SurfaceTopology::SKIN) return true;  // jagged at the size of the lattice
    const Vector n = Normal(topology.rest_positions, &triangles[3 * t]);
    const Vector m = Normal(topology.rest_positions, &triangles[3 * u]);
    return n.dot(m) >= crease_cosine * n.norm() * m.norm();
  };
  Corners corners(triangles.size());
  const std::vector<Edge> edges = SortedEdges(triangles);
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const Edge &e = edges[i], &f = edges[i + 1];
    // The two triangles of an edge run along it in opposite directions.
    if (e.low != f.low || e.high != f.high || triangles[e.corner] == triangles[f.corner]) continue;
    if (!smooth(e.corner / 3, f.corner / 3)) continue;
    corners.Join(e.corner, Next(f.corner));
    corners.Join(Next(e.corner), f.corner);
  }
  constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::uint32_t> drawn(triangles.size(), kNone);  // per root corner
  triangles_.resize(triangles.size());
  for (std::uint32_t corner = 0; corner < triangles.size(); ++corner) {
    std::uint32_t& index = drawn[corners.Find(corner)];
    if (index == kNone) {
      index = static_cast<std::uint32_t>(vertex_.size());
      vertex_.push_back(triangles[corner]);
      region_.push_back(topology.region[corner / 3]);
      fragment_.push_back(topology.fragment[corner / 3]);
    }
    triangles_[corner] = index;
  }
}

void DrawnMesh::Normals(const std::vector<float>& positions, std::vector<std::array<float, 3>>* normals) const {
  std::vector<Vector> sums(vertex_.size(), Vector::Zero());
  for (std::size_t t = 0; t + 2 < triangles_.size(); t += 3) {
    const std::uint32_t v[3] = {vertex_[triangles_[t]], vertex_[triangles_[t + 1]], vertex_[triangles_[t + 2]]};
    const Vector normal = Normal(positions, v);
    for (int k = 0; k < 3; ++k) sums[triangles_[t + k]] += normal;
  }
  normals->resize(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const float length = sums[i].norm();
    const Vector unit = length > 0 ? Vector(sums[i] / length) : Vector::UnitZ();
    (*normals)[i] = {unit.x(), unit.y(), unit.z()};
  }
}

}  // namespace meshless_cutting
