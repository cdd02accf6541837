// The body-centred cubic lattice: corners and centres of cubes, and the edges of its tetrahedra, by integer arithmetic.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace meshless_cutting {

/// Cubes over a bounding box, a whole number per axis. A lattice point has *doubled* coordinates (lattice units times
/// two): all even for a corner of a cube, all odd for a centre. Corners fill the box; centres have one layer more.
/// Each edge belongs to its lower point: 3 long edges (along +x, +y, +z) and 4 short ones (half diagonals upward in z).
class BccGrid {
 public:
  static constexpr int kEdgesPerPoint = 7;
  /// Doubled steps from the lower point of an edge to its upper point; the first three are the long edges.
  static constexpr std::array<std::array<int, 3>, kEdgesPerPoint> kSteps = {
      {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 1, 1}, {-1, 1, 1}, {1, -1, 1}, {-1, -1, 1}}};

  /// `size`: wanted edge of a cube, m; an axis on which the box is flat keeps it.
  BccGrid(const Eigen::AlignedBox3d& box, double size) : box_(box) {
    for (int axis = 0; axis < 3; ++axis) {
      const double length = box.sizes()[axis];
      cubes_[axis] = std::max(1, static_cast<int>(std::lround(length / size)));
      spacing_[axis] = length > 0 ? length / cubes_[axis] : size;
    }
    const Eigen::Vector3i corners = cubes_.array() + 1;
    corner_count_ = corners.prod();
  }

  const Eigen::Vector3i& cubes() const { return cubes_; }
  const Eigen::Vector3d& spacing() const { return spacing_; }  // m
  int point_count() const { return corner_count_ + (cubes_.array() + 2).prod(); }

  bool Contains(const Eigen::Vector3i& doubled) const {
    const int margin = doubled.x() & 1;
    return (doubled.array() >= -margin).all() && (doubled.array() <= 2 * cubes_.array() + margin).all();
  }
  int Index(const Eigen::Vector3i& doubled) const {
    if (doubled.x() & 1) {
      const Eigen::Vector3i i = (doubled.array() + 1) / 2;
      return corner_count_ + (i.x() * (cubes_.y() + 2) + i.y()) * (cubes_.z() + 2) + i.z();
    }
    const Eigen::Vector3i i = doubled / 2;
    return (i.x() * (cubes_.y() + 1) + i.y()) * (cubes_.z() + 1) + i.z();
  }
  Eigen::Vector3i Doubled(int index) const {
    const int margin = index < corner_count_ ? 1 : 2;
    const int rest = index < corner_count_ ? index : index - corner_count_;
    const int ny = cubes_.y() + margin;
    const int nz = cubes_.z() + margin;
    const Eigen::Vector3i i(rest / nz / ny, rest / nz % ny, rest % nz);
    return 2 * i - Eigen::Vector3i::Constant(margin - 1);
  }
  Eigen::Vector3d Point(int index) const { return 0.5 * Doubled(index).cast<double>(); }  // lattice units

  /// Strictly between the planes of the box: only such points can be inside.
  bool IsInterior(const Eigen::Vector3i& doubled) const {
    return (doubled.array() > 0).all() && (doubled.array() < 2 * cubes_.array()).all();
  }

  /// Both maps are exact on the planes of the box.
  Eigen::Vector3d ToLattice(const Eigen::Vector3d& p) const {
    Eigen::Vector3d q;
    for (int axis = 0; axis < 3; ++axis) {
      const double length = box_.sizes()[axis];
      q[axis] = length > 0 ? (p[axis] - box_.min()[axis]) / length * cubes_[axis] : 0;
    }
    return q;
  }
  Eigen::Vector3d ToObject(const Eigen::Vector3d& q) const {
    const Eigen::Array3d u = q.array() / cubes_.cast<double>().array();
    return box_.min().array() * (1 - u) + box_.max().array() * u;
  }

 private:
  Eigen::AlignedBox3d box_;
  Eigen::Vector3i cubes_;
  Eigen::Vector3d spacing_;
  int corner_count_ = 0;
};

}  // namespace meshless_cutting
