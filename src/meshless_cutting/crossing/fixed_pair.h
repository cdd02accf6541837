// The polynomials of a pair of moving segments with exact coefficients, which are then rounded once. Notation:
// crossing_filter.h. It decides what double arithmetic loses by cancellation, and everything at t = 0 and t = 1.
#pragma once

#include <optional>

#include "crossing/crossing_filter.h"
#include "crossing/fixed_integer.h"
#include "crossing/integer_coordinates.h"
#include "crossing/pair_polynomials.h"

namespace meshless_cutting {

class FixedPair {
 public:
  /// Coordinates must be multiples of a power of two and below 2^119 of it.
  static constexpr int kCoordinateBits = 119;
  using Coordinate = FixedInteger<1>;   // differences: < 2^120
  using Product = FixedInteger<2>;      // sums of four products: < 2^242
  using Coefficient = FixedInteger<3>;  // sums of twelve products of three: < 2^365
  using Polynomials = PairPolynomials<Coordinate, Product, Coefficient>;

  /// coordinates.bits <= kCoordinateBits
  explicit FixedPair(const IntegerCoordinates& coordinates);

  /// Exact where it answers.
  Verdict FirstCrossing(EdgeCrossing& crossing) const;

  const Polynomials& polynomials() const { return pair_; }

  // For the filter; what is asked for first is kept.
  BoundedQuadratic N(int k) const { return Bounded(pair_.n[k]); }
  const EndSides& EndsOfA(int k) const {
    if (!ends_of_a_[k]) ends_of_a_[k] = Sides(pair_.P(k), k);
    return *ends_of_a_[k];
  }
  const EndSides& EndsOfB(int k) const {
    if (!ends_of_b_[k]) ends_of_b_[k] = Sides(pair_.Q(k), k);
    return *ends_of_b_[k];
  }

 private:
  using Quadratic = Polynomials::Quadratic;

  EndSides Sides(const Quadratic& first, int k) const;
  static BoundedQuadratic Bounded(const Quadratic& x);
  /// Decides contact at t = 0 or t = 1 of a pair that is coplanar then.
  bool ContactAtEnd(int end, EdgeCrossing& crossing) const;
  bool ContactOfParallel(int end, EdgeCrossing& crossing) const;

  Polynomials pair_;
  mutable std::array<std::optional<EndSides>, 3> ends_of_a_, ends_of_b_;
};

}  // namespace meshless_cutting
