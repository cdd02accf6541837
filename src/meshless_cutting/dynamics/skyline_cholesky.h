// Cholesky factor of a symmetric positive definite matrix whose rows begin at their first entry.
#pragma once

#include <vector>

#include "dynamics/field.h"

namespace meshless_cutting {

/// Row i holds columns [first[i], i], contiguous. For matrices of some hundred rows.
class SkylineCholesky {
 public:
  /// Sets the shape and clears the entries. first[i] <= i.
  void Reset(const std::vector<int>& first);

  int size() const { return static_cast<int>(first_.size()); }

  /// Entry (i, j), first[i] <= j <= i.
  double& At(int i, int j) { return entries_[row_[i] + (j - first_[i])]; }

  /// Replaces the entries by L, A = L L^T. A pivot below a millionth of a millionth of its diagonal is rounding: its row is taken out.
  void Factor();

  /// x := A^-1 x.
  void Solve(double* x) const;

 private:
  std::vector<int> first_;
  std::vector<std::size_t> row_;  // where row i begins
  AlignedVector<double> entries_;
  std::vector<double> inverse_diagonal_;
};

}  // namespace meshless_cutting
