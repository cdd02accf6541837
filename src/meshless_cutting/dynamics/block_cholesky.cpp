#include "dynamics/block_cholesky.h"

#include <algorithm>
#include <cmath>

#include "dynamics/instruction_sets.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are passed between inlined functions of this file alone

namespace meshless_cutting {
namespace {

constexpr int kBlock = BlockCholesky::kBlock;
constexpr int kSquare = kBlock * kBlock;

/// One column of a block, and a third of one, as the compiler's vector types.
typedef double Third __attribute__((vector_size(32)));
typedef long long ThirdOrder __attribute__((vector_size(32)));
struct Column {
  Third part[3];
};

[[gnu::always_inline]] inline Third LoadThird(const double* from) {
  Third third;
  __builtin_memcpy(&third, from, sizeof(third));
  return third;
}
[[gnu::always_inline]] inline Column Load(const double* from) {
  return {{LoadThird(from), LoadThird(from + 4), LoadThird(from + 8)}};
}
[[gnu::always_inline]] inline void Store(const Column& column, double* to) { __builtin_memcpy(to, &column, sizeof(column)); }

/// to -= A B^T for blocks A, B of `columns` columns.
MESHLESS_CUTTING_CLONES void SubtractProduct(const double* A, const double* B, int columns, double* to) {
  for (int c = 0; c < kBlock; c += 4) {  // four columns of the result: twelve registers
    Column sum[4];
    for (int d = 0; d < 4; ++d) sum[d] = Load(to + (c + d) * kBlock);
    for (int k = 0; k < columns; ++k) {
      const Column a = Load(A + k * kBlock);
      for (int d = 0; d < 4; ++d) {
        const double b = B[k * kBlock + c + d];
        for (int i = 0; i < 3; ++i) sum[d].part[i] -= b * a.part[i];
      }
    }
    for (int d = 0; d < 4; ++d) Store(sum[d], to + (c + d) * kBlock);
  }
}

/// to = A B^T, `to` being none of them.
MESHLESS_CUTTING_CLONES void Multiply(const double* A, const double* B, double* to) {
  for (int c = 0; c < kBlock; ++c) {
    Column sum = {};
    for (int k = 0; k < kBlock; ++k) {
      const Column a = Load(A + k * kBlock);
      for (int i = 0; i < 3; ++i) sum.part[i] += B[k * kBlock + c] * a.part[i];
    }
    Store(sum, to + c * kBlock);
  }
}

/// A column of a block in single precision.
typedef float Four __attribute__((vector_size(16)));
typedef int FourOrder __attribute__((vector_size(16)));
struct SingleColumn {
  Four part[3];
};
[[gnu::always_inline]] inline SingleColumn Load(const float* from) {
  SingleColumn column;
  __builtin_memcpy(&column, from, sizeof(column));
  return column;
}

/// to -= A x, A of `columns` columns, a multiple of four.
MESHLESS_CUTTING_CLONES void SubtractForward(const float* A, const float* x, int columns, float* to) {
  SingleColumn sum[4] = {};
  for (int c = 0; c < columns; c += 4) {
    for (int d = 0; d < 4; ++d) {
      const SingleColumn a = Load(A + (c + d) * kBlock);
      for (int i = 0; i < 3; ++i) sum[d].part[i] += x[c + d] * a.part[i];
    }
  }
  SingleColumn result = Load(to);
  for (int i = 0; i < 3; ++i) {
    result.part[i] -= (sum[0].part[i] + sum[1].part[i]) + (sum[2].part[i] + sum[3].part[i]);
  }
  __builtin_memcpy(to, &result, sizeof(result));
}

/// to -= A^T x, likewise.
MESHLESS_CUTTING_CLONES void SubtractBackward(const float* A, const float* x, int columns, float* to) {
  const SingleColumn v = Load(x);
  for (int c = 0; c < columns; c += 4) {
    Four sum[4];
    for (int d = 0; d < 4; ++d) {
      const SingleColumn a = Load(A + (c + d) * kBlock);
      sum[d] = a.part[0] * v.part[0] + a.part[1] * v.part[1] + a.part[2] * v.part[2];
    }
    const FourOrder even = {0, 2, 4, 6}, odd = {1, 3, 5, 7};
    const Four ab = __builtin_shuffle(sum[0], sum[1], even) + __builtin_shuffle(sum[0], sum[1], odd);
    const Four cd = __builtin_shuffle(sum[2], sum[3], even) + __builtin_shuffle(sum[2], sum[3], odd);
    const Four total = __builtin_shuffle(ab, cd, even) + __builtin_shuffle(ab, cd, odd);
    Four result;
    __builtin_memcpy(&result, to + c, sizeof(result));
    result -= total;
    __builtin_memcpy(to + c, &result, sizeof(result));
  }
}

}  // namespace

void BlockCholesky::Reset(const std::vector<int>& first) {
  first_ = first;
  begin_.resize(first.size());
  std::size_t total = 0;
  for (std::size_t a = 0; a < first.size(); ++a) {
    begin_[a] = total;
    total += (a - first[a] + 1) * kSquare;
  }
  entries_.assign(total, 0);
  inverse_.resize(first.size() * kSquare);
  single_entries_.resize(total);
  single_inverse_.resize(inverse_.size());
}

void BlockCholesky::Factor() {
  for (int a = 0; a < static_cast<int>(first_.size()); ++a) {
    double* row = &entries_[begin_[a]];
    for (int b = first_[a]; b <= a; ++b) {
      const int from = std::max(first_[a], first_[b]);
      double* block = row + static_cast<std::size_t>(b - first_[a]) * kSquare;
      SubtractProduct(row + static_cast<std::size_t>(from - first_[a]) * kSquare,
                      &entries_[begin_[b]] + static_cast<std::size_t>(from - first_[b]) * kSquare,
                      kBlock * (b - from), block);
      if (b == a) break;
      double product[kSquare];
      Multiply(block, &inverse_[static_cast<std::size_t>(b) * kSquare], product);
      std::copy(product, product + kSquare, block);
    }
    FactorDiagonal(a);
  }
  const auto round = [](double entry) { return static_cast<float>(entry); };
  std::transform(entries_.begin(), entries_.end(), single_entries_.begin(), round);
  std::transform(inverse_.begin(), inverse_.end(), single_inverse_.begin(), round);
}

void BlockCholesky::FactorDiagonal(int a) {
  const int left = kBlock * (a - first_[a]);  // columns before the block
  double* row = &entries_[begin_[a]];
  double* L = row + static_cast<std::size_t>(left) * kBlock;
  double* inverse = &inverse_[static_cast<std::size_t>(a) * kSquare];
  std::fill(inverse, inverse + kSquare, 0.0);
  for (int i = 0; i < kBlock; ++i) {
    double before = 0;  // what the columns before this block have taken from the diagonal
    for (int k = 0; k < left; ++k) before += row[k * kBlock + i] * row[k * kBlock + i];
    const double diagonal = L[i * kBlock + i] + before;
    double pivot = L[i * kBlock + i];
    for (int j = 0; j < i; ++j) {
      double entry = L[j * kBlock + i];
      for (int k = 0; k < j; ++k) entry -= L[k * kBlock + i] * L[k * kBlock + j];
      L[j * kBlock + i] = entry * inverse[j * kBlock + j];
      pivot -= L[j * kBlock + i] * L[j * kBlock + i];
    }
    for (int j = i + 1; j < kBlock; ++j) L[j * kBlock + i] = 0;
    if (!(pivot > 1e-12 * diagonal)) {
      for (int k = 0; k < left + kBlock; ++k) row[k * kBlock + i] = 0;
      continue;
    }
    L[i * kBlock + i] = std::sqrt(pivot);
    inverse[i * kBlock + i] = 1 / L[i * kBlock + i];
    for (int j = 0; j < i; ++j) {
      double sum = 0;
      for (int k = j; k < i; ++k) sum += L[k * kBlock + i] * inverse[j * kBlock + k];
      inverse[j * kBlock + i] = -sum * inverse[i * kBlock + i];
    }
  }
}

void BlockCholesky::Solve(float* x) const {
  const int blocks = static_cast<int>(first_.size());
  for (int a = 0; a < blocks; ++a) {
    float rest[kBlock], *here = x + kBlock * a;
    SubtractForward(&single_entries_[begin_[a]], x + kBlock * first_[a], kBlock * (a - first_[a]), here);
    std::copy(here, here + kBlock, rest);
    std::fill(here, here + kBlock, 0.0F);
    SubtractForward(&single_inverse_[static_cast<std::size_t>(a) * kSquare], rest, kBlock, here);
    for (int i = 0; i < kBlock; ++i) here[i] = -here[i];
  }
  for (int a = blocks - 1; a >= 0; --a) {
    float rest[kBlock], *here = x + kBlock * a;
    std::copy(here, here + kBlock, rest);
    std::fill(here, here + kBlock, 0.0F);
    SubtractBackward(&single_inverse_[static_cast<std::size_t>(a) * kSquare], rest, kBlock, here);
    for (int i = 0; i < kBlock; ++i) here[i] = -here[i];
    SubtractBackward(&single_entries_[begin_[a]], here, kBlock * (a - first_[a]), x + kBlock * first_[a]);
  }
}

}  // namespace meshless_cutting
