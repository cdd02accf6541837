#include "dynamics/coarse_matrix.h"

#include <algorithm>

namespace meshless_cutting {

void CoarseMatrix::Build(const Tissue& tissue, const std::vector<double>& free, int wanted_aggregates) {
  aggregates_.Build(tissue, free, wanted_aggregates);
  ListPoints(tissue);
  Clear();
}

void CoarseMatrix::ListPoints(const Tissue& tissue) {
  const std::size_t K = tissue.support_size;
  first_.resize(aggregates_.count());
  for (int a = 0; a < aggregates_.count(); ++a) first_[a] = a;
  // Twice the same walk: count, then place.
  const auto walk = [&](auto&& visit) {
    for (int p = 0; p < tissue.point_count(); ++p) {
      const int* support = &tissue.point_particles[p * K];
      for (std::size_t k = 0; k < K; ++k) {
        const int a = aggregates_.of_particle[support[k]];
        bool is_new = a >= 0;
        for (std::size_t l = 0; l < k && is_new; ++l) is_new = aggregates_.of_particle[support[l]] != a;
        if (is_new) visit(a, p, support);
      }
    }
  };
  points_begin_.assign(aggregates_.count() + 2, 0);
  walk([&](int a, int, const int* support) {
    ++points_begin_[a + 2];
    for (std::size_t k = 0; k < K; ++k) {
      const int b = aggregates_.of_particle[support[k]];
      if (b >= 0) first_[a] = std::min(first_[a], b);
    }
  });
  for (int a = 0; a < aggregates_.count(); ++a) points_begin_[a + 2] += points_begin_[a + 1];
  points_.resize(points_begin_.back());
  walk([&](int a, int p, const int*) { points_[points_begin_[a + 1]++] = p; });
  points_inside_end_.resize(aggregates_.count());
  for (int a = 0; a < aggregates_.count(); ++a) {
    const auto begin = points_.begin() + points_begin_[a], end = points_.begin() + points_begin_[a + 1];
    const auto inside_end = std::stable_partition(begin, end, [&](int p) {
      const int* support = &tissue.point_particles[p * K];
      return std::all_of(support, support + K, [&](int j) { return aggregates_.of_particle[j] == a; });
    });
    points_inside_end_[a] = static_cast<int>(inside_end - points_.begin());
  }
}

void CoarseMatrix::Add(int a, int c, int b, int d, const double* block) {
  double* columns = &factor_.At(kUnknowns * a + 3 * c, kUnknowns * b + 3 * d);
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) columns[kUnknowns * j + i] += block[3 * i + j];
  }
}

void CoarseMatrix::AddAll(int a, int b, double factor, const double (*blocks)[9][kFunctions]) {
  double* columns = &factor_.At(kUnknowns * a, kUnknowns * b);
  for (int d = 0; d < kFunctions; ++d) {
    for (int j = 0; j < 3; ++j, columns += kUnknowns) {
      for (int c = 0; c < kFunctions; ++c) {
        for (int i = 0; i < 3; ++i) columns[3 * c + i] += factor * blocks[c][3 * i + j][d];
      }
    }
  }
}

}  // namespace meshless_cutting
