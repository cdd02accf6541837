#include "dynamics/coarse_point.h"

#include <cmath>

namespace meshless_cutting {
namespace {

constexpr int kFunctions = CoarseMatrix::kFunctions;

/// What an integration point sees of one aggregate's functions b_c: gradients, and what their fit by an affine field
/// needs.
struct Share {
  int aggregate;
  double gradient[kFunctions][3];         // sum_k b_c(k) dphi_k/dX
  double sum[kFunctions];                 // sum_k b_c(k)
  double fit[kFunctions][3];              // sum_k b_c(k) fit_k
  double offset[kFunctions][3];           // sum_k b_c(k) offset_k
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

}  // namespace

void AddCoarseOfPoint(const PointKernels& kernels, const KernelArguments& arguments, const PointPlace& place,
                      double factor, int row, CoarseMatrix& matrix) {
  constexpr int kMost = 16;  // aggregates per point; particles of further ones are left to the fine level
  const PointGroup& group = *arguments.group;
  const Aggregates& aggregates = matrix.aggregates();
  Share shares[kMost];
  int count = 0;
  for (int k = 0; k < group.support; ++k) {
    const int j = group.particle[(static_cast<std::size_t>(place.batch) * group.support + k) * kLanes + place.lane];
    const int a = aggregates.of_particle[j];
    if (a < 0 || a > row) continue;  // the matrix is symmetric
    int n = 0;
    while (n < count && shares[n].aggregate != a) ++n;
    if (n == kMost) continue;
    if (n == count) {
      shares[count++] = Share();
      shares[n].aggregate = a;
    }
    double gradient[3], fit[3], offset[3];
    PointRow(group, place.batch, place.lane, k, gradient, fit, offset);
    const double* b = &aggregates.basis[j].x;
    for (int c = 0; c < kFunctions; ++c) {
      shares[n].sum[c] += b[c];
      for (int i = 0; i < 3; ++i) {
        shares[n].gradient[c][i] += b[c] * gradient[i];
        shares[n].fit[c][i] += b[c] * fit[i];
        shares[n].offset[c][i] += b[c] * offset[i];
      }
      for (int d = 0; d < kFunctions; ++d) shares[n].square[c][d] += b[c] * b[d];
    }
  }

  const double stiffness = group.stabilisation[static_cast<std::size_t>(place.batch) * kLanes + place.lane];
  double blocks[kFunctions * kFunctions * 9];
  for (int m = 0; m < count; ++m) {
    if (shares[m].aggregate != row) continue;
    for (int n = 0; n < count; ++n) {
      const Share &a = shares[m], &b = shares[n];
      kernels.blocks(arguments, place.batch, place.lane, kFunctions, a.gradient[0], kFunctions, b.gradient[0], blocks);
      for (int c = 0; c < kFunctions; ++c) {
        for (int d = 0; d < (m == n ? c + 1 : kFunctions); ++d) {
          double* block = blocks + (c * kFunctions + d) * 9;
          const double fitted = a.sum[c] * b.sum[d] / group.support + a.offset[c][0] * b.fit[d][0] +
                                a.offset[c][1] * b.fit[d][1] + a.offset[c][2] * b.fit[d][2];
          const double left = stiffness * ((m == n ? a.square[c][d] : 0) - fitted);
          for (int i = 0; i < 9; i += 4) block[i] += left;
          for (int i = 0; i < 9; ++i) block[i] *= factor;
          matrix.Add(a.aggregate, c, b.aggregate, d, block);
        }
      }
    }
  }
}

}  // namespace meshless_cutting
