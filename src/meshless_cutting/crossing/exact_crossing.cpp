// Theory, in the notation of crossing_filter.h. Two points of the segments meet where u a - v b = c; crossed with b and
// a, u n = p and v n = q. So at a time t with f = 0
//   n_k != 0 for some axis k:  the lines meet in one point; it is on both segments iff 0 <= p_k / n_k, q_k / n_k <= 1.
//   n = 0 (parallel, or a zero-length edge):  the segments are on one line iff p = q = 0, and then they share a point
//     iff their intervals overlap along each axis (two points, a = b = 0, share one iff they are equal: the same).
// If f is not zero everywhere, its roots are the only candidates. If it is, contact can begin only at t = 0 or where
// one of the conditions just named changes its sign, which are roots of the forms in them: between two of those the
// answer is constant, and the set of contact times is closed.
#include "crossing/exact_crossing.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "crossing/exact_root.h"
#include "crossing/integer_coordinates.h"

namespace meshless_cutting::exact {
namespace {

/// Components of the vectors of crossing_filter.h as forms, made when first asked for.
template <class Polynomials>
class PairForms {
 public:
  explicit PairForms(const Polynomials& pair) : pair_(pair) {}

  const Form& N(int k) {
    return Quadratic(n_[k], [&] { return pair_.n[k]; });
  }
  const Form& P(int k) {
    return Quadratic(p_[k], [&] { return pair_.P(k); });
  }
  const Form& Q(int k) {
    return Quadratic(q_[k], [&] { return pair_.Q(k); });
  }
  Form A(int k) const { return Linear(pair_.a, k); }
  Form B(int k) const { return Linear(pair_.b, k); }
  Form C(int k) const { return Linear(pair_.c, k); }
  Form F() const {
    const auto f = pair_.Coplanarity();
    return {3, {ToInteger(f[0]), ToInteger(f[1]), ToInteger(f[2]), ToInteger(f[3])}};
  }
  /// A0 - B0, A0 - B1, A1 - B0, A1 - B1.
  std::array<Form, 4> EndDifferences(int k) const {
    Form zero;
    zero.degree = 1;
    const Form b = B(k), c = C(k), a_minus_c = A(k) - c, minus_c = zero - c;
    return {minus_c, minus_c - b, a_minus_c, a_minus_c - b};
  }

 private:
  template <class Vector>
  static Form Linear(const Vector& x, int k) {
    return {1, {ToInteger(x[0][k]), ToInteger(x[1][k])}};
  }
  template <class Make>
  static const Form& Quadratic(std::optional<Form>& form, Make make) {
    if (!form) {
      const auto x = make();
      form.emplace(Form{2, {ToInteger(x[0]), ToInteger(x[1]), ToInteger(x[2])}});
    }
    return *form;
  }

