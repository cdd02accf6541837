#include "lattice/surface_orientation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "lattice/ray_cast.h"
#include "lattice/triangle_tree.h"
#include "lattice/weld.h"

namespace meshless_cutting {
namespace {

/// Rays per patch and side, in proportion to the area of the patch within these bounds.
constexpr int kFewestRays = 16;
constexpr int kMostRays = 2048;
/// A patch with fewer rays that get away, as a share, is hidden: the odd ray through a crack must not turn a cavity.
constexpr double kHidden = 0.005;
/// A hidden patch is a sheet when its mean normal is longer than this: 0 for a shell, 1/2 for a half sphere, 1 if flat.
constexpr double kSheet = 0.25;
/// Share of a patch's area, counted +1 and -1, that must agree in direction for the input to have meant it.
constexpr double kCoherent = 0.9;

struct Patch {
  std::vector<int> triangles;
  double area = 0;
  double agreement = 0;  // +1: as in the input, -1: the input has it the other way, 0: the input is undecided
  double flatness = 0;   // length of the mean normal
  double volume = 0;     // signed, of the cone over the patch from its centre
  int front = 0;         // rays that get away
  int back = 0;
  int rays = 0;  // per side
  enum class Fate { kKeep, kFlip, kDrop } fate = Fate::kKeep;
  bool is_hidden() const { return front + back <= kHidden * 2 * rays; }
};

/// Point `index` of a sequence that fills the unit cube evenly: multiples of 1/g, 1/g^2, 1/g^3 modulo 1 where g^4 = g
/// + 1.
Eigen::Vector3d EvenPoint(int index) {
  const Eigen::Vector3d step(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  const Eigen::Vector3d x = Eigen::Vector3d::Constant(0.5) + (index + 1) * step;
  return x - x.array().floor().matrix();
}

class Orienter {
 public:
  explicit Orienter(const TriangleMesh& mesh) : mesh_(WeldEqualVertices(mesh)) {
    double size = 0;
    for (const Eigen::Vector3d& p : mesh_.vertices) size = std::max(size, p.cwiseAbs().maxCoeff());
    offset_ = 1e-9 * size;
  }

  TriangleMesh Run() {
    DropEqualTriangles();
    FindPatches();
    const TriangleTree tree(mesh_);
    for (Patch& patch : patches_) Look(tree, &patch);
    for (Patch& patch : patches_) {
      if (!patch.is_hidden()) patch.fate = FateOfVisible(patch);
    }
    for (Patch& patch : patches_) {
      if (patch.is_hidden()) patch.fate = FateOfHidden(tree, patch);
    }
    std::vector<std::array<int, 3>> kept;
    for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const Patch::Fate fate = patches_[patch_of_[i]].fate;
      if (fate == Patch::Fate::kDrop) continue;
      kept.push_back(mesh_.triangles[i]);
      if (fate == Patch::Fate::kFlip) std::swap(kept.back()[1], kept.back()[2]);
    }
    mesh_.triangles = std::move(kept);
    return WeldEqualVertices(mesh_);  // drops what no triangle uses any more
  }

 private:
  /// Half of the normal times the area.
  Eigen::Vector3d Moment(int triangle) const {
    const auto& t = mesh_.triangles[triangle];
    const Eigen::Vector3d& a = mesh_.vertices[t[0]];
    return 0.5 * (mesh_.vertices[t[1]] - a).cross(mesh_.vertices[t[2]] - a);
  }

  void DropEqualTriangles() {
    std::map<std::array<int, 3>, int> first_of;
    std::vector<std::array<int, 3>> kept;
    for (const auto& triangle : mesh_.triangles) {
      std::array<int, 3> rotated = triangle;
      std::rotate(rotated.begin(), std::min_element(rotated.begin(), rotated.end()), rotated.end());
      const int direction = rotated[1] < rotated[2] ? 1 : -1;
      std::sort(rotated.begin(), rotated.end());
      const auto [found, is_new] = first_of.insert({rotated, static_cast<int>(kept.size())});
      if (is_new) {
        kept.push_back(triangle);
        direction_.push_back(direction);
        votes_.push_back(0);
      }
      // Equal triangles in both directions: the input does not say which.
      votes_[found->second] += direction * direction_[found->second];
    }
    mesh_.triangles = std::move(kept);
  }

  void FindPatches() {
    const int count = static_cast<int>(mesh_.triangles.size());
    // (lower vertex, higher vertex) of each side, with triangle and whether it runs upward.
    struct Side {
      std::array<int, 2> ends;
      int triangle;
      bool upward;
    };
    std::vector<Side> sides;
    sides.reserve(3 * mesh_.triangles.size());
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k < 3; ++k) {
        const int a = mesh_.triangles[i][k];
        const int b = mesh_.triangles[i][(k + 1) % 3];
        sides.push_back({{std::min(a, b), std::max(a, b)}, i, a < b});
      }
    }
    std::stable_sort(sides.begin(), sides.end(), [](const Side& p, const Side& q) { return p.ends < q.ends; });
    std::vector<std::vector<std::pair<int, bool>>> neighbours(count);  // triangle, turned the same way
    for (size_t i = 0; i < sides.size();) {
      size_t end = i + 1;
      while (end < sides.size() && sides[end].ends == sides[i].ends) ++end;
      if (end - i == 2) {
        const bool same = sides[i].upward != sides[i + 1].upward;
        neighbours[sides[i].triangle].push_back({sides[i + 1].triangle, same});
        neighbours[sides[i + 1].triangle].push_back({sides[i].triangle, same});
      }
      i = end;
    }
    patch_of_.assign(count, -1);
    turned_.assign(count, false);
    for (int seed = 0; seed < count; ++seed) {
      if (patch_of_[seed] >= 0) continue;
      const int index = static_cast<int>(patches_.size());
      patches_.emplace_back();
      Patch& patch = patches_.back();
      patch.triangles.push_back(seed);
      patch_of_[seed] = index;
      for (size_t i = 0; i < patch.triangles.size(); ++i) {
        const int t = patch.triangles[i];
        for (const auto& [next, same] : neighbours[t]) {
          if (patch_of_[next] >= 0) continue;  // around a Moebius strip the first turn stands
          patch_of_[next] = index;
          turned_[next] = same ? turned_[t] : !turned_[t];
          patch.triangles.push_back(next);
        }
      }
      Finish(&patch);
    }
  }

