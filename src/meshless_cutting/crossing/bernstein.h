// Polynomials on t in [0, 1] as Bernstein coefficients in doubles, with bounds on what rounding did to them.
//
// Unit roundoff u = 2^-53, rounding to nearest: |fl(x op y) - (x op y)| <= u |x op y| and <= u |fl(x op y)|, unless a
// product underflows. Bounds are sums of such terms; those of order u^2 are covered by rounding the sums of the
// first-order constants up by more than 1 part in 100. A fused multiply-add leaves a rounding out and adds none, so
// that the bounds hold with and without; still everything is compiled with -ffp-contract=off, for the same bits
// everywhere.
#pragma once

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace meshless_cutting {

#if defined(__FAST_MATH__) || FLT_EVAL_METHOD != 0
#error "The rounding bounds of the crossing test need IEEE doubles: no -ffast-math, no x87"
#endif

inline constexpr double kRoundoff = 0x1p-53;

/// (1 - t) x + t y for t in [0, 1]. With m = max(|x|, |y|) it errs by at most 3 u m: 2 u m and u m for the weighted
/// terms of total weight 1 (one of them is rounded twice), u m for the sum. Errors of x and y are not amplified.
inline double Lerp(double x, double y, double t) { return (1 - t) * x + t * y; }

/// Sign of a number known up to +-error; 0 if that leaves it open.
inline int CertainSign(double x, double error) { return (x > error) - (x < -error); }

/// A true quadratic is within `error` of what the functions return, and changes by at most `slope` per unit of t.
struct BoundedQuadratic {
  double c0, c1, c2;
  double error;
  double slope;

  /// The polar form: Polar(t, t) is the value at t; Polar(s, s), Polar(s, t), Polar(t, t) are the coefficients on [s,
  /// t]. Evaluation adds at most 6 u max|c|.
  double Polar(double s, double t) const { return Lerp(Lerp(c0, c1, s), Lerp(c1, c2, s), t); }

  /// The sign if it is certainly the same on all of [s, t], else 0.
  int SignOn(double s, double t) const {
    const int sign = CertainSign(Polar(s, s), error);
    const bool same = CertainSign(Polar(s, t), error) == sign && CertainSign(Polar(t, t), error) == sign;
    return same ? sign : 0;
  }

  /// The sign if it is certainly the same everywhere within `reach` of t, else 0.
  int SignNear(double t, double reach) const { return CertainSign(Polar(t, t), error + slope * reach); }
};

/// A true cubic is within `error` of what At() and On() return.
struct BoundedCubic {
  double c0, c1, c2, c3;
  double error;

  /// Value at t. Evaluation adds at most 9 u max|c|.
  double At(double t) const {
    const double x0 = Lerp(c0, c1, t), x1 = Lerp(c1, c2, t), x2 = Lerp(c2, c3, t);
    return Lerp(Lerp(x0, x1, t), Lerp(x1, x2, t), t);
  }

  /// Coefficients on [s, t], as functions of (t' - s) / (t - s). Evaluation adds at most 9 u max|c|.
  BoundedCubic On(double s, double t) const {
    const double x0 = Lerp(c0, c1, s), x1 = Lerp(c1, c2, s), x2 = Lerp(c2, c3, s);
    const double y0 = Lerp(c0, c1, t), y1 = Lerp(c1, c2, t), y2 = Lerp(c2, c3, t);
    const double xx0 = Lerp(x0, x1, s), xx1 = Lerp(x1, x2, s);
    const double yy0 = Lerp(y0, y1, t), yy1 = Lerp(y1, y2, t);
    return {Lerp(xx0, xx1, s), Lerp(xx0, xx1, t), Lerp(yy0, yy1, s), Lerp(yy0, yy1, t), error};
  }

  int Sign(double x) const { return CertainSign(x, error); }
};

/// The root x in (0, 1) of a cubic whose end coefficients have opposite signs, and the slope there: Newton's method
/// kept inside the bracket. An estimate; nothing is certain about it.
inline double RootInside(const BoundedCubic& g, double& slope) {
  const double k1 = 3 * (g.c1 - g.c0), k2 = 3 * (g.c2 - 2 * g.c1 + g.c0), k3 = g.c3 - g.c0 + 3 * (g.c1 - g.c2);
  double lo = 0, hi = 1, x = g.c0 / (g.c0 - g.c3);
  constexpr int kMaxSteps = 60;
  for (int i = 0; i < kMaxSteps; ++i) {
    const double value = g.c0 + x * (k1 + x * (k2 + x * k3));
    slope = k1 + x * (2 * k2 + 3 * x * k3);
    ((value > 0) == (g.c0 > 0) ? lo : hi) = x;
    double next = x - value / slope;
    if (!(next >= lo && next <= hi)) next = 0.5 * (lo + hi);
    const bool converged = std::abs(next - x) < 0x1p-28 * x;
    x = next;
    if (converged) {  // a last correction takes it to rounding
      return std::clamp(x - (g.c0 + x * (k1 + x * (k2 + x * k3))) / slope, lo, hi);
    }
  }
  return x;
}

}  // namespace meshless_cutting
