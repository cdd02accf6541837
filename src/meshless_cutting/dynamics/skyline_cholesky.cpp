#include "dynamics/skyline_cholesky.h"

#include <algorithm>
#include <cmath>

#include "dynamics/instruction_sets.h"

namespace meshless_cutting {
namespace {

/// Sums that run side by side: the same whatever the width of the registers.
constexpr int kSums = 16;

MESHLESS_CUTTING_CLONES double DotOf(const double* a, const double* b, int count) {
  double sums[kSums] = {};
  int i = 0;
  for (; i + kSums <= count; i += kSums) {
    for (int l = 0; l < kSums; ++l) sums[l] += a[i + l] * b[i + l];
  }
  double sum = 0;
  for (int l = 0; l < kSums; ++l) sum += sums[l];
  for (; i < count; ++i) sum += a[i] * b[i];
  return sum;
}

MESHLESS_CUTTING_CLONES void Subtract(double factor, const double* from, int count, double* to) {
  for (int i = 0; i < count; ++i) to[i] -= factor * from[i];
}

}  // namespace

void SkylineCholesky::Reset(const std::vector<int>& first) {
  first_ = first;
  row_.resize(first.size());
  std::size_t total = 0;
  for (int i = 0; i < size(); ++i) {
    row_[i] = total;
    total += i - first[i] + 1;
  }
  entries_.assign(total, 0);
  inverse_diagonal_.resize(first.size());
}

void SkylineCholesky::Factor() {
  for (int i = 0; i < size(); ++i) {
    double* row = &entries_[row_[i]];
    const int begin = first_[i];
    for (int j = begin; j < i; ++j) {
      const int from = std::max(begin, first_[j]);
      const double* other = &entries_[row_[j]] + (from - first_[j]);
      row[j - begin] = (row[j - begin] - DotOf(row + (from - begin), other, j - from)) * inverse_diagonal_[j];
    }
    const double diagonal = row[i - begin], pivot = diagonal - DotOf(row, row, i - begin);
    if (pivot > 1e-12 * diagonal) {
      row[i - begin] = std::sqrt(pivot);
      inverse_diagonal_[i] = 1 / row[i - begin];
    } else {
      std::fill(row, row + (i - begin), 0.0);
      row[i - begin] = inverse_diagonal_[i] = 0;
    }
  }
}

void SkylineCholesky::Solve(double* x) const {
  for (int i = 0; i < size(); ++i) {
    const double* row = &entries_[row_[i]];
    x[i] = (x[i] - DotOf(row, x + first_[i], i - first_[i])) * inverse_diagonal_[i];
  }
  for (int i = size() - 1; i >= 0; --i) {
    x[i] *= inverse_diagonal_[i];
    Subtract(x[i], &entries_[row_[i]], i - first_[i], x + first_[i]);
  }
}

}  // namespace meshless_cutting
