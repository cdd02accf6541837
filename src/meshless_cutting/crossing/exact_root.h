// Real roots of integer forms in (0, 1) and exact signs of other forms there.
#pragma once

#include <vector>

#include "crossing/exact_form.h"

namespace meshless_cutting::exact {

/// The number at / 2^bits.
struct Dyadic {
  Integer at;
  int bits;
};

/// A root of a form, without multiplicity: a rational number, or the only root of the form on a bracket.
class Root {
 public:
  /// The rational number T : W.
  static Root Rational(Point point);
  /// The only root of `form` between lo / 2^bits and hi / 2^bits; it is simple. The form stays where it is: it is
  /// referred to.
  static Root Bracketed(const Form& form, Integer lo, Integer hi, int bits);

  /// Exact sign of g here. Locates the root.
  int SignOf(const Form& g);
  /// Shrinks the bracket to what follows; for the roots that are looked at.
  void Locate();

  // Once located:
  /// A point next to the root.
  const Point& near() const { return near_; }
  /// t, with a relative error below 2^-32.
  double t() const { return t_; }

  // Of a bracketed root:
  /// Its bracket shrinks, at least to a half.
  void Refine();
  /// A point in the bracket, not at its ends.
  Dyadic NearDyadic() const { return {lo_ + hi_, bits_ + 1}; }

 private:
  Root() = default;
  /// The point numerator / 2^bits_.
  Point At(const Integer& numerator) const;
  void SetRational(Point point);
  void StartByDoubles();
  bool RefineByDoubles();
  void Halve();
  /// The sign of g on the bracket if it is the same everywhere, else 0.
  int SignOnBracket(const Form& g) const;
  /// Whether the bracketed root is a root of g, whose coefficients are of both signs.
  bool IsRootOf(const Form& g) const;

  const Form* form_ = nullptr;  // null: rational, at near_
  int sign_lo_ = 0;             // of form_ on (lo, root)
  Integer lo_, hi_;             // bracket, in units of 2^-bits_
  int bits_ = 0;
  bool located_ = false;  // whether what follows is set
  Point near_;
  double t_ = 0;
  double reach_ = 0;  // the root is within reach_ of t_
};

/// All different roots of f in the open (0, 1), in order of t; f is not zero, and outlives them.
std::vector<Root> RootsInside(const Form& f);

}  // namespace meshless_cutting::exact
