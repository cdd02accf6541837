// The tangent as the coarse space of affine fields per aggregate sees it.
#pragma once

#include <vector>

#include "dynamics/aggregates.h"
#include "dynamics/block_cholesky.h"

namespace meshless_cutting {

/// Unknown 12 a + 3 c + i is component i of function c of aggregate a. Two aggregates are coupled when an integration
/// point has particles of both; the rows of different aggregates may be filled by different threads.
class CoarseMatrix {
 public:
  static constexpr int kFunctions = 4;
  static constexpr int kUnknowns = BlockCholesky::kBlock;  // per aggregate

  const Aggregates& aggregates() const { return aggregates_; }
  int size() const { return kUnknowns * aggregates_.count(); }

  /// Aggregates, their coupling, and shape of the matrix. Allocates only to grow.
  void Build(const Tissue& tissue, const std::vector<double>& free, int wanted_aggregates);

  /// After a cut: the same aggregates with the new particles, and the matrix that was factored before. Add no more to
  /// it.
  void Extend(const Tissue& tissue, const std::vector<double>& free) { aggregates_.Extend(tissue, free); }

  void Clear() { factor_.Reset(first_); }

  /// The points that have particles of aggregate a: points()[points_begin(a)] ... points()[points_begin(a + 1) - 1]. Those before
  /// points_inside_end(a) have no others.
  const std::vector<int>& points() const { return points_; }
  int points_begin(int a) const { return points_begin_[a]; }
  int points_inside_end(int a) const { return points_inside_end_[a]; }

  /// The first aggregate that a is coupled to, <= a.
  int first_coupled(int a) const { return first_[a]; }

  /// Adds the 3 x 3 block (row by row) between function c of a and function d of b, b <= a, first_coupled(a) <= b. Of
  /// the blocks on the diagonal the part above it is ignored.
  void Add(int a, int c, int b, int d, const double* block);
  /// The same for all functions, blocks[c][3 i + j][d], times `factor`.
  void AddAll(int a, int b, double factor, const double (*blocks)[9][kFunctions]);

  /// Entry (i, j), j <= i, of two coupled aggregates, before Factor().
  double At(int i, int j) const { return factor_.At(i, j); }

  void Factor() { factor_.Factor(); }

  /// x := A^-1 x, after Factor().
  void Solve(float* x) const { factor_.Solve(x); }

 private:
  void ListPoints(const Tissue& tissue);

  Aggregates aggregates_;
  std::vector<int> first_;
  std::vector<int> points_, points_begin_, points_inside_end_;
  BlockCholesky factor_;
};

}  // namespace meshless_cutting
