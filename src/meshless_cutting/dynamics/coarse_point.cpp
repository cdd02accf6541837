#include "dynamics/coarse_point.h"

#include <algorithm>

#include "dynamics/instruction_sets.h"

namespace meshless_cutting {
namespace {

constexpr int kFunctions = CoarseMatrix::kFunctions;

/// What an integration point sees of one aggregate's functions b_c: gradients, and what their fit by an affine field
/// needs. The functions side by side, which the compiler packs.
struct Share {
  int aggregate;
  double sum[kFunctions];                 // sum_k b_c(k)
  double gradient[3][kFunctions];         // sum_k b_c(k) dphi_k/dX
  double fit[3][kFunctions];              // sum_k b_c(k) fit_k
  double offset[3][kFunctions];           // sum_k b_c(k) offset_k
  double square[kFunctions][kFunctions];  // sum_k b_c(k) b_d(k)
};

/// Gradient, row of the affine fit and rest offset of particle k of a point, whatever its shape. Fit and offset of a
/// box are scaled to unit offsets: only their product counts.
void PointRow(const PointGroup& group, int batch, int lane, int k, double* gradient, double* fit, double* offset) {
  const std::size_t b = batch;
  for (int i = 0; i < 3; ++i) {
    if (group.shape == SupportShape::kGeneral) {
      const std::size_t at = ((b * group.support + k) * 3 + i) * kLanes + lane;
      gradient[i] = group.gradient[at];
      fit[i] = group.fit[at];
      offset[i] = group.offset[at];
      continue;
    }
    offset[i] = k >> i & 1 ? 1 : -1;
    fit[i] = offset[i] / 8;
    gradient[i] = offset[i] * group.box[(b * 3 + i) * kLanes + lane];
    if (group.shape != SupportShape::kBox) continue;
    for (int n = 0; n < 4; ++n) {
      gradient[i] += Hadamard(kHourglassModes[n], k) * group.hourglass[(b * 12 + 3 * n + i) * kLanes + lane];
    }
  }
}

/// The shares of a point in aggregates up to `row`, since the matrix is symmetric; how many.
MESHLESS_CUTTING_CLONES int SharesOf(const PointGroup& group, const PointPlace& place, const Aggregates& aggregates, int row,
                                     int most, Share* shares) {
  int count = 0;
  for (int k = 0; k < group.support; ++k) {
    const int j = group.particle[(static_cast<std::size_t>(place.batch) * group.support + k) * kLanes + place.lane];
    const int a = aggregates.of_particle[j];
    if (a < 0 || a > row) continue;
    int n = 0;
    while (n < count && shares[n].aggregate != a) ++n;
    if (n == most) continue;
    if (n == count) {
      shares[count++] = Share();
      shares[n].aggregate = a;
    }
    Share& share = shares[n];
    double gradient[3], fit[3], offset[3];
    PointRow(group, place.batch, place.lane, k, gradient, fit, offset);
    double b[kFunctions];
    std::copy_n(&aggregates.basis[j].x, kFunctions, b);
    for (int c = 0; c < kFunctions; ++c) share.sum[c] += b[c];
    for (int i = 0; i < 3; ++i) {
      for (int c = 0; c < kFunctions; ++c) share.gradient[i][c] += b[c] * gradient[i];
      for (int c = 0; c < kFunctions; ++c) share.fit[i][c] += b[c] * fit[i];
      for (int c = 0; c < kFunctions; ++c) share.offset[i][c] += b[c] * offset[i];
    }
    for (int c = 0; c < kFunctions; ++c) {
      for (int d = 0; d < kFunctions; ++d) share.square[c][d] += b[c] * b[d];
    }
  }
  return count;
}

}  // namespace

void AddCoarseOfPoint(const PointKernels& kernels, const KernelArguments& arguments, const PointPlace& place,
                      double factor, int row, CoarseMatrix& matrix) {
  constexpr int kMost = 16;  // aggregates per point; particles of further ones are left to the fine level
  const PointGroup& group = *arguments.group;
  Share shares[kMost];
  const int count = SharesOf(group, place, matrix.aggregates(), row, kMost, shares);
  const Share* a = std::find_if(shares, shares + count, [&](const Share& share) { return share.aggregate == row; });
  if (a == shares + count) return;
  const double stiffness = group.stabilisation[static_cast<std::size_t>(place.batch) * kLanes + place.lane];
  double blocks[kFunctions][9][kFunctions];
  for (int n = 0; n < count; ++n) {
    const Share& b = shares[n];
    kernels.blocks(arguments, place, a->gradient, b.gradient, blocks);
    for (int c = 0; c < kFunctions; ++c) {
      for (int d = 0; d < kFunctions; ++d) {
        const double fitted = a->sum[c] * b.sum[d] / group.support + a->offset[0][c] * b.fit[0][d] +
                              a->offset[1][c] * b.fit[1][d] + a->offset[2][c] * b.fit[2][d];
        const double left = stiffness * ((&b == a ? a->square[c][d] : 0) - fitted);
        for (int i = 0; i < 9; i += 4) blocks[c][i][d] += left;
      }
    }
    matrix.AddAll(row, b.aggregate, factor, blocks);
  }
}

void AddCoarseOfTensor(const PointGroup& group, const PointPlace& place, const double (*tensor)[9], double factor, int row,
                       CoarseMatrix& matrix) {
  Share share;
  SharesOf(group, place, matrix.aggregates(), row, 1, &share);
  double blocks[kFunctions][9][kFunctions] = {};
  for (int c = 0; c < kFunctions; ++c) {
    for (int n = 0; n < 9; ++n) {
      for (int i = 0; i < 9; ++i) {
        for (int d = 0; d < kFunctions; ++d) {
          blocks[c][i][d] += share.gradient[n / 3][c] * tensor[n][i] * share.gradient[n % 3][d];
        }
      }
    }
  }
  matrix.AddAll(row, row, factor, blocks);
}

}  // namespace meshless_cutting
