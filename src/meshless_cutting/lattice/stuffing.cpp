#include "lattice/stuffing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace meshless_cutting {
namespace {

/// Shares of a long and of a short edge within which a cut point draws a lattice point onto itself: the "safe" pair of
/// Labelle & Shewchuk 2007, which bounds the angles for surfaces of any shape.
constexpr double kAlphaLong = 0.24999;
constexpr double kAlphaShort = 0.41189;

double Alpha(int step) { return step < 3 ? kAlphaLong : kAlphaShort; }

struct Cut {
  int edge;
  double at;
};

class Stuffer {
 public:
  Stuffer(const BccGrid& grid, LatticeSigns signs) : grid_(grid), sign_(std::move(signs.sign)) {
    cuts_.resize(signs.cut_edges.size());
    for (size_t i = 0; i < cuts_.size(); ++i) cuts_[i] = {signs.cut_edges[i], signs.cut_at[i]};
  }

  TetrahedronSoup Run() {
    Warp();
    point_vertex_.assign(sign_.size(), -1);
    cut_vertex_.assign(cuts_.size(), -1);
    for (int v = 0; v < grid_.point_count(); ++v) {
      const Eigen::Vector3i centre = grid_.Doubled(v);
      if ((centre.x() & 1) == 0) continue;
      for (int axis = 0; axis < 3; ++axis) FillAround(v, centre, axis);
    }
    return std::move(soup_);
  }

 private:
  int Lower(const Cut& cut) const { return cut.edge / BccGrid::kEdgesPerPoint; }
  int Upper(const Cut& cut) const {
    const auto& step = BccGrid::kSteps[cut.edge % BccGrid::kEdgesPerPoint];
    return grid_.Index(grid_.Doubled(Lower(cut)) + Eigen::Map<const Eigen::Vector3i>(step.data()));
  }
  Eigen::Vector3d PointOf(const Cut& cut) const {
    return (1 - cut.at) * grid_.Point(Lower(cut)) + cut.at * grid_.Point(Upper(cut));
  }

  /// Nearest first: a point takes the cut that is closest in units of alpha, and the other cuts on its edges vanish.
  void Warp() {
    struct Violation {
      double ratio;
      int point;
      int cut;
    };
    std::vector<Violation> violations;
    for (int c = 0; c < static_cast<int>(cuts_.size()); ++c) {
      const double alpha = Alpha(cuts_[c].edge % BccGrid::kEdgesPerPoint);
      if (cuts_[c].at < alpha) violations.push_back({cuts_[c].at / alpha, Lower(cuts_[c]), c});
      if (1 - cuts_[c].at < alpha) violations.push_back({(1 - cuts_[c].at) / alpha, Upper(cuts_[c]), c});
    }
    std::stable_sort(violations.begin(), violations.end(),
                     [](const Violation& p, const Violation& q) { return p.ratio < q.ratio; });
    warped_to_.assign(sign_.size(), -1);
    for (const Violation& violation : violations) {
      const Cut& cut = cuts_[violation.cut];
      if (sign_[Lower(cut)] == 0 || sign_[Upper(cut)] == 0) continue;
      sign_[violation.point] = 0;
      warped_to_[violation.point] = violation.cut;
    }
  }

  /// The four tetrahedra about the long edge from a centre along `axis`: that edge, and one edge of the shared face
  /// each.
  void FillAround(int v, const Eigen::Vector3i& centre, int axis) {
    const Eigen::Vector3i next = centre + 2 * Eigen::Vector3i::Unit(axis);
    if (!grid_.Contains(next)) return;
    const Eigen::Vector3i middle = centre + Eigen::Vector3i::Unit(axis);
    const Eigen::Vector3i u = Eigen::Vector3i::Unit((axis + 1) % 3);
    const Eigen::Vector3i w = Eigen::Vector3i::Unit((axis + 2) % 3);
    const std::array<Eigen::Vector3i, 4> ring = {middle + u + w, middle - u + w, middle - u - w, middle + u - w};
    const int n = grid_.Index(next);
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector3i& p = ring[k];
      const Eigen::Vector3i& q = ring[(k + 1) % 4];
      if (grid_.Contains(p) && grid_.Contains(q)) Fill({v, n, grid_.Index(p), grid_.Index(q)});
    }
  }

