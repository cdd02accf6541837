#include "crossing/exact_form.h"

#include <algorithm>
#include <cmath>

namespace meshless_cutting::exact {
namespace {

/// Coefficients over a common power of two; each has a relative error below 2^-51, or has underflowed below 2^-1000 of
/// the largest one.
std::array<double, 4> ToDoubles(const Form& f) {
  std::array<double, 4> c{};
  if (f.FitsDoubles()) {
    for (int i = 0; i <= f.degree; ++i) {
      const Scaled x = ToScaled(f.c[i]);
      c[i] = x.factor;
      for (int e = x.exponent; e > 0; e -= 64) c[i] *= 0x1p64;
    }
    return c;
  }
  std::array<Scaled, 4> scaled{};
  int top = 0;
  for (int i = 0; i <= f.degree; ++i) {
    scaled[i] = ToScaled(f.c[i]);
    top = std::max(top, scaled[i].exponent);
  }
  for (int i = 0; i <= f.degree; ++i) c[i] = std::ldexp(scaled[i].factor, scaled[i].exponent - top);
  return c;
}

double Largest(double x, double y) { return std::max(std::abs(x), std::abs(y)); }

}  // namespace

Scaled ToScaled(const Integer& x) {
  const auto& backend = x.backend();
  const auto* limbs = backend.limbs();
  static_assert(sizeof(*limbs) == 8, "limbs of 64 bits are expected");
  const int last = static_cast<int>(backend.size()) - 1;
  double magnitude = static_cast<double>(limbs[last]);
  if (last > 0) magnitude = magnitude * 0x1p64 + static_cast<double>(limbs[last - 1]);
  return {backend.sign() ? -magnitude : magnitude, 64 * std::max(last - 1, 0)};
}

double Ratio(const Integer& numerator, const Integer& denominator) {
  const Scaled n = ToScaled(numerator), d = ToScaled(denominator);
  const double quotient = n.factor / d.factor;
  return n.exponent == d.exponent ? quotient : std::ldexp(quotient, n.exponent - d.exponent);
}

bool Form::IsZero() const {
  for (int i = 0; i <= degree; ++i) {
    if (!c[i].is_zero()) return false;
  }
  return true;
}

bool Form::FitsDoubles() const {
  constexpr unsigned kLimbs = 7;
  for (int i = 0; i <= degree; ++i) {
    if (c[i].backend().size() > kLimbs) return false;
  }
  return true;
}

Integer Form::At(const Point& point) const {
  Integer value = c[degree], power = 1;
  for (int i = degree - 1; i >= 0; --i) {
    power *= point.W;
    value = value * point.T + c[i] * power;
  }
  return value;
}

int Form::CommonSign() const {
  int common = 0;
  for (int i = 0; i <= degree; ++i) {
    const int sign = Sign(c[i]);
    if (sign * common < 0) return 0;
    if (sign != 0) common = sign;
  }
  return common;
}

int Form::Variations() const {
  int variations = 0, previous = 0;
  for (int i = 0; i <= degree; ++i) {
    const int sign = Sign(c[i]);
    if (sign * previous < 0) ++variations;
    if (sign != 0) previous = sign;
  }
  return variations;
}

Form Form::WithoutRootsAtEnds() const {
  int first = 0, last = degree;
  while (c[first].is_zero()) ++first;
  while (c[last].is_zero()) --last;
  Form f;
  f.degree = last - first;
  for (int i = 0; i <= f.degree; ++i) f.c[i] = c[first + i];
  return f;
}

Form Form::On(const Point& lo, const Point& hi) const {
  // With T = lo.T w + hi.T s and W = lo.W w + hi.W s, multiply out in (s, w), Horner's way: F <- F T + c[i] W^(n-i).
  Form result;
  result.degree = degree;
  result.c[0] = c[degree];
  std::array<Integer, 4> power;  // of W
  power[0] = 1;
  const auto multiply = [](std::array<Integer, 4>& f, int n, const Integer& at_w, const Integer& at_s) {
    f[n + 1] = f[n] * at_s;
    for (int i = n; i > 0; --i) f[i] = f[i] * at_w + f[i - 1] * at_s;
    f[0] *= at_w;
  };
  for (int n = 0; n < degree; ++n) {
    multiply(result.c, n, lo.T, hi.T);
    multiply(power, n, lo.W, hi.W);
    for (int i = 0; i <= n + 1; ++i) result.c[i] += c[degree - 1 - n] * power[i];
  }
  return result;
}

Form operator-(const Form& f, const Form& g) {
  Form difference;
  difference.degree = f.degree;
  for (int i = 0; i <= f.degree; ++i) difference.c[i] = f.c[i] - g.c[i];
  return difference;
}

BoundedCubic ToBoundedCubic(const Form& f) {
  const std::array<double, 4> c = ToDoubles(f);
  BoundedCubic g{c[0], c[1] / 3, c[2] / 3, c[3], 0};
  if (f.degree == 2) g = {c[0], (c[0] + c[1]) / 3, (c[1] + c[2]) / 3, c[2], 0};
  if (f.degree == 1) g = {c[0], (2 * c[0] + c[1]) / 3, (c[0] + 2 * c[1]) / 3, c[1], 0};
  if (f.degree == 0) g = {c[0], c[0], c[0], c[0], 0};
  // In units of u and of the largest coefficient G of g: 4 for the rounding of an integer; to raise the degree from 2
  // costs most: |f.c[1]| <= 4 G, so that 4 (1 + 4) / 3 + 2 < 8.7; then 9 for At() and On().
  g.error = 18 * kRoundoff * std::max(Largest(g.c0, g.c1), Largest(g.c2, g.c3)) + 0x1p-990;
  return g;
}

BoundedQuadratic ToBoundedQuadratic(const Form& f) {
  const std::array<double, 4> c = ToDoubles(f);
  BoundedQuadratic g{c[0], 0.5 * c[1], c[2], 0, 0};
  if (f.degree == 1) g = {c[0], 0.5 * (c[0] + c[1]), c[1], 0, 0};
  if (f.degree == 0) g = {c[0], c[0], c[0], 0, 0};
  // Likewise: 4 and 1, and 6 for Polar(). The slope is at most 2 * 2 times the largest coefficient.
  const double size = std::max(Largest(g.c0, g.c1), std::abs(g.c2));
  g.error = 12 * kRoundoff * size + 0x1p-990;
  g.slope = 4.01 * size;
  return g;
}

}  // namespace meshless_cutting::exact
