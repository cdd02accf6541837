// The polynomials of a pair of moving segments in plain double arithmetic, with proven bounds. Notation:
// crossing_filter.h.
//
// Let A, B, C be the largest |computed component| of a, b, c at t = 0 and t = 1. First-order constants in units of u:
//   a, b, c            one rounded difference: |computed - true| <= A u, |true| <= A (1 + u); likewise b, c.
//   x0 y1 (product)    2 from the factors + 1 for rounding = 3, times X Y, where |x| <= X and |y| <= Y.
//   x0 y1 - x1 y0      2 * 3 + 2 (rounding of a number <= 2 X Y) = 8; times X Y.
//   cross(x0, y1) + cross(x1, y0)   2 * 8 + 4 = 20 (a number <= 4 X Y). Its half, the middle Bernstein coefficient: 10.
//   quadratic at t     10 + 6 * 2 (Lerp: two levels of 3, of numbers <= 2 X Y) = 22.
//   p - n, q - n       coefficients: 10 (C + A) B + 2 (C + A) B; at t: 12 + 6 * 2 = 24, times (C + A) B, or (C + B) A.
//   n(0) . c(0)        products: 8 + 2 (error of c) + 2 (rounding) = 12 each; sums <= 4 and <= 6: 3 * 12 + 4 + 6 = 46,
//                      times A B C, and the number is <= 6 A B C. Likewise n(1) . c(1), n(0) . c(1), n(1) . c(0).
//   n01 . c            n01 = the doubled middle coefficient: products: 20 + 4 + 4 = 28; sums: 8 and 12: 3 * 28 + 20 =
//   104. c1, c2 of f        46 + 104 + 18 (sum <= 18) = 168; over 3, + 6 for the division: 62. The coefficients are <=
//   6 A B C. cubic at t         62 + 9 * 6 (three levels of Lerp) = 116.
// Of the quadratics, |true coefficient| <= 2 X Y, so that |derivative| <= 2 * 4 X Y.
// Underflow: fewer than 100 operations err by at most 2^-1022 each (flushed to zero at worst), before factors < 2^400
// in all: below 2^-615.
#pragma once

#include <Eigen/Core>

#include "crossing/bernstein.h"
#include "crossing/crossing_filter.h"
#include "crossing/edge_edge.h"

namespace meshless_cutting {

class RoundedPair {
 public:
  // In units of roundoff: what is derived above, plus room for its terms of second order.
  static constexpr double kQuadraticError = 25 * kRoundoff;
  static constexpr double kCubicError = 118 * kRoundoff;
  static constexpr double kUnderflow = 0x1p-610;
  /// Beyond this, products could overflow. (And below its inverse kUnderflow hides the signs.)
  static constexpr double kLargest = 0x1p200;

  RoundedPair(const MovingSegment& a, const MovingSegment& b)
      : a0_(a.q_t0 - a.p_t0),
        a1_(a.q_t1 - a.p_t1),
        b0_(b.q_t0 - b.p_t0),
        b1_(b.q_t1 - b.p_t1),
        c0_(b.p_t0 - a.p_t0),
        c1_(b.p_t1 - a.p_t1),
        A_(Largest(a0_, a1_)),
        B_(Largest(b0_, b1_)),
        C_(Largest(c0_, c1_)) {}

  /// Whether the bounds hold. Not for huge numbers, nor where a difference overflowed.
  bool InRange() const { return A_ < kLargest && B_ < kLargest && C_ < kLargest; }

  /// Call once, before anything below.
  BoundedCubic Coplanarity() {
    for (int k = 0; k < 3; ++k) n_[k] = Cross(a0_, a1_, b0_, b1_, k);
    const Eigen::Vector3d n0(n_[0].c0, n_[1].c0, n_[2].c0), n2(n_[0].c2, n_[1].c2, n_[2].c2);
    const Eigen::Vector3d n01 = 2 * Eigen::Vector3d(n_[0].c1, n_[1].c1, n_[2].c1);  // exact
    return {Dot(n0, c0_), (Dot(n0, c1_) + Dot(n01, c0_)) / 3, (Dot(n01, c1_) + Dot(n2, c0_)) / 3, Dot(n2, c1_),
            kCubicError * (A_ * B_ * C_) + kUnderflow};
  }

  BoundedQuadratic N(int k) const { return Bounded(n_[k], A_ * B_); }
  EndSides EndsOfA(int k) const {
    const Coefficients p = Cross(c0_, c1_, b0_, b1_, k);
    return {Bounded(p, C_ * B_), Bounded(Minus(p, n_[k]), (C_ + A_) * B_)};
  }
  EndSides EndsOfB(int k) const {
    const Coefficients q = Cross(c0_, c1_, a0_, a1_, k);
    return {Bounded(q, C_ * A_), Bounded(Minus(q, n_[k]), (C_ + B_) * A_)};
  }

 private:
  struct Coefficients {
    double c0, c1, c2;
  };

  static double Largest(const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
    return x.cwiseAbs().cwiseMax(y.cwiseAbs()).maxCoeff();
  }
  static double Dot(const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
  }
  /// Component k of the cross product of two vectors that are linear in t.
  static Coefficients Cross(const Eigen::Vector3d& x0, const Eigen::Vector3d& x1, const Eigen::Vector3d& y0,
                            const Eigen::Vector3d& y1, int k) {
    const int i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
    return {x0[i] * y0[j] - x0[j] * y0[i], 0.5 * ((x0[i] * y1[j] - x0[j] * y1[i]) + (x1[i] * y0[j] - x1[j] * y0[i])),
            x1[i] * y1[j] - x1[j] * y1[i]};
  }
  static Coefficients Minus(const Coefficients& x, const Coefficients& y) {
    return {x.c0 - y.c0, x.c1 - y.c1, x.c2 - y.c2};
  }
  static BoundedQuadratic Bounded(const Coefficients& c, double size) {
    return {c.c0, c.c1, c.c2, kQuadraticError * size + kUnderflow, 8.25 * size};
  }

  Eigen::Vector3d a0_, a1_, b0_, b1_, c0_, c1_;
  double A_, B_, C_;
  std::array<Coefficients, 3> n_;
};

}  // namespace meshless_cutting
