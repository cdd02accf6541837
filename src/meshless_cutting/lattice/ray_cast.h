// Rays against a triangle mesh.
#pragma once

#include <Eigen/Core>

#include "lattice/triangle_tree.h"

namespace meshless_cutting {

struct RayHit {
  int triangle = -1;  // -1: nothing hit
  double at = 0;      // multiples of the direction
};

/// Farthest hit of the ray origin + at * direction, at > 0: what is seen first when looking back from infinity. Sides
/// of triangles belong to both neighbours, so that no ray slips through between them. Does not allocate.
RayHit FindFarthestHit(const TriangleTree& tree, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

/// Whether the ray leaves the mesh behind. Does not allocate.
bool Escapes(const TriangleTree& tree, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

}  // namespace meshless_cutting
