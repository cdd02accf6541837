#include "tissue/background_grid.h"

#include <algorithm>
#include <cmath>

namespace meshless_cutting {

BackgroundGrid::BackgroundGrid(const Eigen::Vector3d& min, const Eigen::Vector3d& max, double cell_size, int margin)
    : origin_(min), margin_(margin) {
  for (int axis = 0; axis < 3; ++axis) {
    const double length = max[axis] - min[axis];
    cells_[axis] = std::max(1, static_cast<int>(std::lround(length / cell_size)));
    spacing_[axis] = length / cells_[axis];
  }
  nodes_ = cells_.array() + 1 + 2 * margin;
}

int BackgroundGrid::CellAt(const Eigen::Vector3d& X) const {
  Eigen::Vector3i c;
  for (int axis = 0; axis < 3; ++axis)
    c[axis] = std::clamp(static_cast<int>(std::floor((X[axis] - origin_[axis]) / spacing_[axis])), 0, cells_[axis] - 1);
  return CellIndex(c);
}

Eigen::Vector3i BackgroundGrid::CellCoordinates(int cell) const {
  return {cell % cells_[0], cell / cells_[0] % cells_[1], cell / (cells_[0] * cells_[1])};
}

Eigen::Vector3d BackgroundGrid::CellCorner(const Eigen::Vector3i& c) const {
  return {PlaneAt(0, c[0]), PlaneAt(1, c[1]), PlaneAt(2, c[2])};
}

int BackgroundGrid::NodeIndex(const Eigen::Vector3i& c) const {
  return (c[0] + margin_) + nodes_[0] * ((c[1] + margin_) + nodes_[1] * (c[2] + margin_));
}

Eigen::Vector3i BackgroundGrid::NodeCoordinates(int node) const {
  return Eigen::Vector3i(node % nodes_[0], node / nodes_[0] % nodes_[1], node / (nodes_[0] * nodes_[1])).array() -
         margin_;
}

Eigen::Vector3d BackgroundGrid::NodePosition(int node) const { return CellCorner(NodeCoordinates(node)); }

}  // namespace meshless_cutting
