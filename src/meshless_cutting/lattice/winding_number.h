// Generalised winding number of a triangle soup (Jacobson et al. 2013), by a tree of dipoles (Barill et al. 2018).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lattice/triangle_tree.h"

namespace meshless_cutting {

/// Solid angle of an oriented triangle seen from `q` over 4 pi: Van Oosterom & Strackee 1983. Positive when q is behind
/// the triangle (inside of a closed, outward oriented surface).
double TriangleWinding(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                       const Eigen::Vector3d& q);

/// How often a mesh winds around a point: 1 inside and 0 outside of a closed, outward oriented surface, in between and
/// smooth where the surface has holes. Near triangles are summed exactly, far clusters by their dipole.
class WindingNumber {
 public:
  /// The tree outlives this.
  explicit WindingNumber(const TriangleTree& tree);

  /// Winding number at `q`; does not allocate.
  double operator()(const Eigen::Vector3d& q) const;

 private:
  struct Dipole {
    Eigen::Vector3d centre;  // area-weighted
    Eigen::Vector3d moment;  // sum of area times normal
    double radius = 0;       // of the cluster about the centre
  };
  double Sum(int node, const Eigen::Vector3d& q) const;

  const TriangleTree* tree_;
  std::vector<Dipole> dipoles_;  // per node
};

}  // namespace meshless_cutting
