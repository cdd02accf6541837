// Cholesky factor of a symmetric positive definite matrix of small dense blocks, whose block rows begin at their first.
#pragma once

#include <vector>

#include "dynamics/field.h"

namespace meshless_cutting {

/// Block row a holds the blocks of columns [first[a], a]. For matrices of some hundred rows that are solved with many
/// times, in the middle of a parallel solver: every microsecond in here is one that the other threads wait.
class BlockCholesky {
 public:
  static constexpr int kBlock = 12;

  /// Sets the shape and clears the entries. `first`: per block row, first[a] <= a.
  void Reset(const std::vector<int>& first);

  int size() const { return kBlock * static_cast<int>(first_.size()); }

  /// Entry (i, j) in a block that is held: blocks are stored column after column. Above the diagonal none is read.
  double& At(int i, int j) { return entries_[Index(i, j)]; }
  double At(int i, int j) const { return entries_[Index(i, j)]; }

  /// Replaces the entries by L, A = L L^T. A pivot below a millionth of a millionth of its diagonal is rounding: its row
  /// is taken out.
  void Factor();

  /// x := A^-1 x, in single precision: half as much to read.
  void Solve(float* x) const;

 private:
  std::size_t Index(int i, int j) const {
    const int a = i / kBlock;
    return begin_[a] + static_cast<std::size_t>(j - kBlock * first_[a]) * kBlock + i % kBlock;
  }
  void FactorDiagonal(int a);

  std::vector<int> first_;
  std::vector<std::size_t> begin_;  // of block row a in entries_
  // Per block row, column after column: kBlock numbers, one of each row. The last kBlock columns are the diagonal block.
  AlignedVector<double> entries_;
  AlignedVector<double> inverse_;  // inverses of the factors' diagonal blocks, column after column
  AlignedVector<float> single_entries_, single_inverse_;  // what Solve reads
};

}  // namespace meshless_cutting
