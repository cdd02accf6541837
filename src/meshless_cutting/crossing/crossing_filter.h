// First contact from polynomials with rounding bounds: certain where it answers, and it may say that it does not know.
//
// Notation (a = blade edge A0 A1, b = object edge B0 B1; everything linear in t in [0, 1]):
//   a = A1 - A0, b = B1 - B0, c = B0 - A0;  n = a x b, p = c x b, q = c x a  (quadratic);  f = n . c  (cubic).
// The pair is coplanar where f = 0 (Provot 1997). Seen along axis k, p_k and p_k - n_k are on which sides of the line
// of b the ends of a are, and q_k and q_k - n_k likewise for the ends of b and the line of a. Hence
//   * if one pair has one strict sign, the segments do not touch, coplanar or not (their shadows do not touch);
//   * if f = 0 and both pairs have opposite strict signs, the segments cross, at u = p_k / n_k and v = q_k / n_k.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "crossing/bernstein.h"
#include "crossing/edge_edge.h"

namespace meshless_cutting {

enum class Verdict { kMiss, kHit, kUnsure };

/// Along one axis: on which sides of the line of the other edge the first and the second end of an edge are.
struct EndSides {
  BoundedQuadratic first, second;
};

/// `Pair` gives, for axis k: the BoundedQuadratic N(k) = n_k, and the EndSides EndsOfA(k) = {p_k, p_k - n_k} and
/// EndsOfB(k) = {q_k, q_k - n_k}.
template <class Pair>
class CrossingFilter {
 public:
  /// f: has the roots of the coplanarity cubic in the open (0, 1).
  CrossingFilter(const Pair& pair, const BoundedCubic& f) : pair_(pair), f_(f) {}

  /// First contact in the open (0, 1). `crossing` is set if the answer is kHit; its t has a relative error below 2^-30.
  Verdict FirstCrossing(EdgeCrossing& crossing) {
    // Most pairs end here, or at their only root.
    const Shape shape = Classify(f_);
    if (shape == Shape::kNoRoot) return Verdict::kMiss;
    if (shape == Shape::kOneRoot) return AtRoot(f_, 0, 1, crossing);
    return Search(crossing);
  }

  /// True if the segments certainly do not touch at any time in [lo, hi], whatever f.
  bool Separated(double lo, double hi) const {
    for (int k = 0; k < 3; ++k) {
      if (OnOneSide(pair_.EndsOfA(k), lo, hi) || OnOneSide(pair_.EndsOfB(k), lo, hi)) return true;
    }
    return false;
  }

 private:
  enum class Shape { kNoRoot, kOneRoot, kOther, kUnknown };

  static bool OnOneSide(const EndSides& ends, double lo, double hi) {
    const int sign = ends.first.SignOn(lo, hi);
    return sign != 0 && ends.second.SignOn(lo, hi) == sign;
  }

  /// What the signs of the Bernstein coefficients say of the roots between the ends (Descartes' rule).
  static Shape Classify(const BoundedCubic& g) {
    const int s0 = g.Sign(g.c0), s1 = g.Sign(g.c1), s2 = g.Sign(g.c2), s3 = g.Sign(g.c3);
    if (s0 != 0 && s1 == s0 && s2 == s0 && s3 == s0) return Shape::kNoRoot;
    // Signs + ? ? -: one variation, unless the middle ones could be - +.
    if (s0 * s3 < 0 && (s1 == s0 || s2 == s3)) return Shape::kOneRoot;
    return s0 == 0 && s1 == 0 && s2 == 0 && s3 == 0 ? Shape::kUnknown : Shape::kOther;
  }

  static constexpr int kMaxCuts = 4;  // of one part

  /// Splits [0, 1] until each part has no root, one root, or no contact; parts are looked at in order of time.
  Verdict Search(EdgeCrossing& crossing) {
    constexpr int kMaxParts = 24;  // then it is left to the next stage, which costs more than these but ends
    // A stack: ends[top] is the end of the part that starts at lo, below it the ends of those that follow.
    std::array<double, kMaxCuts * kMaxParts + 1> ends;
    double lo = 0;
    int top = 0;
    ends[0] = 1;
    for (int part = 0; part < kMaxParts; ++part) {
      const double hi = ends[top];
      const BoundedCubic g = f_.On(lo, hi);
      const Shape shape = Classify(g);
      if (shape == Shape::kOneRoot) {
        const Verdict verdict = AtRoot(g, lo, hi, crossing);
        if (verdict != Verdict::kMiss) return verdict;
      } else if (shape != Shape::kNoRoot && !Separated(lo, hi)) {
        if (shape == Shape::kUnknown) return Verdict::kUnsure;
        // Where the sign of f stays open at an end, so it will be in each smaller part with that end.
        if (g.Sign(g.c0) == 0 && !Separated(lo, lo)) return Verdict::kUnsure;
        if (g.Sign(g.c3) == 0 && !Separated(hi, hi)) return Verdict::kUnsure;
        top = PushCuts(g, lo, hi, ends.data(), top);
        continue;
      }
      if (top == 0) return Verdict::kMiss;
      lo = hi;
      --top;
    }
    return Verdict::kUnsure;
  }

