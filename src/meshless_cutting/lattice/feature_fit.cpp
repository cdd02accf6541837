#include "lattice/feature_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "lattice/closest_point.h"
#include "lattice/features.h"
#include "lattice/lattice_quality.h"
#include "lattice/triangle_tree.h"

namespace meshless_cutting {
namespace {

/// A move must leave all angles in this range or not make the extremes worse, degrees. A wider range makes more edges
/// crisp and worse tetrahedra; stuffing itself promises 10.7 to 164.8.
constexpr double kSmallestAngle = 10;
constexpr double kLargestAngle = 160;
/// No vertex moves farther, in lattice sizes.
constexpr double kReach = 1.0;
/// A skin link bridges a crease when its middle is farther than this from the surface, in lattice sizes.
constexpr double kBridge = 0.02;
constexpr int kPasses = 4;
/// With fewer skin vertices than this per corner the features are noise or finer than the lattice: nothing is pulled.
constexpr int kVerticesPerCorner = 20;

struct Move {
  double distance;
  int vertex;
  Eigen::Vector3d target;
  int corner;  // vertex of the surface, or -1
};

class Fitter {
 public:
  Fitter(const TriangleMesh& surface, Lattice* lattice)
      : surface_(surface),
        features_(FindFeatures(surface)),
        lattice_(*lattice),
        fixed_(lattice->vertices.size(), false),
        on_corner_(lattice->vertices.size(), false) {
    creases_.vertices = surface.vertices;
    for (const auto& [a, b] : features_.creases)
      creases_.triangles.push_back({a, b, b});  // a flat triangle is a segment
  }

  int Run() {
    if (features_.creases.empty()) return 0;
    FindSkin();
    if (kVerticesPerCorner * features_.corners.size() > skin_vertices_.size() + kVerticesPerCorner * 8) return 0;
    const TriangleTree surface_tree(surface_);
    const TriangleTree crease_tree(creases_);
    int moved = 0;
    for (int pass = 0; pass < kPasses; ++pass) {
      // Corners again in each pass: a vertex that would spoil its tetrahedra may not once its neighbours have moved.
      const int now = FitCorners() + FitCreases(surface_tree, crease_tree);
      moved += now;
      if (now == 0) break;
    }
    return moved;
  }

 private:
  void FindSkin() {
    std::set<int> links;
    std::set<int> vertices;
    for (size_t f = 0; f < lattice_.faces.size(); ++f) {
      if (lattice_.face_tetrahedra[f][1] >= 0) continue;
      links.insert(lattice_.face_links[f].begin(), lattice_.face_links[f].end());
      vertices.insert(lattice_.faces[f].begin(), lattice_.faces[f].end());
    }
    skin_links_.assign(links.begin(), links.end());
    skin_vertices_.assign(vertices.begin(), vertices.end());
  }

  int FitCorners() {
    std::vector<Move> moves;
    for (const int corner : features_.corners) {
      if (reached_.count(corner) > 0) continue;
      const Eigen::Vector3d& target = surface_.vertices[corner];
      for (const int v : skin_vertices_) {
        const double distance = (lattice_.vertices[v] - target).norm();
        if (distance < kReach) moves.push_back({distance, v, target, corner});
      }
    }
    std::stable_sort(moves.begin(), moves.end(), [](const Move& p, const Move& q) { return p.distance < q.distance; });
    int moved = 0;
    for (const Move& move : moves) {
      if (on_corner_[move.vertex] || reached_.count(move.corner) > 0 || !TryMove(move)) continue;
      reached_.insert(move.corner);
      on_corner_[move.vertex] = true;
      fixed_[move.vertex] = true;
      ++moved;
    }
    return moved;
  }

  int FitCreases(const TriangleTree& surface_tree, const TriangleTree& crease_tree) {
    std::set<int> candidates;
    for (const int l : skin_links_) {
      const auto& [a, b] = lattice_.links[l];
      const Eigen::Vector3d middle = 0.5 * (lattice_.vertices[a] + lattice_.vertices[b]);
      if (FindClosestPoint(surface_tree, middle).distance > kBridge) candidates.insert({a, b});
    }
    std::vector<Move> moves;
    for (const int v : candidates) {
      if (fixed_[v]) continue;
      const ClosestPoint nearest = FindClosestPoint(crease_tree, lattice_.vertices[v]);
      if (nearest.distance < kReach) moves.push_back({nearest.distance, v, nearest.point, -1});
    }
    std::stable_sort(moves.begin(), moves.end(), [](const Move& p, const Move& q) { return p.distance < q.distance; });
    int moved = 0;
    for (const Move& move : moves) {
      if (!StillBridges(surface_tree, move.vertex) || !TryMove(move)) continue;
      fixed_[move.vertex] = true;
      ++moved;
    }
    return moved;
  }