  /// Applies the turns found to the triangles of a patch and measures it.
  void Finish(Patch* patch) {
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const int t : patch->triangles) {
      if (turned_[t]) std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
      const Eigen::Vector3d m = Moment(t);
      patch->area += m.norm();
      patch->agreement += m.norm() * (turned_[t] ? -1 : 1) * ((votes_[t] > 0) - (votes_[t] < 0));
      moment += m;
      centre += m.norm() * mesh_.vertices[mesh_.triangles[t][0]];
    }
    if (patch->area > 0) {
      patch->agreement /= patch->area;
      patch->flatness = moment.norm() / patch->area;
      centre /= patch->area;
    }
    for (const int t : patch->triangles) {
      patch->volume += Moment(t).dot(mesh_.vertices[mesh_.triangles[t][0]] - centre) / 3;
    }
    total_area_ += patch->area;
  }

  /// Calls `visit(origin, direction)` with rays from both sides of points spread evenly over the patch, front first.
  template <typename Visit>
  void CastRays(const Patch& patch, const Visit& visit) const {
    double below = 0;  // area of the triangles before the current one
    size_t i = 0;
    const int rays = RaysOf(patch);
    for (int r = 0; r < rays; ++r) {
      const double target = patch.area * (r + 0.5) / rays;
      while (i + 1 < patch.triangles.size() && below + Moment(patch.triangles[i]).norm() < target) {
        below += Moment(patch.triangles[i++]).norm();
      }
      const auto& t = mesh_.triangles[patch.triangles[i]];
      const Eigen::Vector3d normal = Moment(patch.triangles[i]).normalized();
      const Eigen::Vector3d random = EvenPoint(r);
      const double u = 1 - std::sqrt(random.x());
      const double v = (1 - u) * random.y();
      const Eigen::Vector3d& a = mesh_.vertices[t[0]];
      const Eigen::Vector3d p = a + u * (mesh_.vertices[t[1]] - a) + v * (mesh_.vertices[t[2]] - a);
      // A direction on the sphere about the normal's tip: cosine-weighted over the half space.
      const Eigen::Vector3d other = EvenPoint(r + 7919);
      const double z = 2 * random.z() - 1;
      const double angle = 2 * 3.14159265358979323846 * other.x();
      const double radius = std::sqrt(std::max(0.0, 1 - z * z));
      const Eigen::Vector3d direction =
          normal + 0.999 * Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), z);
      visit(Eigen::Vector3d(p + offset_ * normal), direction, true);
      visit(Eigen::Vector3d(p - offset_ * normal), Eigen::Vector3d(-direction), false);
    }
  }

  int RaysOf(const Patch& patch) const {
    if (!(patch.area > 0)) return 0;
    return std::clamp(static_cast<int>(kMostRays * patch.area / total_area_), kFewestRays, kMostRays);
  }

  void Look(const TriangleTree& tree, Patch* patch) const {
    patch->rays = RaysOf(*patch);
    CastRays(*patch, [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, bool is_front) {
      if (Escapes(tree, origin, direction)) ++(is_front ? patch->front : patch->back);
    });
  }

  static Patch::Fate FateOfVisible(const Patch& patch) {
    if (patch.front != patch.back) return patch.front > patch.back ? Patch::Fate::kKeep : Patch::Fate::kFlip;
    return patch.agreement >= 0 ? Patch::Fate::kKeep : Patch::Fate::kFlip;
  }

  Patch::Fate FateOfHidden(const TriangleTree& tree, const Patch& patch) const {
    if (!(patch.area > 0) || patch.flatness > kSheet) return Patch::Fate::kDrop;
    if (std::abs(patch.agreement) < kCoherent) return patch.volume >= 0 ? Patch::Fate::kKeep : Patch::Fate::kFlip;
    // Were the visible patches around this one turned against the input? Then it turns with them.
    double around = 0;
    CastRays(patch, [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, bool) {
      const RayHit hit = FindFarthestHit(tree, origin, direction);
      if (hit.triangle < 0) return;
      const Patch& seen = patches_[patch_of_[hit.triangle]];
      if (!seen.is_hidden()) around += seen.fate == Patch::Fate::kFlip ? -seen.agreement : seen.agreement;
    });
    const bool as_input = around >= 0;
    return (patch.agreement > 0) == as_input ? Patch::Fate::kKeep : Patch::Fate::kFlip;
  }

  TriangleMesh mesh_;
  std::vector<int> direction_;  // per triangle: +1 when its vertices ascend around it
  std::vector<int> votes_;      // per triangle: equal triangles in its direction minus those against it
  std::vector<bool> turned_;    // per triangle, against the input
  std::vector<int> patch_of_;
  std::vector<Patch> patches_;
  double total_area_ = 0;
  double offset_ = 0;  // rays start this far from their triangle, so that rounding does not let them hit it
};

}  // namespace

TriangleMesh OrientOutward(const TriangleMesh& mesh) { return Orienter(mesh).Run(); }

}  // namespace meshless_cutting
