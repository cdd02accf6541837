// The regular background grid of the paper: its cells hold the integration points, its nodes are the particles.
#pragma once

#include <Eigen/Core>
#include <array>

namespace meshless_cutting {

/// A box of cells around the object at rest, fitted per axis so that the bounding box is a whole number of cells. Nodes
/// reach `margin` layers beyond the cells for wide supports.
class BackgroundGrid {
 public:
  /// Fits cells of about `cell_size` (m) to [min, max].
  BackgroundGrid(const Eigen::Vector3d& min, const Eigen::Vector3d& max, double cell_size, int margin);

  const Eigen::Vector3d& spacing() const { return spacing_; }  // m, per axis
  const Eigen::Vector3i& cells() const { return cells_; }      // number per axis
  int cell_count() const { return cells_.prod(); }
  int node_count() const { return nodes_.prod(); }

  /// Cell that holds X; points outside belong to the nearest cell.
  int CellAt(const Eigen::Vector3d& X) const;
  Eigen::Vector3i CellCoordinates(int cell) const;
  int CellIndex(const Eigen::Vector3i& c) const { return c[0] + cells_[0] * (c[1] + cells_[1] * c[2]); }
  /// Lower corner of a cell, m.
  Eigen::Vector3d CellCorner(const Eigen::Vector3i& c) const;
  /// Lower bound of cell layer i along an axis, m.
  double PlaneAt(int axis, int i) const { return origin_[axis] + i * spacing_[axis]; }

  /// Node by grid coordinates: node c is the lower corner of cell c; each from -margin to cells + margin.
  int NodeIndex(const Eigen::Vector3i& c) const;
  Eigen::Vector3i first_node() const { return Eigen::Vector3i::Constant(-margin_); }
  Eigen::Vector3i NodeCoordinates(int node) const;
  Eigen::Vector3d NodePosition(int node) const;  // m

 private:
  Eigen::Vector3d origin_, spacing_;
  Eigen::Vector3i cells_, nodes_;
  int margin_;
};

}  // namespace meshless_cutting