  /// A neighbour that has moved onto the crease may have ended the bridge.
  bool StillBridges(const TriangleTree& surface_tree, int v) const {
    for (const int* l = lattice_.vertex_links.begin(v); l != lattice_.vertex_links.end(v); ++l) {
      if (!std::binary_search(skin_links_.begin(), skin_links_.end(), *l)) continue;
      const auto& [a, b] = lattice_.links[*l];
      const Eigen::Vector3d middle = 0.5 * (lattice_.vertices[a] + lattice_.vertices[b]);
      if (!(fixed_[a] && fixed_[b]) && FindClosestPoint(surface_tree, middle).distance > kBridge) return true;
    }
    return false;
  }

  /// 1 or more when the angles of all tetrahedra at `v` are within the limits, 0 or less when one is flat or inverted.
  double QualityAt(int v) const {
    double quality = 180 / kSmallestAngle;
    for (const int* l = lattice_.vertex_links.begin(v); l != lattice_.vertex_links.end(v); ++l) {
      for (const int* i = lattice_.link_tetrahedra.begin(*l); i != lattice_.link_tetrahedra.end(*l); ++i) {
        const auto& t = lattice_.tetrahedra[*i];
        // Each tetrahedron has three links at v: once is enough.
        if (*l != FirstLinkAt(*i, v)) continue;
        const std::array<Eigen::Vector3d, 4> corners = {lattice_.vertices[t[0]], lattice_.vertices[t[1]],
                                                        lattice_.vertices[t[2]], lattice_.vertices[t[3]]};
        const Eigen::Vector3d a = corners[1] - corners[0];
        if (!(a.cross(corners[2] - corners[0]).dot(corners[3] - corners[0]) > 0)) return 0;
        const auto [low, high] = DihedralRange(corners);
        quality = std::min({quality, low / kSmallestAngle, (180 - high) / (180 - kLargestAngle)});
      }
    }
    return quality;
  }

  int FirstLinkAt(int tetrahedron, int v) const {
    for (int l = 0; l < 6; ++l) {
      const auto& [i, j] = kTetrahedronLinks[l];
      if (lattice_.tetrahedra[tetrahedron][i] == v || lattice_.tetrahedra[tetrahedron][j] == v) {
        return lattice_.tetrahedron_links[tetrahedron][l];
      }
    }
    return -1;
  }

  bool TryMove(const Move& move) {
    const double wanted = std::min(1.0, QualityAt(move.vertex));
    const Eigen::Vector3d old = lattice_.vertices[move.vertex];
    lattice_.vertices[move.vertex] = move.target;
    if (QualityAt(move.vertex) >= wanted || FollowWithNeighbours(move, old, wanted)) return true;
    lattice_.vertices[move.vertex] = old;
    return false;
  }

  /// Lets inner neighbours follow part of the way where this makes the worst tetrahedron better; undone if not enough.
  bool FollowWithNeighbours(const Move& move, const Eigen::Vector3d& old, double wanted) {
    std::vector<std::pair<int, Eigen::Vector3d>> undo;
    double reached = QualityAt(move.vertex);
    for (int round = 0; round < 3 && reached < wanted; ++round) {
      for (const int* l = lattice_.vertex_links.begin(move.vertex); l != lattice_.vertex_links.end(move.vertex); ++l) {
        const auto& [a, b] = lattice_.links[*l];
        const int u = a == move.vertex ? b : a;
        if (std::binary_search(skin_vertices_.begin(), skin_vertices_.end(), u)) continue;
        const Eigen::Vector3d before = lattice_.vertices[u];
        const double allowed = std::min(wanted, QualityAt(u));
        for (const double share : {0.3, 0.15, -0.15}) {
          lattice_.vertices[u] = before + share * (move.target - old);
          const double quality = QualityAt(move.vertex);
          if (quality > reached && QualityAt(u) >= std::min(allowed, quality)) {
            reached = quality;
            undo.push_back({u, before});
            break;
          }
          lattice_.vertices[u] = before;
        }
      }
    }
    bool good = reached >= wanted;
    for (const auto& [u, before] : undo) good = good && QualityAt(u) >= wanted;
    if (good) return true;
    for (auto it = undo.rbegin(); it != undo.rend(); ++it) lattice_.vertices[it->first] = it->second;
    return false;
  }

  const TriangleMesh& surface_;
  Features features_;
  TriangleMesh creases_;
  Lattice& lattice_;
  std::vector<bool> fixed_;      // per vertex: on a crease or corner
  std::vector<bool> on_corner_;  // per vertex: stays
  std::set<int> reached_;        // corners that have their vertex
  std::vector<int> skin_links_;
  std::vector<int> skin_vertices_;
};

}  // namespace

int PullOntoFeatures(const TriangleMesh& surface, Lattice* lattice) { return Fitter(surface, lattice).Run(); }

}  // namespace meshless_cutting
