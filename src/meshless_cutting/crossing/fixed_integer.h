// Signed integers of a fixed number of 64-bit limbs (two's complement): products and sums of known size, exact and fast.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace meshless_cutting {

__extension__ using UnsignedWide = unsigned __int128;

/// The caller sees to it that results fit: |x| < 2^(64 limbs - 1).
template <int limbs>
struct FixedInteger {
  std::array<std::uint64_t, limbs> limb{};  // least significant first

  bool IsNegative() const { return static_cast<std::int64_t>(limb[limbs - 1]) < 0; }
  bool IsZero() const {
    std::uint64_t any = 0;
    for (const std::uint64_t x : limb) any |= x;
    return any == 0;
  }
  int Sign() const { return IsNegative() ? -1 : IsZero() ? 0 : 1; }

  FixedInteger Magnitude() const { return IsNegative() ? FixedInteger() - *this : *this; }

  /// Rounded, with a relative error below 2^-51: three roundings and the limbs left out.
  double ToDouble() const {
    static_assert(limbs <= 15, "would overflow");
    const FixedInteger magnitude = Magnitude();
    int i = limbs - 1;
    double unit = 1;
    while (i > 0 && magnitude.limb[i] == 0) --i;
    double x = static_cast<double>(magnitude.limb[i]);
    if (i > 0) x = x * 0x1p64 + static_cast<double>(magnitude.limb[i - 1]);
    for (int j = 1; j < i; ++j) unit *= 0x1p64;
    return IsNegative() ? -x * unit : x * unit;
  }

  friend FixedInteger operator+(const FixedInteger& x, const FixedInteger& y) {
    FixedInteger sum;
    std::uint64_t carry = 0;
    for (int i = 0; i < limbs; ++i) {
      const UnsignedWide s = static_cast<UnsignedWide>(x.limb[i]) + y.limb[i] + carry;
      sum.limb[i] = static_cast<std::uint64_t>(s);
      carry = static_cast<std::uint64_t>(s >> 64);
    }
    return sum;
  }

  friend FixedInteger operator-(const FixedInteger& x, const FixedInteger& y) {
    FixedInteger difference;
    std::uint64_t borrow = 0;
    for (int i = 0; i < limbs; ++i) {
      const UnsignedWide d = static_cast<UnsignedWide>(x.limb[i]) - y.limb[i] - borrow;
      difference.limb[i] = static_cast<std::uint64_t>(d);
      borrow = static_cast<std::uint64_t>(d >> 64) & 1;
    }
    return difference;
  }
};

/// The full product.
template <int n, int m>
FixedInteger<n + m> operator*(const FixedInteger<n>& x, const FixedInteger<m>& y) {
  FixedInteger<n + m> product;
  for (int i = 0; i < n; ++i) {
    std::uint64_t carry = 0;
    for (int j = 0; j < m; ++j) {
      const UnsignedWide sum = static_cast<UnsignedWide>(x.limb[i]) * y.limb[j] + product.limb[i + j] + carry;
      product.limb[i + j] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64);
    }
    product.limb[i + m] = carry;
  }
  // A negative factor was read as itself plus 2^(64 n), or 2^(64 m): take the surplus off the upper limbs.
  const auto take_off = [&product](const auto& factor, int from, int count, bool negative) {
    const std::uint64_t mask = negative ? ~std::uint64_t{0} : 0;
    std::uint64_t borrow = 0;
    for (int i = 0; i < count; ++i) {
      const UnsignedWide d = static_cast<UnsignedWide>(product.limb[from + i]) - (factor.limb[i] & mask) - borrow;
      product.limb[from + i] = static_cast<std::uint64_t>(d);
      borrow = static_cast<std::uint64_t>(d >> 64) & 1;
    }
  };
  take_off(y, n, m, x.IsNegative());
  take_off(x, m, n, y.IsNegative());
  return product;
}

}  // namespace meshless_cutting