  /// Vertices 0, 1 and 2, 3 of `t` are the ends of its long edges; the volume is positive.
  void Fill(const std::array<int, 4>& t) {
    std::array<int, 4> plus;  // local indices
    std::array<int, 4> minus;
    int plus_count = 0;
    int minus_count = 0;
    for (int i = 0; i < 4; ++i) {
      if (sign_[t[i]] > 0) plus[plus_count++] = i;
      if (sign_[t[i]] < 0) minus[minus_count++] = i;
    }
    if (plus_count == 0) return;
    std::array<int, 4> corners;
    for (int i = 0; i < 4; ++i) corners[i] = sign_[t[i]] < 0 ? -1 : VertexOfPoint(t[i]);
    if (plus_count == 1) {
      for (int i = 0; i < minus_count; ++i) corners[minus[i]] = VertexOfCut(t[plus[0]], t[minus[i]]);
      Emit(corners);
    } else if (minus_count == 0) {
      Emit(corners);
    } else if (plus_count == 3) {
      FillThreeInside(t, minus[0]);
    } else if (minus_count == 1) {
      const int a = plus[0];
      const int b = plus[1];
      const int c = minus[0];
      const int cut_a = VertexOfCut(t[a], t[c]);
      const int cut_b = VertexOfCut(t[b], t[c]);
      const bool from_a = DiagonalFromFirst(t, a, b, c);
      std::array<int, 4> first = corners;
      first[c] = from_a ? cut_b : cut_a;
      Emit(first);
      std::array<int, 4> second = corners;
      second[a] = from_a ? corners[a] : cut_a;
      second[b] = from_a ? cut_b : corners[b];
      second[c] = from_a ? cut_a : cut_b;
      Emit(second);
    } else {
      FillTwoInside(t, plus[0], plus[1], minus[0], minus[1]);
    }
  }

  /// A prism between the inside triangle and its three cut points.
  void FillThreeInside(const std::array<int, 4>& t, int outside) {
    const auto& inside = kOpposite[outside];
    std::array<int, 3> bottom;
    std::array<int, 3> top;
    for (int i = 0; i < 3; ++i) {
      bottom[i] = VertexOfPoint(t[inside[i]]);
      top[i] = VertexOfCut(t[inside[i]], t[outside]);
    }
    EmitPrism(bottom, top, DiagonalFromFirst(t, inside[0], inside[1], outside),
              DiagonalFromFirst(t, inside[0], inside[2], outside), DiagonalFromFirst(t, inside[1], inside[2], outside));
  }

  /// A prism whose triangles are each an inside vertex and its two cut points; one side of it is on the surface.
  void FillTwoInside(const std::array<int, 4>& t, int a, int b, int c, int d) {
    if (!IsEvenPermutation(a, b, c, d)) std::swap(c, d);
    const std::array<int, 3> bottom = {VertexOfPoint(t[a]), VertexOfCut(t[a], t[c]), VertexOfCut(t[a], t[d])};
    const std::array<int, 3> top = {VertexOfPoint(t[b]), VertexOfCut(t[b], t[c]), VertexOfCut(t[b], t[d])};
    const bool from_a_c = DiagonalFromFirst(t, a, b, c);
    const bool from_a_d = DiagonalFromFirst(t, a, b, d);
    bool surface = from_a_d;  // the choice without a cycle, when the other two disagree
    if (from_a_c == from_a_d) {
      // Free: the shorter diagonal.
      const auto length = [&](int i, int j) { return (soup_.vertices[i] - soup_.vertices[j]).squaredNorm(); };
      surface = length(bottom[1], top[2]) <= length(bottom[2], top[1]);
    }
    EmitPrism(bottom, top, from_a_c, from_a_d, surface);
  }

