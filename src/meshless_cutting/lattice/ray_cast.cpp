#include "lattice/ray_cast.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace meshless_cutting {
namespace {

/// Distance along the ray at which it passes through the triangle, or infinity (Moeller & Trumbore 1997).
double Intersect(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& origin,
                 const Eigen::Vector3d& direction) {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  constexpr double kOverlap = 1e-9;  // in barycentric coordinates
  const Eigen::Vector3d e1 = corners[1] - corners[0];
  const Eigen::Vector3d e2 = corners[2] - corners[0];
  const Eigen::Vector3d p = direction.cross(e2);
  const double determinant = e1.dot(p);
  if (determinant == 0) return kMiss;
  const Eigen::Vector3d s = origin - corners[0];
  const double u = s.dot(p) / determinant;
  if (!(u >= -kOverlap && u <= 1 + kOverlap)) return kMiss;
  const Eigen::Vector3d q = s.cross(e1);
  const double v = direction.dot(q) / determinant;
  if (!(v >= -kOverlap && u + v <= 1 + kOverlap)) return kMiss;
  const double at = e2.dot(q) / determinant;
  return at > 0 ? at : kMiss;
}

/// Whether the ray, from `nearest` on, passes through a box. The box is padded: a ray along its side is not lost to
/// rounding.
bool Meets(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
           double nearest) {
  const double pad = 1e-12 * std::max({box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff(),
                                       origin.cwiseAbs().maxCoeff()});
  double first = nearest;
  double last = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min()[axis] - pad - origin[axis];
    const double high = box.max()[axis] + pad - origin[axis];
    if (direction[axis] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const double a = low / direction[axis];
    const double b = high / direction[axis];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first <= last;
}

void Descend(const TriangleTree& tree, int index, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
             bool any, RayHit* best) {
  const TriangleTree::Node& node = tree.nodes()[index];
  if ((any && best->triangle >= 0) || !Meets(node.box, origin, direction, best->at)) return;
  if (!node.is_leaf()) {
    Descend(tree, node.left, origin, direction, any, best);
    Descend(tree, node.right, origin, direction, any, best);
    return;
  }
  for (int k = node.first; k < node.last; ++k) {
    const double at = Intersect(tree.corners(tree.order()[k]), origin, direction);
    if (std::isfinite(at) && at > best->at) *best = {tree.order()[k], at};
  }
}

RayHit Cast(const TriangleTree& tree, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, bool any) {
  RayHit best;
  if (!tree.nodes().empty()) Descend(tree, 0, origin, direction, any, &best);
  return best;
}

}  // namespace

RayHit FindFarthestHit(const TriangleTree& tree, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  return Cast(tree, origin, direction, false);
}

bool Escapes(const TriangleTree& tree, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  return Cast(tree, origin, direction, true).triangle < 0;
}

}  // namespace meshless_cutting
