#include "crossing/exact_root.h"

#include <algorithm>
#include <cmath>

namespace meshless_cutting::exact {
namespace {

int SignAt(const Form& f, const Dyadic& x) { return Sign(f.At({x.at, (Integer(1) << x.bits) - x.at})); }

/// Of a form that is not zero: its sign next to 0 and next to 1.
int SignAfterStart(const Form& f) {
  int i = 0;
  while (f.c[i].is_zero()) ++i;
  return Sign(f.c[i]);
}
int SignBeforeEnd(const Form& f) {
  int i = f.degree;
  while (f.c[i].is_zero()) --i;
  return Sign(f.c[i]);
}

/// The roots of f if there are `count`, all simple, and the points lie between them; else nothing. It is known that
/// there are not more, and the signs of f at the points prove the rest.
std::vector<Root> RootsBetween(const Form& f, const std::vector<Dyadic>& points, int count) {
  std::vector<Root> roots;
  roots.reserve(points.size() + 1);
  const auto bracket = [&](const Dyadic& lo, const Dyadic& hi) {
    const int bits = std::max(lo.bits, hi.bits);
    roots.push_back(Root::Bracketed(f, lo.at << (bits - lo.bits), hi.at << (bits - hi.bits), bits));
  };
  Dyadic lo{0, 0};
  int sign_lo = SignAfterStart(f);
  for (const Dyadic& point : points) {
    const int sign = SignAt(f, point);
    if (sign == 0) return {};
    if (sign != sign_lo) bracket(lo, point);
    lo = point, sign_lo = sign;
  }
  if (sign_lo != SignBeforeEnd(f)) bracket(lo, {1, 0});
  if (static_cast<int>(roots.size()) != count) roots.clear();
  return roots;
}

/// The positive ones of the points (signs not yet set right), in order.
std::vector<Root> RationalRoots(std::vector<Point> points) {
  std::vector<Root> roots;
  for (Point& point : points) {
    if (Sign(point.W) < 0) point = {-point.T, -point.W};
  }
  std::sort(points.begin(), points.end(), [](const Point& x, const Point& y) { return x.T * y.W < y.T * x.W; });
  for (const Point& point : points) {
    if (Sign(point.T) > 0) roots.push_back(Root::Rational(point));
  }
  return roots;
}

/// The extrema of a cubic in (0, 1) to double accuracy, in order.
std::vector<Dyadic> ExtremaByDoubles(const Form& f) {
  const BoundedCubic g = ToBoundedCubic(f);
  // f' / 3 = k1 + 2 k2 t + k3 t^2
  const double k1 = g.c1 - g.c0, k2 = g.c2 - 2 * g.c1 + g.c0, k3 = g.c3 - g.c0 + 3 * (g.c1 - g.c2);
  const double w = -(k2 + std::copysign(std::sqrt(std::max(k2 * k2 - k1 * k3, 0.0)), k2));
  std::vector<Dyadic> points;
  constexpr int kBits = 53;
  for (const double t : {std::min(w / k3, k1 / w), std::max(w / k3, k1 / w)}) {
    if (t > 0 && t < 1) points.push_back({static_cast<long long>(std::ldexp(t, kBits)), kBits});
  }
  return points;
}

/// The roots of f, of which there are `count` > 1, all simple.
std::vector<Root> SeparatedRoots(const Form& f, int count) {
  Form derivative;
  derivative.degree = f.degree - 1;
  for (int i = 0; i < f.degree; ++i) derivative.c[i] = (i + 1) * f.c[i + 1] - (f.degree - i) * f.c[i];
  // Between two roots is an extremum, and all around it f has the same sign.
  std::vector<Root> extrema = derivative.degree == 1 ? RootsBetween(derivative, {}, 1) : RootsInside(derivative);
  for (Root& extremum : extrema) extremum.Locate();
  for (;;) {
    std::vector<Dyadic> points;
    for (const Root& extremum : extrema) points.push_back(extremum.NearDyadic());
    std::vector<Root> roots = RootsBetween(f, points, count);
    if (!roots.empty()) return roots;
    for (Root& extremum : extrema) extremum.Refine();
  }
}

/// Roots of a form with the coefficients c[0 ... 2] once its roots at 0 and 1 are taken off, with two sign variations.
std::vector<Root> QuadraticRoots(const Form& f, const Integer* c) {
  const Integer discriminant = c[1] * c[1] - 4 * c[0] * c[2];
  if (Sign(discriminant) < 0) return {};
  if (discriminant.is_zero()) return RationalRoots({{-c[1], 2 * c[2]}});
  return SeparatedRoots(f, 2);
}

/// Roots of a form of degree 3 with two or three sign variations, not 0 at the ends.
std::vector<Root> CubicRoots(const Form& f, int variations) {
  std::vector<Root> roots = RootsBetween(f, ExtremaByDoubles(f), variations);
  if (!roots.empty()) return roots;
  const auto& c = f.c;
  const Integer c22 = c[2] * c[2], c13 = c[1] * c[3], c03 = c[0] * c[3], c12 = c[1] * c[2];
  const Integer discriminant = c12 * (c12 + 18 * c03) - 4 * (c13 * c[1] * c[1] + c22 * c[2] * c[0]) - 27 * c03 * c03;
  if (discriminant.is_zero()) {  // a multiple root: then all roots are rational
    const Integer D = c22 - 3 * c13;
    if (D.is_zero()) return RationalRoots({{-c[2], 3 * c[3]}});
    return RationalRoots({{9 * c03 - c12, 2 * D}, {4 * c13 * c[2] - 9 * c03 * c[3] - c22 * c[2], c[3] * D}});
  }
  // One real root if the discriminant is negative; three if it is positive, and then Descartes' rule counts exactly.
  if (Sign(discriminant) < 0) return RootsBetween(f, {}, variations % 2);
  return SeparatedRoots(f, variations);
}

}  // namespace

Root Root::Rational(Point point) {
  Root root;
  root.SetRational(std::move(point));
  return root;
}

Root Root::Bracketed(const Form& form, Integer lo, Integer hi, int bits) {
  Root root;
  root.form_ = &form;
  root.lo_ = std::move(lo);
  root.hi_ = std::move(hi);
  root.bits_ = bits;
  if (root.lo_.is_zero()) {  // where the form may have another root
    root.sign_lo_ = SignAfterStart(form);
  } else {
    root.sign_lo_ = Sign(form.At(root.At(root.lo_)));
  }
  return root;
}

Point Root::At(const Integer& numerator) const { return {numerator, (Integer(1) << bits_) - numerator}; }

void Root::SetRational(Point point) {
  form_ = nullptr;
  located_ = true;
  near_ = std::move(point);
  t_ = Ratio(near_.T, near_.T + near_.W);
}

void Root::Locate() {
  if (located_) return;
  StartByDoubles();
  // What t() promises. The root is not 0: lo_ leaves 0 at some refinement.
  while (form_ != nullptr && ((hi_ - lo_) << 32) > lo_) Refine();
  if (form_ == nullptr) return;  // found to be rational
  located_ = true;
  const Integer one = Integer(2) << bits_;
  near_.T = lo_ + hi_;
  near_.W = one - near_.T;
  t_ = Ratio(near_.T, one);
  reach_ = Ratio(hi_ - lo_, one) + 8 * kRoundoff;  // 8 u: more than the rounding of both
}

void Root::Refine() {
  if (form_ != nullptr && !RefineByDoubles()) Halve();
}

/// Most roots are seen well enough with the coefficients on all of [0, 1].
void Root::StartByDoubles() {
  const BoundedCubic f = ToBoundedCubic(form_->WithoutRootsAtEnds());
  const Integer one = Integer(1) << bits_;
  const double lo = Ratio(lo_, one), hi = Ratio(hi_, one);
  double slope = 0;
  const double t = lo + (hi - lo) * RootInside(f.On(lo, hi), slope);
  const double reach = std::max(3 * f.error / std::abs(slope) * (hi - lo), 0x1p-50);
  // 2 reach: the new bracket stays inside the old one, also after the roundings here and below.
  if (!(reach < 0x1p-36 * t && t - 2 * reach > lo && t + 2 * reach < hi)) return;
  const double before = t - reach, after = t + reach;
  if (f.Sign(f.At(before)) != sign_lo_ || f.Sign(f.At(after)) != -sign_lo_) return;
  bits_ = 62;
  lo_ = static_cast<long long>(std::ldexp(before, bits_));
  hi_ = static_cast<long long>(std::ldexp(after, bits_)) + 1;
}

/// Takes the coefficients on the bracket, where doubles see the root as large as the bracket is.
bool Root::RefineByDoubles() {
  const Form on_bracket = bits_ == 0 ? *form_ : form_->On(At(lo_), At(hi_));
  const BoundedCubic g = ToBoundedCubic(on_bracket.WithoutRootsAtEnds());
  double slope = 0;
  const double x = RootInside(g, slope);
  const double reach = std::max(3 * g.error / std::abs(slope), 0x1p-49);
  if (!(x > 0 && x < 1 && reach < 0.01)) return false;
  // New ends on a grid of 2^-digits of the bracket, at least 2 reach away from x.
  const int digits = -std::ilogb(reach) - 1;
  const double grid = std::ldexp(1.0, -digits);
  const auto before = static_cast<long long>(std::floor(x / grid)) - 1, after = before + 3;
  const long long end = 1LL << digits;
  if (before > 0 && CertainSign(g.At(static_cast<double>(before) * grid), g.error) != sign_lo_) return false;
  if (after < end && CertainSign(g.At(static_cast<double>(after) * grid), g.error) != -sign_lo_) return false;
  const Integer width = hi_ - lo_, start = lo_ << digits;
  lo_ = start + width * std::max(before, 0LL);
  hi_ = start + width * std::min(after, end);
  bits_ += digits;
  return true;
}

void Root::Halve() {
  const Integer middle = lo_ + hi_;
  ++bits_;
  const int sign = Sign(form_->At(At(middle)));
  if (sign == 0) {
    SetRational(At(middle));
    lo_ = hi_ = middle;
    return;
  }
  lo_ = sign == sign_lo_ ? middle : Integer(lo_ << 1);
  hi_ = sign == sign_lo_ ? Integer(hi_ << 1) : middle;
}

int Root::SignOnBracket(const Form& g) const { return g.On(At(lo_), At(hi_)).CommonSign(); }

bool Root::IsRootOf(const Form& g) const {
  // Euclid's algorithm in x = T / W: the remainder l1 x + l0 of form_ by g = g2 x^2 + g1 x + g0, without divisions.
  Integer l0 = g.c[0], l1 = g.c[1];
  const bool divided = g.degree == 2 && !g.c[2].is_zero();
  if (divided) {
    std::array<Integer, 4> f = form_->c;
    for (int i = form_->degree; i >= 2; --i) {
      f[i - 1] = f[i - 1] * g.c[2] - f[i] * g.c[1];
      f[i - 2] = f[i - 2] * g.c[2] - f[i] * g.c[0];
      if (i == 3) f[0] *= g.c[2];
    }
    if (f[0].is_zero() && f[1].is_zero()) {
      // g divides form_, whose only root on the bracket is simple: it is g's as well if g changes its sign there.
      return Sign(g.At(At(lo_))) != Sign(g.At(At(hi_)));
    }
    l0 = std::move(f[0]), l1 = std::move(f[1]);
  }
  if (Sign(l0) * Sign(l1) >= 0) return false;  // no positive root
  const Point common{abs(l0), abs(l1)};
  const Integer scaled = common.T << bits_, whole = common.T + common.W;
  if (scaled <= lo_ * whole || scaled >= hi_ * whole) return false;
  // A root of g and of the remainder is one of form_; if g was linear, form_ was not divided.
  return g.At(common).is_zero() && (divided || form_->At(common).is_zero());
}

int Root::SignOf(const Form& g) {
  if (g.IsZero()) return 0;
  Locate();
  if (form_ == nullptr) {
    if (near_.T.is_zero()) return Sign(g.c[0]);
    if (near_.W.is_zero()) return Sign(g.c[g.degree]);
    return Sign(g.At(near_));
  }
  if (const int sign = g.CommonSign()) return sign;
  if (const int sign = ToBoundedQuadratic(g).SignNear(t_, reach_)) return sign;
  if (IsRootOf(g)) return 0;
  while (form_ != nullptr) {
    if (const int sign = SignOnBracket(g)) return sign;
    Refine();
  }
  return Sign(g.At(near_));
}

std::vector<Root> RootsInside(const Form& f) {
  const int variations = f.Variations();
  if (variations == 0) return {};
  if (variations == 1 && f.degree > 1) return RootsBetween(f, {}, 1);
  int first = 0, last = f.degree;
  while (f.c[first].is_zero()) ++first;
  while (f.c[last].is_zero()) --last;
  if (last - first == 1) return RationalRoots({{-f.c[first], f.c[last]}});
  return last - first == 2 ? QuadraticRoots(f, &f.c[first]) : CubicRoots(f, variations);
}

}  // namespace meshless_cutting::exact
