// Signed integers of a fixed number of 128-bit words (two's complement): products and sums of known size, exact and
// fast.
#pragma once

#include <array>
#include <cstdint>

namespace meshless_cutting {

__extension__ using Word = unsigned __int128;

/// The caller sees to it that results fit: |x| < 2^(128 words - 1).
template <int words>
struct FixedInteger {
  std::array<Word, words> word{};  // least significant first

  bool IsNegative() const { return (word[words - 1] >> 127) != 0; }
  bool IsZero() const {
    Word any = 0;
    for (const Word x : word) any |= x;
    return any == 0;
  }
  int Sign() const { return IsNegative() ? -1 : IsZero() ? 0 : 1; }
  FixedInteger Magnitude() const { return IsNegative() ? FixedInteger() - *this : *this; }

  /// The 64 bits from bit 64 i on.
  std::uint64_t Limb(int i) const { return static_cast<std::uint64_t>(i % 2 == 0 ? word[i / 2] : word[i / 2] >> 64); }

  /// Rounded, with a relative error below 2^-51: three roundings and the limbs left out.
  double ToDouble() const {
    static_assert(words <= 7, "would overflow");
    const FixedInteger magnitude = Magnitude();
    int i = words - 1;
    while (i > 0 && magnitude.word[i] == 0) --i;
    auto high = static_cast<std::uint64_t>(magnitude.word[i] >> 64),
         low = static_cast<std::uint64_t>(magnitude.word[i]);
    double unit = 1;
    for (int j = 0; j < i; ++j) unit *= 0x1p128;
    if (high == 0 && i > 0) {
      high = low, low = static_cast<std::uint64_t>(magnitude.word[i - 1] >> 64);
      unit *= 0x1p-64;
    }
    const double x = (LimbToDouble(high) * 0x1p64 + LimbToDouble(low)) * unit;
    return IsNegative() ? -x : x;
  }

  friend FixedInteger operator+(const FixedInteger& x, const FixedInteger& y) {
    FixedInteger sum;
    Word carry = 0;
    for (int i = 0; i < words; ++i) {
      const Word s = x.word[i] + y.word[i];
      sum.word[i] = s + carry;
      carry = (s < x.word[i]) | (sum.word[i] < s);
    }
    return sum;
  }

  friend FixedInteger operator-(const FixedInteger& x, const FixedInteger& y) {
    FixedInteger difference;
    Word borrow = 0;
    for (int i = 0; i < words; ++i) {
      const Word d = x.word[i] - y.word[i];
      difference.word[i] = d - borrow;
      borrow = (x.word[i] < y.word[i]) | (d < borrow);
    }
    return difference;
  }

 private:
  /// Halves convert exactly, and faster than 64 bits without sign.
  static double LimbToDouble(std::uint64_t x) {
    return static_cast<double>(static_cast<std::int64_t>(x >> 32)) * 0x1p32 +
           static_cast<double>(static_cast<std::int64_t>(x & 0xffffffff));
  }
};

/// The product of two words without sign: low word first.
inline std::array<Word, 2> MultiplyWords(Word x, Word y) {
  const auto low = [](Word w) { return static_cast<Word>(static_cast<std::uint64_t>(w)); };
  const Word ll = low(x) * low(y), lh = low(x) * (y >> 64), hl = (x >> 64) * low(y), hh = (x >> 64) * (y >> 64);
  const Word middle = (ll >> 64) + low(lh) + low(hl);
  return {low(ll) | (middle << 64), hh + (lh >> 64) + (hl >> 64) + (middle >> 64)};
}

// The full products. A negative factor is read as itself plus 2^(128 words): the surplus comes off the upper words.

inline FixedInteger<2> operator*(const FixedInteger<1>& x, const FixedInteger<1>& y) {
  FixedInteger<2> product{MultiplyWords(x.word[0], y.word[0])};
  if (x.IsNegative()) product.word[1] -= y.word[0];
  if (y.IsNegative()) product.word[1] -= x.word[0];
  return product;
}

inline FixedInteger<3> operator*(const FixedInteger<2>& x, const FixedInteger<1>& y) {
  const std::array<Word, 2> low = MultiplyWords(x.word[0], y.word[0]), high = MultiplyWords(x.word[1], y.word[0]);
  const Word middle = low[1] + high[0];
  FixedInteger<3> product{{low[0], middle, high[1] + (middle < low[1])}};
  if (x.IsNegative()) product.word[2] -= y.word[0];
  if (y.IsNegative()) product = product - FixedInteger<3>{{0, x.word[0], x.word[1]}};
  return product;
}

}  // namespace meshless_cutting
