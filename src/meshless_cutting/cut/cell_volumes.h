// How much of a tetrahedron lies in which cell of the background grid.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "tissue/background_grid.h"

namespace meshless_cutting {

/// Part of a body in one cell.
struct CellVolume {
  int cell = -1;
  double volume = 0;                                  // m^3, signed
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // volume times centroid, m^4
};

/// Adds the parts of the tetrahedron x (m, object frame; volume signed by its orientation) to `parts`, merging with those that
/// are there. Exact to rounding.
void AddCellVolumes(const BackgroundGrid& grid, const std::array<Eigen::Vector3d, 4>& x, std::vector<CellVolume>& parts);

/// Moves parts below a share of 1e-9 of a cell (rounding at cell faces) to the largest part: nothing is lost, no sliver remains.
/// The bound is absolute, so the parts of a part never reach a cell that the whole did not.
void MergeSlivers(const BackgroundGrid& grid, std::vector<CellVolume>& parts);

}  // namespace meshless_cutting
