// Integer polynomials on t in [0, 1].
//
// Notation: a form of degree n is  F(T, W) = sum_i c[i] T^i W^(n-i)  with T : W = t : 1 - t, so that c[i] is the
// Bernstein coefficient of t times binomial(n, i). Its merits here: integer data gives integer coefficients without a
// division; t = 0 and t = 1 are the points 0 : 1 and 1 : 0 like any other; dividing by t or by 1 - t drops an end
// coefficient; and Descartes' rule on c counts roots in the open (0, 1), which are the positive roots of x = T / W.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>

#include "crossing/bernstein.h"
#include "crossing/fixed_integer.h"

namespace meshless_cutting::exact {

/// Unbounded. Up to 1,024 bits are held in place: doubles of ordinary exponents rarely make it allocate.
using Integer = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<1024, 0, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked,
                                           std::allocator<boost::multiprecision::limb_type>>,
    boost::multiprecision::et_off>;

inline int Sign(const Integer& x) { return x.sign(); }

inline const Integer& ToInteger(const Integer& x) { return x; }
template <int words>
Integer ToInteger(const FixedInteger<words>& x) {
  const FixedInteger<words> magnitude = x.Magnitude();
  int size = 2 * words;
  while (size > 1 && magnitude.Limb(size - 1) == 0) --size;
  Integer result;
  auto& backend = result.backend();
  static_assert(sizeof(*backend.limbs()) == 8, "limbs of 64 bits are expected");
  backend.resize(static_cast<unsigned>(size), static_cast<unsigned>(size));
  for (int i = 0; i < size; ++i) backend.limbs()[i] = magnitude.Limb(i);
  backend.sign(x.IsNegative());
  return result;
}

/// x = factor * 2^exponent with |factor| < 2^129; its relative error is below 2^-51.
struct Scaled {
  double factor;
  int exponent;
};
Scaled ToScaled(const Integer& x);

/// numerator / denominator in double accuracy; the denominator is not zero.
double Ratio(const Integer& numerator, const Integer& denominator);

/// The point T : W of [0, 1], both not negative, not both zero; t = T / (T + W).
struct Point {
  Integer T, W;
};

/// Polynomial of degree at most 3 in the notation above.
struct Form {
  int degree = 0;
  std::array<Integer, 4> c;

  bool IsZero() const;
  /// Whether the coefficients are below 2^448: doubles hold their squares.
  bool FitsDoubles() const;
  Integer At(const Point& point) const;
  /// The sign that all coefficients but zeros have: that of the form on the open (0, 1). Nothing if they differ.
  int CommonSign() const;
  /// How often the coefficients change their sign.
  int Variations() const;
  /// Divided by the powers of T and W that it contains; the form is not zero.
  Form WithoutRootsAtEnds() const;
  /// Bernstein coefficients on [lo, hi], times binomials and a positive factor.
  Form On(const Point& lo, const Point& hi) const;
};
Form operator-(const Form& f, const Form& g);  // of equal degree

// As polynomials in doubles, over some power of two, which is 1 if FitsDoubles().
/// Of degree at most 3, raised to degree 3.
BoundedCubic ToBoundedCubic(const Form& f);
/// Of degree at most 2, raised to degree 2.
BoundedQuadratic ToBoundedQuadratic(const Form& f);

}  // namespace meshless_cutting::exact
