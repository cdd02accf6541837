#include "dynamics/coarse_matrix.h"

#include <algorithm>

namespace meshless_cutting {

void CoarseMatrix::TissueChanged(const Tissue& tissue, const std::vector<double>& free, int wanted_aggregates) {
  aggregates_.Build(tissue, free, wanted_aggregates);
  first_.resize(aggregates_.count());
  for (int a = 0; a < aggregates_.count(); ++a) first_[a] = a;
  const std::size_t K = tissue.support_size;
  for (std::size_t begin = 0; begin < tissue.point_particles.size(); begin += K) {
    int lowest = aggregates_.count();
    for (std::size_t k = begin; k < begin + K; ++k) {
      const int a = aggregates_.of_particle[tissue.point_particles[k]];
      if (a >= 0) lowest = std::min(lowest, a);
    }
    for (std::size_t k = begin; k < begin + K; ++k) {
      const int a = aggregates_.of_particle[tissue.point_particles[k]];
      if (a >= 0) first_[a] = std::min(first_[a], lowest);
    }
  }
  first_unknown_.resize(size());
  for (int i = 0; i < size(); ++i) first_unknown_[i] = kUnknowns * first_[i / kUnknowns];
  Clear();
}

void CoarseMatrix::Add(int a, int c, int b, int d, const double* block) {
  const int row = kUnknowns * a + 3 * c, column = kUnknowns * b + 3 * d;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3 && column + j <= row + i; ++j) factor_.At(row + i, column + j) += block[3 * i + j];
  }
}

}  // namespace meshless_cutting
