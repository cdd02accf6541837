#include "cut/cell_volumes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace meshless_cutting {
namespace {

using Tetrahedron = std::array<Eigen::Vector3d, 4>;

// Vertices closer to a cell face than this share of a cell count as on it.
constexpr double kOnPlane = 1e-9;

double SignedVolume(const Tetrahedron& x) { return (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]) / 6; }

/// Splits along the axis at all planes between cell layers, then goes on with the next axis.
void Split(const BackgroundGrid& grid, const Tetrahedron& x, int axis, Eigen::Vector3i& cell, double sign,
           std::vector<CellVolume>& parts) {
  if (axis == 3) {
    const double volume = sign * std::abs(SignedVolume(x));
    const int index = grid.CellIndex(cell);
    auto part = std::find_if(parts.begin(), parts.end(), [&](const CellVolume& p) { return p.cell == index; });
    if (part == parts.end()) part = parts.insert(parts.end(), CellVolume{index});
    part->volume += volume;
    part->moment += volume * 0.25 * (x[0] + x[1] + x[2] + x[3]);
    return;
  }
  const double tolerance = kOnPlane * grid.spacing()[axis], origin = grid.PlaneAt(axis, 0), h = grid.spacing()[axis];
  double low = x[0][axis], high = low;
  for (int i = 1; i < 4; ++i) {
    low = std::min(low, x[i][axis]);
    high = std::max(high, x[i][axis]);
  }
  const int last = grid.cells()[axis] - 1;
  const int from = std::clamp(static_cast<int>(std::floor((low + tolerance - origin) / h)), 0, last);
  const int to = std::clamp(static_cast<int>(std::floor((high - tolerance - origin) / h)), from, last);
  cell[axis] = from;
  if (from == to) {
    Split(grid, x, axis + 1, cell, sign, parts);
    return;
  }

  // Below the first plane go on to the next axis; above it split again.
  const double plane = grid.PlaneAt(axis, from + 1);
  std::array<int, 4> order = {0, 1, 2, 3};  // by height
  std::sort(order.begin(), order.end(), [&](int a, int b) { return x[a][axis] < x[b][axis]; });
  int below = 0;
  while (below < 4 && x[order[below]][axis] < plane) ++below;
  auto p = [&](int i) { return x[order[i]]; };
  auto on = [&](int i, int j) {
    const double t = (plane - p(i)[axis]) / (p(j)[axis] - p(i)[axis]);
    Eigen::Vector3d q = (1 - t) * p(i) + t * p(j);
    q[axis] = plane;
    return q;
  };
  auto lower = [&](const Tetrahedron& part) {
    cell[axis] = from;
    Split(grid, part, axis + 1, cell, sign, parts);
  };
  auto upper = [&](const Tetrahedron& part) { Split(grid, part, axis, cell, sign, parts); };
  // A prism between triangles a and b, as three tetrahedra.
  auto prism = [](auto emit, const Eigen::Vector3d& a0, const Eigen::Vector3d& a1, const Eigen::Vector3d& a2,
                  const Eigen::Vector3d& b0, const Eigen::Vector3d& b1, const Eigen::Vector3d& b2) {
    emit(Tetrahedron{a0, a1, a2, b0});
    emit(Tetrahedron{a1, a2, b0, b1});
    emit(Tetrahedron{a2, b0, b1, b2});
  };
  if (below == 1) {
    const Eigen::Vector3d a = on(0, 1), b = on(0, 2), c = on(0, 3);
    lower({p(0), a, b, c});
    prism(upper, a, b, c, p(1), p(2), p(3));
  } else if (below == 3) {
    const Eigen::Vector3d a = on(0, 3), b = on(1, 3), c = on(2, 3);
    upper({p(3), a, b, c});
    prism(lower, a, b, c, p(0), p(1), p(2));
  } else {
    const Eigen::Vector3d a = on(0, 2), b = on(0, 3), c = on(1, 2), d = on(1, 3);
    prism(lower, p(0), a, b, p(1), c, d);
    prism(upper, p(2), a, c, p(3), b, d);
  }
}

}  // namespace

void AddCellVolumes(const BackgroundGrid& grid, const Tetrahedron& x, std::vector<CellVolume>& parts) {
  Eigen::Vector3i cell;
  Split(grid, x, 0, cell, SignedVolume(x) < 0 ? -1 : 1, parts);
}

}  // namespace meshless_cutting