  /// Cuts (lo, hi) where f has its extrema, so that the parts are monotonic; where f is near 0 at an extremum, a part
  /// is spent on the band in which its sign is open. Pushes at most kMaxCuts cuts, the first one topmost; returns the
  /// new top.
  static int PushCuts(const BoundedCubic& g, double lo, double hi, double* ends, int top) {
    const double k1 = g.c1 - g.c0, k2 = g.c2 - 2 * g.c1 + g.c0, k3 = g.c3 - g.c0 + 3 * (g.c1 - g.c2);
    // g'/3 = k1 + 2 k2 x + k3 x^2 at x = (t - lo) / (hi - lo)
    std::array<double, kMaxCuts> cuts;
    int size = 0;
    const double discriminant = k2 * k2 - k1 * k3;
    if (discriminant > 0) {
      const double w = -(k2 + std::copysign(std::sqrt(discriminant), k2));
      double x0 = w / k3, x1 = k1 / w;
      if (x0 > x1) std::swap(x0, x1);
      for (const double x : {x0, x1}) {
        if (!(x > 0 && x < 1)) continue;
        const double value = g.c0 + x * (3 * k1 + x * (3 * k2 + x * k3));
        if (g.Sign(value) != 0) {
          cuts[size++] = x;
        } else {
          const double half_width = 2 * std::sqrt(g.error / std::sqrt(discriminant));  // g'' / 2 = 3 sqrt(discriminant)
          cuts[size++] = x - half_width;
          cuts[size++] = x + half_width;
        }
      }
    }
    double previous = lo;
    std::array<double, kMaxCuts> inside;
    int count = 0;
    for (int i = 0; i < size; ++i) {
      const double t = lo + (hi - lo) * cuts[i];
      if (t > previous && t < hi) inside[count++] = previous = t;
    }
    if (count == 0) inside[count++] = 0.5 * (lo + hi);
    for (int i = count - 1; i >= 0; --i) ends[++top] = inside[i];
    return top;
  }

  /// The pair at the only root in (lo, hi), on which g has the coefficients of f and opposite certain signs at the
  /// ends.
  Verdict AtRoot(const BoundedCubic& g, double lo, double hi, EdgeCrossing& crossing) const {
    double slope = 0;
    const double t = lo + (hi - lo) * RootInside(g, slope);
    // The root is within `reach` of t if f changes its sign there. 4 u: more than the rounding of t +- reach.
    const double reach = 3 * g.error / std::abs(slope) * (hi - lo) + 4 * kRoundoff;
    if (!(reach <= 0x1p-31 * t)) return Verdict::kUnsure;
    const int sign = g.Sign(g.c0);
    const double before = t - reach, after = t + reach;
    if (before > lo && f_.Sign(f_.At(before)) != sign) return Verdict::kUnsure;
    if (after < hi && f_.Sign(f_.At(after)) != -sign) return Verdict::kUnsure;
    return Order(t, 1.25 * reach, crossing);
  }

  /// The ordering conditions at a root of f within `reach` of t, seen along the axis nearest to the normal.
  Verdict Order(double t, double reach, EdgeCrossing& crossing) const {
    int k = 0;
    double n = 0;
    for (int i = 0; i < 3; ++i) {
      const double n_i = pair_.N(i).Polar(t, t);
      if (std::abs(n_i) > std::abs(n)) n = n_i, k = i;
    }
    const EndSides& a = pair_.EndsOfA(k);
    const int a0 = a.first.SignNear(t, reach), a1 = a.second.SignNear(t, reach);
    if (a0 * a1 > 0) return Verdict::kMiss;
    const EndSides& b = pair_.EndsOfB(k);
    const int b0 = b.first.SignNear(t, reach), b1 = b.second.SignNear(t, reach);
    if (b0 * b1 > 0) return Verdict::kMiss;
    if (a0 * a1 * b0 * b1 == 0) return Verdict::kUnsure;
    crossing = {t, std::clamp(a.first.Polar(t, t) / n, 0.0, 1.0), std::clamp(b.first.Polar(t, t) / n, 0.0, 1.0)};
    return Verdict::kHit;
  }

  const Pair& pair_;
  const BoundedCubic& f_;
};

}  // namespace meshless_cutting
