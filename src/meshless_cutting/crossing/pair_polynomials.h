// The polynomials of a pair of moving segments with exact coefficients, for any kind of integer. Notation:
// crossing_filter.h.
#pragma once

#include <array>

namespace meshless_cutting {

/// Coordinates are integers; Product holds sums of products of two of them, Coefficient of three.
template <class Coordinate, class Product, class Coefficient>
struct PairPolynomials {
  using Vector = std::array<std::array<Coordinate, 3>, 2>;  // at t = 0 and t = 1
  using Quadratic = std::array<Product, 3>;                 // Bernstein coefficients times 1, 2, 1
  using Cubic = std::array<Coefficient, 4>;                 // Bernstein coefficients times 1, 3, 3, 1
  using Ends = std::array<std::array<Coordinate, 3>, 8>;    // A0, A1, B0, B1 at t = 0, then at t = 1

  Vector a, b, c;
  std::array<Quadratic, 3> n;  // components
  Quadratic P(int k) const { return Cross(c, b, k); }
  Quadratic Q(int k) const { return Cross(c, a, k); }
  Product PAtEnd(int end, int k) const { return CrossAtEnd(c, b, end, k); }
  Product QAtEnd(int end, int k) const { return CrossAtEnd(c, a, end, k); }

  explicit PairPolynomials(const Ends& ends) {
    for (int t = 0; t < 2; ++t) {
      for (int k = 0; k < 3; ++k) {
        a[t][k] = ends[4 * t + 1][k] - ends[4 * t][k];
        b[t][k] = ends[4 * t + 3][k] - ends[4 * t + 2][k];
        c[t][k] = ends[4 * t + 2][k] - ends[4 * t][k];
      }
    }
    for (int k = 0; k < 3; ++k) n[k] = Cross(a, b, k);
  }

  Cubic Coplanarity() const {
    Cubic f;
    for (int k = 0; k < 3; ++k) {
      f[0] = f[0] + n[k][0] * c[0][k];
      f[1] = f[1] + n[k][0] * c[1][k] + n[k][1] * c[0][k];
      f[2] = f[2] + n[k][1] * c[1][k] + n[k][2] * c[0][k];
      f[3] = f[3] + n[k][2] * c[1][k];
    }
    return f;
  }

 private:
  static Quadratic Cross(const Vector& x, const Vector& y, int k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    return {CrossAtEnd(x, y, 0, k), (x[0][i] * y[1][j] - x[0][j] * y[1][i]) + (x[1][i] * y[0][j] - x[1][j] * y[0][i]),
            CrossAtEnd(x, y, 1, k)};
  }
  static Product CrossAtEnd(const Vector& x, const Vector& y, int end, int k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    return x[end][i] * y[end][j] - x[end][j] * y[end][i];
  }
};

}  // namespace meshless_cutting
