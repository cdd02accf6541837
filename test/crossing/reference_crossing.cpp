#include "crossing/reference_crossing.h"

#include <algorithm>
#include <array>
#include <functional>

#include "crossing/rational_polynomial.h"

namespace meshless_cutting::test {
namespace {

using Vector = std::array<Polynomial, 3>;
using SignOf = std::function<int(const Polynomial&)>;

Vector Path(const Eigen::Vector3d& x0, const Eigen::Vector3d& x1) {
  Vector path;
  for (int k = 0; k < 3; ++k) path[k] = Polynomial::Linear(Rational(x0[k]), Rational(x1[k]));
  return path;
}
Vector operator-(const Vector& x, const Vector& y) { return {x[0] - y[0], x[1] - y[1], x[2] - y[2]}; }
Polynomial Dot(const Vector& x, const Vector& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }
Vector Cross(const Vector& x, const Vector& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}

/// Everything that decides contact at one time; all of it is compared with 0.
struct Conditions {
  Polynomial coplanar;                                                    // det(a, b, c)
  Polynomial nn, u_nn, rest_u_nn, v_nn, rest_v_nn;                        // for lines that meet in a point
  Polynomial aa, a_offset, b0_on_a, b1_on_a, rest_b0_on_a, rest_b1_on_a;  // for parallels, a not a point
  Polynomial bb, b_offset, a0_on_b, rest_a0_on_b;                         // a is a point
  Polynomial cc;                                                          // both are

  Conditions(const MovingSegment& s, const MovingSegment& r) {
    const Vector A0 = Path(s.p_t0, s.p_t1), B0 = Path(r.p_t0, r.p_t1);
    const Vector a = Path(s.q_t0, s.q_t1) - A0, b = Path(r.q_t0, r.q_t1) - B0, c = B0 - A0;
    const Vector n = Cross(a, b), c_a = Cross(c, a), c_b = Cross(c, b);
    const Polynomial zero, ca = Dot(c, a), cb = Dot(c, b);
    coplanar = Dot(n, c);
    nn = Dot(n, n), u_nn = Dot(c_b, n), v_nn = Dot(c_a, n);
    rest_u_nn = nn - u_nn, rest_v_nn = nn - v_nn;
    aa = Dot(a, a), a_offset = Dot(c_a, c_a), b0_on_a = ca, b1_on_a = ca + Dot(a, b);
    rest_b0_on_a = aa - b0_on_a, rest_b1_on_a = aa - b1_on_a;
    bb = Dot(b, b), b_offset = Dot(c_b, c_b), a0_on_b = zero - cb, rest_a0_on_b = bb - a0_on_b;
    cc = Dot(c, c);
  }

  bool Contact(const SignOf& sign) const {
    if (sign(coplanar) != 0) return false;
    if (sign(nn) != 0) return sign(u_nn) >= 0 && sign(rest_u_nn) >= 0 && sign(v_nn) >= 0 && sign(rest_v_nn) >= 0;
    if (sign(aa) != 0) {
      return sign(a_offset) == 0 && (sign(b0_on_a) >= 0 || sign(b1_on_a) >= 0) &&
             (sign(rest_b0_on_a) >= 0 || sign(rest_b1_on_a) >= 0);
    }
    if (sign(bb) != 0) return sign(b_offset) == 0 && sign(a0_on_b) >= 0 && sign(rest_a0_on_b) >= 0;
    return sign(cc) == 0;
  }

  /// Polynomials among whose roots (and t = 0) is the first contact.
  std::vector<Polynomial> Candidates() const {
    if (!coplanar.IsZero()) return {coplanar};
    std::vector<Polynomial> all = {nn,      u_nn,         rest_u_nn,    v_nn, rest_v_nn, aa,      a_offset,     b0_on_a,
                                   b1_on_a, rest_b0_on_a, rest_b1_on_a, bb,   b_offset,  a0_on_b, rest_a0_on_b, cc};
    all.erase(std::remove_if(all.begin(), all.end(), [](const Polynomial& p) { return p.IsZero(); }), all.end());
    return all;
  }
};

class Search {
 public:
  explicit Search(const Conditions& conditions) : conditions_(conditions) {}

  std::optional<double> First() {
    AtRational(0);
    AtRational(1);
    for (const Polynomial& candidate : conditions_.Candidates()) {
      InRange(candidate.WithoutRoot(0).WithoutRoot(1), 0, 1);
    }
    return first_;
  }

 private:
  void Note(const Rational& t) {
    const double x = t.convert_to<double>();
    if (!first_ || x < *first_) first_ = x;
  }
  void AtRational(const Rational& t) {
    if (conditions_.Contact([&t](const Polynomial& p) { return p.At(t).sign(); })) Note(t);
  }
  /// Contact at the roots of f in (lo, hi); neither end is a root.
  void InRange(const Polynomial& f, Rational lo, Rational hi) {
    if (f.degree() < 1) return;
    const SturmSequence counter(f, Polynomial({1}));
    const int roots = counter.Sum(lo, hi);
    if (roots == 0) return;
    if (roots == 1) {
      const auto sign = [&](const Polynomial& p) { return SturmSequence(f, p).Sum(lo, hi); };
      if (!conditions_.Contact(sign)) return;
    }
    const Rational middle = (lo + hi) / 2;
    if (f.At(middle) == 0) {
      AtRational(middle);
      return InRange(f.WithoutRoot(middle), lo, hi);
    }
    if (roots == 1) {  // contact is known: only the time is wanted
      const Rational accuracy = Rational(1, boost::multiprecision::cpp_int(1) << 50);
      while (hi - lo >= accuracy * lo) {
        const Rational half = (lo + hi) / 2;
        if (f.At(half) == 0) return Note(half);
        (counter.Sum(lo, half) == 1 ? hi : lo) = half;
      }
      return Note((lo + hi) / 2);
    }
    InRange(f, lo, middle);
    InRange(f, middle, hi);
  }

  const Conditions& conditions_;
  std::optional<double> first_;
};

}  // namespace

std::optional<double> ReferenceFirstContact(const MovingSegment& a, const MovingSegment& b) {
  const Conditions conditions(a, b);
  return Search(conditions).First();
}

}  // namespace meshless_cutting::test
