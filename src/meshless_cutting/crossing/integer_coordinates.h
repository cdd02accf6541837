// The coordinates of two moving segments as integers: exact, up to one common power of two.
#pragma once

#include <array>
#include <cstdint>

#include "crossing/edge_edge.h"

namespace meshless_cutting {

/// Coordinate i is mantissa[i] * 2^shift[i], over a common power of two. Order: A0, A1, B0, B1 at t = 0, then at t = 1;
/// xyz.
struct IntegerCoordinates {
  std::array<std::int64_t, 24> mantissa;
  std::array<int, 24> shift;  // >= 0; 0 for a zero
  int bits = 0;               // all are below 2^bits

  IntegerCoordinates(const MovingSegment& a, const MovingSegment& b);
};

}  // namespace meshless_cutting