  const Polynomials& pair_;
  std::array<std::optional<Form>, 3> n_, p_, q_;
};

/// Of an always coplanar pair: forms, not zero, among whose roots are the times inside (0, 1) at which contact can
/// begin.
template <class Forms>
std::vector<Form> Switches(Forms& pair) {
  std::vector<Form> forms;
  forms.reserve(12);
  const auto add = [&forms](Form form) {
    if (!form.IsZero()) forms.push_back(std::move(form));
  };
  for (int k = 0; k < 3; ++k) {
    const Form& n = pair.N(k);
    if (n.IsZero()) continue;
    const Form &p = pair.P(k), &q = pair.Q(k);
    for (const Form& form : {n, p, n - p, q, n - q}) add(form);
    return forms;
  }
  for (int k = 0; k < 3 && forms.empty(); ++k) {
    add(pair.P(k));
    if (forms.empty()) add(pair.Q(k));
  }
  if (!forms.empty()) return forms;
  for (int k = 0; k < 3; ++k) {
    for (const Form& form : pair.EndDifferences(k)) add(form);
  }
  return forms;
}

/// Contact at a time at which the pair is coplanar.
template <class Forms>
bool InContact(Forms& pair, Root& t) {
  for (int k = 0; k < 3; ++k) {
    const Form& n = pair.N(k);
    const int sign = t.SignOf(n);
    if (sign == 0) continue;
    const auto on_edge = [&](const Form& x) { return sign * t.SignOf(x) >= 0 && sign * t.SignOf(n - x) >= 0; };
    return on_edge(pair.P(k)) && on_edge(pair.Q(k));
  }
  for (int k = 0; k < 3; ++k) {
    if (t.SignOf(pair.P(k)) != 0 || t.SignOf(pair.Q(k)) != 0) return false;
  }
  for (int k = 0; k < 3; ++k) {
    int sum = 0;
    for (const Form& difference : pair.EndDifferences(k)) sum += t.SignOf(difference);
    if (sum == 4 || sum == -4) return false;
  }
  return true;
}

double Proportion(const Integer& numerator, const Integer& denominator) {
  return denominator.is_zero() ? 0 : std::clamp(Ratio(numerator, denominator), 0.0, 1.0);
}

/// u and v next to the time of contact.
template <class Forms>
EdgeCrossing Describe(Forms& pair, const Root& root) {
  EdgeCrossing crossing{root.t(), 0, 0};
  for (int i = 0; i < 3; ++i) {  // most are plain enough for doubles
    const Form &n_form = pair.N(i), &p_form = pair.P(i), &q_form = pair.Q(i);
    if (!n_form.FitsDoubles() || !p_form.FitsDoubles() || !q_form.FitsDoubles()) continue;
    const BoundedQuadratic n = ToBoundedQuadratic(n_form), p = ToBoundedQuadratic(p_form),
                           q = ToBoundedQuadratic(q_form);
    const double n_t = n.Polar(crossing.t, crossing.t);
    constexpr double kAccuracy = 0x1p-32;
    if (std::max({n.error, p.error, q.error}) > kAccuracy * std::abs(n_t)) continue;
    crossing.u = std::clamp(p.Polar(crossing.t, crossing.t) / n_t, 0.0, 1.0);
    crossing.v = std::clamp(q.Polar(crossing.t, crossing.t) / n_t, 0.0, 1.0);
    return crossing;
  }
  const Point& at = root.near();
  int k = 0;
  Integer n = 0;
  for (int i = 0; i < 3; ++i) {
    const Integer n_i = pair.N(i).At(at);
    if (abs(n_i) > abs(n)) n = n_i, k = i;
  }
  if (!n.is_zero()) {
    crossing.u = Proportion(pair.P(k).At(at), n);
    crossing.v = Proportion(pair.Q(k).At(at), n);
    return crossing;
  }
  // Parallel: the first common point along the axis along which the segments are longest.
  Integer a = 0, b = 0, c = 0;
  for (int i = 0; i < 3; ++i) {
    const Integer a_i = pair.A(i).At(at), b_i = pair.B(i).At(at);
    if (std::max(abs(a_i), abs(b_i)) > std::max(abs(a), abs(b))) a = a_i, b = b_i, c = pair.C(i).At(at);
  }
  // In coordinates from A0: a covers [0, a], b covers [c, c + b].
  const Integer first = std::max(std::min(Integer(0), a), std::min(c, Integer(c + b)));
  crossing.u = Proportion(first, a);
  crossing.v = Proportion(first - c, b);
  return crossing;
}

}  // namespace

template <class Polynomials>
std::optional<EdgeCrossing> DecideCrossing(const Polynomials& polynomials) {
  PairForms<Polynomials> pair(polynomials);
  const Form f = pair.F();
  if (f.c[0].is_zero()) {
    Root start = Root::Rational({0, 1});
    if (InContact(pair, start)) return Describe(pair, start);
  }
  std::vector<Root> candidates;
  std::vector<Form> switches;  // outlives its roots
  if (f.IsZero()) {
    switches = Switches(pair);
    candidates.reserve(2 * switches.size() + 1);
    for (const Form& form : switches) {
      for (Root& root : RootsInside(form)) candidates.push_back(std::move(root));
    }
    for (Root& root : candidates) root.Locate();
    std::sort(candidates.begin(), candidates.end(), [](const Root& x, const Root& y) { return x.t() < y.t(); });
  } else {
    candidates = RootsInside(f);
  }
  if (f.c[3].is_zero()) candidates.push_back(Root::Rational({1, 0}));
  for (Root& candidate : candidates) {
    if (InContact(pair, candidate)) return Describe(pair, candidate);
  }
  return std::nullopt;
}

template std::optional<EdgeCrossing> DecideCrossing(const FixedPair::Polynomials& pair);

std::optional<EdgeCrossing> DecideCrossing(const MovingSegment& a, const MovingSegment& b) {
  using Polynomials = PairPolynomials<Integer, Integer, Integer>;
  const IntegerCoordinates coordinates(a, b);
  Polynomials::Ends ends;
  for (int i = 0; i < 24; ++i) ends[i / 3][i % 3] = Integer(coordinates.mantissa[i]) << coordinates.shift[i];
  return DecideCrossing(Polynomials(ends));
}

}  // namespace meshless_cutting::exact