  /// The two tetrahedra at a lattice face with inside vertices a, b and outside vertex c must cut its quadrilateral
  /// alike: true when the diagonal starts at a. Between cuts on a long and a short edge it ends at the cut of the long
  /// one; between two short edges it starts at the vertex of even parity (the parity rule of Labelle & Shewchuk 2007).
  bool DiagonalFromFirst(const std::array<int, 4>& t, int a, int b, int c) const {
    const bool long_a = (a ^ 1) == c;
    const bool long_b = (b ^ 1) == c;
    if (long_a || long_b) return long_b == kDiagonalEndsAtLongCut;
    const Eigen::Vector3i doubled = grid_.Doubled(t[a]);
    return (((doubled.sum() - 3 * (doubled.x() & 1)) / 2) & 1) == 0;
  }

  /// Splits a prism by the diagonals of its sides: `ij` is true when the diagonal runs from bottom[i] to top[j].
  void EmitPrism(const std::array<int, 3>& bottom, const std::array<int, 3>& top, bool d01, bool d02, bool d12) {
    // Rank the three columns by how many diagonals start at their bottom; without a cycle the ranks are 2, 1, 0.
    const std::array<int, 3> starts = {d01 + d02, !d01 + d12, !d02 + !d12};
    std::array<int, 3> column;
    for (int i = 0; i < 3; ++i) column[2 - starts[i]] = i;
    const auto [i, j, k] = column;
    const bool flip = (j - i + 3) % 3 != 1;
    const auto emit = [&](int p, int q, int r, int s) {
      if (flip) std::swap(r, s);
      Emit({p, q, r, s});
    };
    emit(bottom[i], bottom[j], bottom[k], top[k]);
    emit(bottom[i], bottom[j], top[k], top[j]);
    emit(bottom[i], top[i], top[j], top[k]);
  }

  static bool IsEvenPermutation(int a, int b, int c, int d) {
    const int inversions = (a > b) + (a > c) + (a > d) + (b > c) + (b > d) + (c > d);
    return inversions % 2 == 0;
  }

  int VertexOfPoint(int point) {
    int& vertex = point_vertex_[point];
    if (vertex < 0) {
      vertex = static_cast<int>(soup_.vertices.size());
      soup_.vertices.push_back(warped_to_[point] < 0 ? grid_.Point(point) : PointOf(cuts_[warped_to_[point]]));
    }
    return vertex;
  }

  int VertexOfCut(int p, int q) {
    Eigen::Vector3i step = grid_.Doubled(q) - grid_.Doubled(p);
    for (int sign = 0; sign < 2; ++sign, step = -step, std::swap(p, q)) {
      for (int s = 0; s < BccGrid::kEdgesPerPoint; ++s) {
        if (step != Eigen::Map<const Eigen::Vector3i>(BccGrid::kSteps[s].data())) continue;
        const int edge = p * BccGrid::kEdgesPerPoint + s;
        const auto cut = std::lower_bound(cuts_.begin(), cuts_.end(), edge,
                                          [](const Cut& candidate, int wanted) { return candidate.edge < wanted; });
        int& vertex = cut_vertex_[cut - cuts_.begin()];
        if (vertex < 0) {
          vertex = static_cast<int>(soup_.vertices.size());
          soup_.vertices.push_back(PointOf(*cut));
        }
        return vertex;
      }
    }
    return -1;  // not an edge of the lattice: cannot happen for vertices of one tetrahedron
  }

  void Emit(const std::array<int, 4>& tetrahedron) { soup_.tetrahedra.push_back(tetrahedron); }

  /// The face opposite to a vertex, ordered so that (face, vertex) is an even permutation.
  static constexpr int kOpposite[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  static constexpr bool kDiagonalEndsAtLongCut = true;

  const BccGrid& grid_;
  std::vector<std::int8_t> sign_;
  std::vector<Cut> cuts_;          // ascending by edge
  std::vector<int> warped_to_;     // per point: its cut, or -1
  std::vector<int> point_vertex_;  // per point: its vertex, or -1
  std::vector<int> cut_vertex_;    // per cut
  TetrahedronSoup soup_;
};

}  // namespace

TetrahedronSoup Stuff(const BccGrid& grid, LatticeSigns signs) { return Stuffer(grid, std::move(signs)).Run(); }

}  // namespace meshless_cutting
