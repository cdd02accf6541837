#include "crossing/fixed_pair.h"

namespace meshless_cutting {
namespace {

double Proportion(double numerator, double denominator) {
  return denominator == 0 ? 0 : std::clamp(numerator / denominator, 0.0, 1.0);
}

FixedPair::Polynomials::Ends Shifted(const IntegerCoordinates& coordinates) {
  FixedPair::Polynomials::Ends ends;
  for (int i = 0; i < 24; ++i) {
    // Two's complement extends the sign; shifting it is the multiplication.
    ends[i / 3][i % 3] = {{static_cast<Word>(coordinates.mantissa[i]) << coordinates.shift[i]}};
  }
  return ends;
}

}  // namespace

FixedPair::FixedPair(const IntegerCoordinates& coordinates) : pair_(Shifted(coordinates)) {}

EndSides FixedPair::Sides(const Quadratic& first, int k) const {
  const Quadratic& n = pair_.n[k];
  return {Bounded(first), Bounded({first[0] - n[0], first[1] - n[1], first[2] - n[2]})};
}

/// In units of u and of the largest coefficient: 4 for the rounding of an exact coefficient, 6 for Polar().
BoundedQuadratic FixedPair::Bounded(const Quadratic& x) {
  const double c0 = x[0].ToDouble(), c1 = 0.5 * x[1].ToDouble(), c2 = x[2].ToDouble();
  const double size = std::max({std::abs(c0), std::abs(c1), std::abs(c2)});
  return {c0, c1, c2, 11 * kRoundoff * size, 4.1 * size};
}

Verdict FixedPair::FirstCrossing(EdgeCrossing& crossing) const {
  const Polynomials::Cubic f = pair_.Coplanarity();
  if (f[0].IsZero() && ContactAtEnd(0, crossing)) return Verdict::kHit;
  int first = 0, last = 3;
  while (first < 4 && f[first].IsZero()) ++first;
  while (last > first && f[last].IsZero()) --last;
  if (first > last) {  // coplanar at all times
    const BoundedCubic zero{0, 0, 0, 0, 0};
    return CrossingFilter(*this, zero).Separated(0, 1) ? Verdict::kMiss : Verdict::kUnsure;
  }
  // Without its roots at 0 and 1, of degree last - first; then raised to degree 3 again. In units of u and of the
  // largest coefficient G: 4 for the rounding of an exact number; to raise the degree from 2 costs most: |g[1]| <= 4 G,
  // so that 4 (1 + 4) / 3 + 2 < 8.7; then 9 for At() and On().
  std::array<double, 4> g{};
  const int degree = last - first;
  for (int i = 0; i <= degree; ++i) g[i] = f[first + i].ToDouble();
  BoundedCubic cubic{g[0], g[1] / 3, g[2] / 3, g[3], 0};
  if (degree == 2) cubic = {g[0], (g[0] + g[1]) / 3, (g[1] + g[2]) / 3, g[2], 0};
  if (degree == 1) cubic = {g[0], (2 * g[0] + g[1]) / 3, (g[0] + 2 * g[1]) / 3, g[1], 0};
  if (degree == 0) cubic = {g[0], g[0], g[0], g[0], 0};
  cubic.error =
      19 * kRoundoff * std::max({std::abs(cubic.c0), std::abs(cubic.c1), std::abs(cubic.c2), std::abs(cubic.c3)});
  const Verdict verdict = CrossingFilter(*this, cubic).FirstCrossing(crossing);
  if (verdict != Verdict::kMiss) return verdict;
  return f[3].IsZero() && ContactAtEnd(1, crossing) ? Verdict::kHit : Verdict::kMiss;
}

bool FixedPair::ContactAtEnd(int end, EdgeCrossing& crossing) const {
  const int i = 2 * end;
  int k = 0;
  double n = 0;
  for (int j = 0; j < 3; ++j) {
    const double n_j = pair_.n[j][i].ToDouble();
    if (std::abs(n_j) > std::abs(n)) n = n_j, k = j;
  }
  if (n == 0) return ContactOfParallel(end, crossing);
  const int sign = pair_.n[k][i].Sign();
  const Product p = pair_.PAtEnd(end, k), q = pair_.QAtEnd(end, k);
  for (const Product& x : {p, pair_.n[k][i] - p, q, pair_.n[k][i] - q}) {
    if (x.Sign() == -sign) return false;
  }
  crossing = {static_cast<double>(end), Proportion(p.ToDouble(), n), Proportion(q.ToDouble(), n)};
  return true;
}

/// With n = 0: on one line if p = q = 0; then they share a point if their intervals along each axis do.
bool FixedPair::ContactOfParallel(int end, EdgeCrossing& crossing) const {
  for (int k = 0; k < 3; ++k) {
    if (!pair_.PAtEnd(end, k).IsZero() || !pair_.QAtEnd(end, k).IsZero()) return false;
  }
  const Coordinate zero;
  const auto less = [](const Coordinate& x, const Coordinate& y) { return (x - y).IsNegative(); };
  const auto smaller = [&](const Coordinate& x, const Coordinate& y) { return less(x, y) ? x : y; };
  const auto larger = [&](const Coordinate& x, const Coordinate& y) { return less(x, y) ? y : x; };
  double longest = 0;
  crossing = {static_cast<double>(end), 0, 0};
  for (int k = 0; k < 3; ++k) {  // in coordinates from A0: a covers [0, a], b covers [c, c + b]
    const Coordinate &a = pair_.a[end][k], &b = pair_.b[end][k], &c = pair_.c[end][k];
    const Coordinate first = larger(smaller(zero, a), smaller(c, c + b));
    const Coordinate last = smaller(larger(zero, a), larger(c, c + b));
    if (less(last, first)) return false;
    const double length = std::max(std::abs(a.ToDouble()), std::abs(b.ToDouble()));
    if (length <= longest) continue;
    longest = length;
    crossing.u = Proportion(first.ToDouble(), a.ToDouble());
    crossing.v = Proportion((first - c).ToDouble(), b.ToDouble());
  }
  return true;
}

}  // namespace meshless_cutting
