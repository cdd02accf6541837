// Moving least squares with a linear basis over the nodes around a cell of the background grid.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tissue/background_grid.h"

namespace meshless_cutting {

/// MLS shape functions of the particles in the support of a cell: the nodes within `radius` cells of its centre.
///
/// The window of a particle is a product of hat functions, wide enough to cover the support from anywhere in the cell.
/// With the eight corners (radius 0.9) the hats alone reproduce linear fields, so MLS *is* trilinear interpolation
/// there: continuous from cell to cell. The window is evaluated inside the cell, a small margin off its faces, while
/// the linear basis takes the true point: outside the cell the field goes on linearly and the moment matrix stays
/// regular.
class ShapeFunctions {
 public:
  /// Layers of nodes beyond the cell's own corners that a support of `radius` cells needs in the grid.
  static int Margin(double radius);

  ShapeFunctions(const BackgroundGrid& grid, double radius);

  const BackgroundGrid& grid() const { return *grid_; }
  int support_size() const { return static_cast<int>(offsets_.size()); }
  /// Node of entry k relative to the lower corner of the cell.
  const Eigen::Vector3i& offset(int k) const { return offsets_[k]; }

  /// phi_k(X), support_size() values; sum 1, reproduces linear fields.
  void Values(int cell, const Eigen::Vector3d& X, double* phi) const;
  /// dphi_k/dX at X moved into the cell, support_size() vectors, 1/m.
  void Gradients(int cell, const Eigen::Vector3d& X, Eigen::Vector3d* gradients) const;
  /// phi_k at the centre of a cell, the same for all cells: how mass is lumped.
  const std::vector<double>& centre_values() const { return centre_; }

 private:
  Eigen::Vector3d Local(int cell, const Eigen::Vector3d& X) const;  // cell = [0, 1]^3

  const BackgroundGrid* grid_;
  double hat_;  // half width of the window, cells
  std::vector<Eigen::Vector3i> offsets_;
  std::vector<double> centre_;
};

}  // namespace meshless_cutting
