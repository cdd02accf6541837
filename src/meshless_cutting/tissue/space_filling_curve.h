// Neighbours in space that are near each other in an array: what is numbered along such a curve stays in the cache, and
// halves of the numbers are halves of the object.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace meshless_cutting {

/// Place on the Z-order curve (G. M. Morton 1966) of the cell with these coordinates, each in [0, 2^20).
inline std::uint64_t MortonCode(const Eigen::Vector3i& cell) {
  std::uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int bit = 0; bit < 20; ++bit) {
      code |= static_cast<std::uint64_t>(cell[axis] >> bit & 1) << (3 * bit + axis);
    }
  }
  return code;
}

}  // namespace meshless_cutting
