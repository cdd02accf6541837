// The point of a triangle mesh that is nearest to a given one.
#pragma once

#include <Eigen/Core>

#include "lattice/triangle_tree.h"

namespace meshless_cutting {

struct ClosestPoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  int triangle = -1;
  double distance = 0;
};

/// Nearest point to `q` on triangle abc (Ericson 2005, section 5.1.5).
Eigen::Vector3d ClosestPointOnTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                                       const Eigen::Vector3d& q);

/// Nearest point to `q` on the mesh of a tree that has at least one triangle. Does not allocate.
ClosestPoint FindClosestPoint(const TriangleTree& tree, const Eigen::Vector3d& q);

}  // namespace meshless_cutting
