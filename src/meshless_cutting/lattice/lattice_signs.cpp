#include "lattice/lattice_signs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "lattice/triangle_tree.h"
#include "lattice/winding_number.h"

namespace meshless_cutting {
namespace {

/// A point nearer than this to a triangle is on the surface: it absorbs the rounding of boxes whose planes pass through
/// lattice points. Larger values flatten more detail, smaller ones leave slivers of that thickness to the warp.
constexpr double kOnSurface = 1e-7;  // lattice units
/// Neighbouring triangles overlap by this much, so that no line slips through between them.
constexpr double kOverlap = 1e-9;  // lattice units

struct Crossing {
  int edge;
  double at;
  bool operator<(const Crossing& other) const { return edge != other.edge ? edge < other.edge : at < other.at; }
};

/// Parallel lattice lines seen along their direction: line (i, j) passes through (i + offset, j + offset) of the plane
/// (u, v) and has a point wherever w - offset is a multiple of `pitch`.
struct LineFamily {
  int step;       // BccGrid::kSteps
  double offset;  // 0 or 1/2
  double pitch;   // w between two points of a line, lattice units

  bool is_axis() const { return step < 3; }
  Eigen::Vector3d ToLine(const Eigen::Vector3d& p) const {
    if (is_axis()) return {p[(step + 1) % 3], p[(step + 2) % 3], p[step]};
    const auto& s = BccGrid::kSteps[step];
    return {p.x() - s[0] * p.z(), p.y() - s[1] * p.z(), p.z()};
  }
  /// Doubled coordinates of point k on line (i, j).
  Eigen::Vector3i Point(int i, int j, int k) const {
    Eigen::Vector3i doubled;
    if (is_axis()) {
      const int odd = offset > 0 ? 1 : 0;
      doubled[(step + 1) % 3] = 2 * i + odd;
      doubled[(step + 2) % 3] = 2 * j + odd;
      doubled[step] = 2 * k + odd;
    } else {
      const auto& s = BccGrid::kSteps[step];
      doubled = {2 * i + s[0] * k, 2 * j + s[1] * k, k};
    }
    return doubled;
  }
};

constexpr std::array<LineFamily, 10> kFamilies = {{{0, 0, 1},
                                                   {0, 0.5, 1},
                                                   {1, 0, 1},
                                                   {1, 0.5, 1},
                                                   {2, 0, 1},
                                                   {2, 0.5, 1},
                                                   {3, 0, 0.5},
                                                   {4, 0, 0.5},
                                                   {5, 0, 0.5},
                                                   {6, 0, 0.5}}};

class Classifier {
 public:
  Classifier(const BccGrid& grid, const TriangleMesh& mesh)
      : grid_(grid), mesh_(mesh), tree_(mesh), winding_(tree_), closed_(IsClosed()) {}

  LatticeSigns Run() {
    signs_.sign.assign(grid_.point_count(), -1);
    for (const auto& triangle : mesh_.triangles) {
      for (const LineFamily& family : kFamilies) Cross(triangle, family);
    }
    std::sort(crossings_.begin(), crossings_.end());
    for (int v = 0; v < grid_.point_count(); ++v) {
      if (signs_.sign[v] != 0 && grid_.IsInterior(grid_.Doubled(v)) && IsInside(grid_.Point(v))) signs_.sign[v] = 1;
    }
    FindCuts();
    return std::move(signs_);
  }

 private:
  bool IsInside(const Eigen::Vector3d& p) const { return winding_(p) > 0.5; }

  /// Each directed edge is balanced by its opposite: the winding number is then a whole number everywhere.
  bool IsClosed() const {
    std::map<std::pair<int, int>, int> balance;
    for (const auto& t : mesh_.triangles) {
      for (int k = 0; k < 3; ++k) {
        const int a = t[k];
        const int b = t[(k + 1) % 3];
        balance[std::minmax(a, b)] += a < b ? 1 : -1;
      }
    }
    return std::all_of(balance.begin(), balance.end(), [](const auto& entry) { return entry.second == 0; });
  }

