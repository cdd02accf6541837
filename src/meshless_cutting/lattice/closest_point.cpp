#include "lattice/closest_point.h"

#include <cmath>
#include <limits>

namespace meshless_cutting {
namespace {

void Descend(const TriangleTree& tree, int index, const Eigen::Vector3d& q, double* best_squared, ClosestPoint* best) {
  const TriangleTree::Node& node = tree.nodes()[index];
  if (node.is_leaf()) {
    for (int k = node.first; k < node.last; ++k) {
      const auto [a, b, c] = tree.corners(tree.order()[k]);
      const Eigen::Vector3d p = ClosestPointOnTriangle(a, b, c, q);
      const double squared = (p - q).squaredNorm();
      if (squared >= *best_squared) continue;
      *best_squared = squared;
      best->point = p;
      best->triangle = tree.order()[k];
    }
    return;
  }
  const double left = tree.nodes()[node.left].box.squaredExteriorDistance(q);
  const double right = tree.nodes()[node.right].box.squaredExteriorDistance(q);
  const bool left_first = left <= right;
  if ((left_first ? left : right) < *best_squared) {
    Descend(tree, left_first ? node.left : node.right, q, best_squared, best);
  }
  if ((left_first ? right : left) < *best_squared) {
    Descend(tree, left_first ? node.right : node.left, q, best_squared, best);
  }
}

}  // namespace

Eigen::Vector3d ClosestPointOnTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                                       const Eigen::Vector3d& q) {
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d ac = c - a;
  const Eigen::Vector3d aq = q - a;
  const double d1 = ab.dot(aq);
  const double d2 = ac.dot(aq);
  if (d1 <= 0 && d2 <= 0) return a;
  const Eigen::Vector3d bq = q - b;
  const double d3 = ab.dot(bq);
  const double d4 = ac.dot(bq);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return a + d1 / (d1 - d3) * ab;
  const Eigen::Vector3d cq = q - c;
  const double d5 = ab.dot(cq);
  const double d6 = ac.dot(cq);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6 && d4 - d3 + d5 - d6 > 0) {
    return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  }
  const double sum = va + vb + vc;
  return sum > 0 ? Eigen::Vector3d(a + vb / sum * ab + vc / sum * ac) : a;
}

ClosestPoint FindClosestPoint(const TriangleTree& tree, const Eigen::Vector3d& q) {
  ClosestPoint best;
  double best_squared = std::numeric_limits<double>::infinity();
  Descend(tree, 0, q, &best_squared, &best);
  best.distance = std::sqrt(best_squared);
  return best;
}

}  // namespace meshless_cutting
