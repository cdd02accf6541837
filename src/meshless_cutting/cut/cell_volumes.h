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
  double volume = 0;                                 // m^3, signed
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // volume times centroid, m^4
};

/// Adds the parts of the tetrahedron x (m, object frame; volume signed by its orientation) to `parts`, merging with
/// those that are there. Exact to rounding.
void AddCellVolumes(const BackgroundGrid& grid, const std::array<Eigen::Vector3d, 4>& x,
                    std::vector<CellVolume>& parts);

/// Parts of a cell below this share of its volume are rounding at cell faces.
inline constexpr double kSliverShare = 1e-9;

/// Moves the parts for which `drop(part)` holds to the largest other part: nothing is lost.
template <typename Drop>
void MergeParts(std::vector<CellVolume>& parts, const Drop& drop) {
  size_t largest = 0;
  for (size_t i = 1; i < parts.size(); ++i)
    if (parts[i].volume > parts[largest].volume) largest = i;
  size_t kept = 0;
  CellVolume all = parts[largest];
  for (size_t i = 0; i < parts.size(); ++i) {
    if (i == largest) continue;
    if (drop(parts[i])) {
      all.volume += parts[i].volume;
      all.moment += parts[i].moment;
    } else {
      parts[kept++] = parts[i];
    }
  }
  parts.resize(kept);
  parts.push_back(all);
}

}  // namespace meshless_cutting
