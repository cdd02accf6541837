// What the particles of one integration point look like at rest.
#pragma once

#include <Eigen/Core>
#include <array>

#include "tissue/tissue.h"

namespace meshless_cutting {

/// Each shape of support has its own loop over points.
enum class SupportShape {
  kBoxCentre,  // the corners of a box, gradients of the trilinear functions at its centre: a full cell
  kBox,        // the corners of a box, any consistent gradients: a cell that is partly filled or cut
  kGeneral,    // anything else
};
constexpr int kSupportShapes = 3;

/// On the corners of a box any function is a sum of the 8 Hadamard modes H_m(k) = +-1: bit 0 of m and of k is x, bit 1 y,
/// bit 2 z; H_1, H_2, H_4 are linear, H_3, H_5, H_6, H_7 ("hourglass") vanish for every affine map. Consistent gradients
/// are g_k = sum_m c_m H_m(k) with c_0 = 0 and c_1, c_2, c_4 along the axes, so that 3 numbers, and 12 more off the centre, say all.
struct PointSupport {
  SupportShape shape = SupportShape::kGeneral;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  // m, of the rest positions
  double h2 = 0;                // m^2, 4/3 of their mean square distance from it: the square of the edge of a cube
  std::array<int, 8> order{};   // boxes: corner, in the order of its bits -> k
  double box[3] = {};           // boxes: c_1x, c_2y, c_4z, 1/m
  double hourglass[4][3] = {};  // kBox: c_3, c_5, c_6, c_7, 1/m
};

PointSupport DescribeSupport(const Tissue& tissue, int point);

/// The modes that vanish for affine maps, in the order of PointSupport::hourglass.
constexpr int kHourglassModes[4] = {3, 5, 6, 7};

/// H_m(k): +-1.
inline double Hadamard(int mode, int corner) {
  const int unset = mode & ~corner;
  return ((unset ^ unset >> 1 ^ unset >> 2) & 1) ? -1 : 1;
}

}  // namespace meshless_cutting
