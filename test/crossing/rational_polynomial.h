// Polynomials with rational coefficients, and Sturm sequences: slow and plain, to check the fast ones against.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <vector>

namespace meshless_cutting::test {

using Rational = boost::multiprecision::cpp_rational;

/// Coefficients in order of power, without leading zeros; empty is zero.
class Polynomial {
 public:
  Polynomial() = default;
  explicit Polynomial(std::vector<Rational> coefficients) : c_(std::move(coefficients)) { Trim(); }
  /// x0 at t = 0, x1 at t = 1.
  static Polynomial Linear(const Rational& x0, const Rational& x1) { return Polynomial({x0, x1 - x0}); }

  bool IsZero() const { return c_.empty(); }
  int degree() const { return static_cast<int>(c_.size()) - 1; }
  Rational At(const Rational& t) const {
    Rational value = 0;
    for (auto i = c_.rbegin(); i != c_.rend(); ++i) value = value * t + *i;
    return value;
  }
  Polynomial Derivative() const {
    std::vector<Rational> d;
    for (size_t i = 1; i < c_.size(); ++i) d.push_back(c_[i] * static_cast<int>(i));
    return Polynomial(d);
  }
  /// The remainder of the division by a polynomial that is not zero.
  Polynomial Remainder(const Polynomial& divisor) const {
    Polynomial r = *this;
    while (r.degree() >= divisor.degree()) {
      const Rational factor = r.c_.back() / divisor.c_.back();
      const int shift = r.degree() - divisor.degree();
      for (int i = 0; i <= divisor.degree(); ++i) r.c_[i + shift] -= factor * divisor.c_[i];
      r.Trim();
    }
    return r;
  }
  /// Divided by (t - root) as often as it goes.
  Polynomial WithoutRoot(const Rational& root) const {
    Polynomial p = *this;
    while (!p.IsZero() && p.At(root) == 0) {
      std::vector<Rational> quotient(p.c_.size() - 1);
      Rational carry = 0;
      for (int i = p.degree(); i > 0; --i) quotient[i - 1] = carry = p.c_[i] + carry * root;
      p = Polynomial(quotient);
    }
    return p;
  }

  friend Polynomial operator+(const Polynomial& x, const Polynomial& y) { return Combine(x, y, 1); }
  friend Polynomial operator-(const Polynomial& x, const Polynomial& y) { return Combine(x, y, -1); }
  friend Polynomial operator*(const Polynomial& x, const Polynomial& y) {
    if (x.IsZero() || y.IsZero()) return {};
    std::vector<Rational> c(x.c_.size() + y.c_.size() - 1);
    for (size_t i = 0; i < x.c_.size(); ++i) {
      for (size_t j = 0; j < y.c_.size(); ++j) c[i + j] += x.c_[i] * y.c_[j];
    }
    return Polynomial(c);
  }

 private:
  static Polynomial Combine(const Polynomial& x, const Polynomial& y, int sign) {
    std::vector<Rational> c = x.c_;
    c.resize(std::max(x.c_.size(), y.c_.size()));
    for (size_t i = 0; i < y.c_.size(); ++i) c[i] += sign * y.c_[i];
    return Polynomial(c);
  }
  void Trim() {
    while (!c_.empty() && c_.back() == 0) c_.pop_back();
  }
  std::vector<Rational> c_;
};

/// The Sturm-Tarski query: the sum of the signs of g at the different roots of f in (lo, hi), neither of which is a
/// root of f.
class SturmSequence {
 public:
  SturmSequence(const Polynomial& f, const Polynomial& g) {
    sequence_ = {f, f.Derivative() * g};
    while (!sequence_.back().IsZero()) {
      sequence_.push_back(Polynomial() - sequence_[sequence_.size() - 2].Remainder(sequence_.back()));
    }
  }
  int Sum(const Rational& lo, const Rational& hi) const { return Variations(lo) - Variations(hi); }

 private:
  int Variations(const Rational& t) const {
    int variations = 0, previous = 0;
    for (const Polynomial& p : sequence_) {
      const int sign = p.At(t).sign();
      if (sign * previous < 0) ++variations;
      if (sign != 0) previous = sign;
    }
    return variations;
  }
  std::vector<Polynomial> sequence_;
};

}  // namespace meshless_cutting::test
