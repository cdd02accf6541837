#include "crossing/integer_coordinates.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace meshless_cutting {

IntegerCoordinates::IntegerCoordinates(const MovingSegment& a, const MovingSegment& b) {
  const std::array<const Eigen::Vector3d*, 8> points = {&a.p_t0, &a.q_t0, &b.p_t0, &b.q_t0,
                                                        &a.p_t1, &a.q_t1, &b.p_t1, &b.q_t1};
  // IEEE double: x = +-magnitude * 2^(exponent - 1075), with a leading bit that is not stored unless the exponent is 0.
  constexpr int kFractionBits = 52;
  constexpr std::uint64_t kLeadingBit = std::uint64_t{1} << kFractionBits;
  int lowest = 1 << 12, highest = 0;
  for (int i = 0; i < 24; ++i) {
    std::uint64_t x;
    std::memcpy(&x, &(*points[i / 3])[i % 3], sizeof x);
    const int exponent = static_cast<int>((x >> kFractionBits) & 0x7ff);
    const std::uint64_t magnitude = (x & (kLeadingBit - 1)) | (exponent != 0 ? kLeadingBit : 0);
    mantissa[i] = 0;
    shift[i] = 0;
    if (magnitude == 0) continue;
    const int zeros = __builtin_ctzll(magnitude);  // short numbers make short products
    mantissa[i] = static_cast<std::int64_t>(magnitude >> zeros);
    shift[i] = std::max(exponent, 1) + zeros;
    lowest = std::min(lowest, shift[i]);
    highest = std::max(highest, std::max(exponent, 1) + 64 - __builtin_clzll(magnitude));
    if ((x >> 63) != 0) mantissa[i] = -mantissa[i];
  }
  bits = std::max(highest - lowest, 0);
  for (int i = 0; i < 24; ++i) {
    if (mantissa[i] != 0) shift[i] -= lowest;
  }
}

}  // namespace meshless_cutting