  /// Records where the lines of a family pass through a triangle, and the points that lie on it.
  void Cross(const std::array<int, 3>& triangle, const LineFamily& family) {
    std::array<Eigen::Vector3d, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = family.ToLine(mesh_.vertices[triangle[k]]);
    const Eigen::Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]);
    if (std::abs(normal.z()) <= 1e-9 * normal.norm()) return;  // seen edge-on: its neighbours or other lines find it
    if (normal.z() < 0) std::swap(p[1], p[2]);
    const Eigen::Vector3d low = p[0].cwiseMin(p[1]).cwiseMin(p[2]);
    const Eigen::Vector3d high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    std::array<Eigen::Vector2d, 3> inward;  // unit normals of the sides
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d side = (p[(k + 1) % 3] - p[k]).head<2>();
      inward[k] = Eigen::Vector2d(-side.y(), side.x()).normalized();
    }
    const int i_last = static_cast<int>(std::floor(high.x() + kOverlap - family.offset));
    const int j_last = static_cast<int>(std::floor(high.y() + kOverlap - family.offset));
    const int j_first = static_cast<int>(std::ceil(low.y() - kOverlap - family.offset));
    for (int i = static_cast<int>(std::ceil(low.x() - kOverlap - family.offset)); i <= i_last; ++i) {
      for (int j = j_first; j <= j_last; ++j) {
        const Eigen::Vector2d uv(i + family.offset, j + family.offset);
        bool inside = true;
        for (int k = 0; k < 3; ++k) inside = inside && inward[k].dot(uv - p[k].head<2>()) >= -kOverlap;
        if (!inside) continue;
        const double w = p[0].z() - normal.head<2>().dot(uv - p[0].head<2>()) / normal.z();
        Record(family, i, j, std::clamp(w, low.z(), high.z()));
      }
    }
  }

  void Record(const LineFamily& family, int i, int j, double w) {
    const double along = (w - family.offset) / family.pitch;
    const int k = static_cast<int>(std::floor(along));
    const double at = along - k;
    const Eigen::Vector3i lower = family.Point(i, j, k);
    const Eigen::Vector3i upper = family.Point(i, j, k + 1);
    if (at * family.pitch < kOnSurface && grid_.Contains(lower)) signs_.sign[grid_.Index(lower)] = 0;
    if ((1 - at) * family.pitch < kOnSurface && grid_.Contains(upper)) signs_.sign[grid_.Index(upper)] = 0;
    if (grid_.Contains(lower) && grid_.Contains(upper)) {
      crossings_.push_back({grid_.Index(lower) * BccGrid::kEdgesPerPoint + family.step, at});
    }
  }

  void FindCuts() {
    auto crossing = crossings_.cbegin();
    for (int v = 0; v < grid_.point_count(); ++v) {
      if (signs_.sign[v] == 0) continue;
      const Eigen::Vector3i lower = grid_.Doubled(v);
      for (int step = 0; step < BccGrid::kEdgesPerPoint; ++step) {
        const Eigen::Vector3i upper = lower + Eigen::Map<const Eigen::Vector3i>(BccGrid::kSteps[step].data());
        if (!grid_.Contains(upper) || signs_.sign[v] * signs_.sign[grid_.Index(upper)] >= 0) continue;
        const int edge = v * BccGrid::kEdgesPerPoint + step;
        while (crossing != crossings_.cend() && crossing->edge < edge) ++crossing;
        auto end = crossing;
        while (end != crossings_.cend() && end->edge == edge) ++end;
        signs_.cut_edges.push_back(edge);
        const bool from_inside = signs_.sign[v] > 0;
        signs_.cut_at.push_back(CutOf(0.5 * lower.cast<double>(), 0.5 * upper.cast<double>(), from_inside,
                                      std::vector<Crossing>(crossing, end)));
        crossing = end;
      }
    }
  }

  /// Walks from the inside end to the first change of the indicator.
  double CutOf(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper, bool from_inside,
               std::vector<Crossing> crossings) const {
    if (closed_ && !crossings.empty() && crossings.back().at - crossings.front().at < kOverlap) {
      return crossings.front().at;
    }
    if (!from_inside) {
      std::reverse(crossings.begin(), crossings.end());
      for (Crossing& crossing : crossings) crossing.at = 1 - crossing.at;
    }
    const Eigen::Vector3d start = from_inside ? lower : upper;
    const Eigen::Vector3d direction = from_inside ? Eigen::Vector3d(upper - lower) : Eigen::Vector3d(lower - upper);
    const auto is_inside = [&](double at) { return IsInside(start + at * direction); };
    constexpr double kBeside = 1e-6;  // far enough from a triangle to be on one side of it, near enough to see it alone
    double inside = 0;
    double outside = 1;
    for (const Crossing& crossing : crossings) {
      const double before = crossing.at - kBeside;
      if (before > inside && !is_inside(before)) {
        outside = before;
        break;
      }
      const double after = crossing.at + kBeside;
      if (after >= 1 || !is_inside(after)) return from_inside ? crossing.at : 1 - crossing.at;
      inside = after;
    }
    for (int i = 0; i < 40 && outside - inside > 1e-10; ++i) {
      const double middle = 0.5 * (inside + outside);
      (is_inside(middle) ? inside : outside) = middle;
    }
    const double at = 0.5 * (inside + outside);
    return from_inside ? at : 1 - at;
  }

  const BccGrid& grid_;
  const TriangleMesh& mesh_;
  TriangleTree tree_;
  WindingNumber winding_;
  bool closed_;
  std::vector<Crossing> crossings_;
  LatticeSigns signs_;
};

}  // namespace

LatticeSigns FindSigns(const BccGrid& grid, const TriangleMesh& mesh) { return Classifier(grid, mesh).Run(); }

}  // namespace meshless_cutting
