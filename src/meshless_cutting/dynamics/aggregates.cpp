#include "dynamics/aggregates.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace meshless_cutting {
namespace {

/// Smaller pieces join a neighbour: they would cost as much as large ones and correct little.
constexpr int kSmall = 12;

/// A direction in which the particles spread by less than this share of their largest spread is flat.
constexpr double kFlat = 1e-6;

/// Aggregates are made larger, at most so often, while there are so many times those that are wanted.
constexpr double kTooMany = 1.25;
constexpr int kTries = 3;

bool Before(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

}  // namespace

int Aggregates::Find(int j) {
  while (parent_[j] != j) {
    parent_[j] = parent_[parent_[j]];
    j = parent_[j];
  }
  return j;
}

void Aggregates::Build(const Tissue& tissue, const std::vector<double>& free, int wanted) {
  // Coarse cells that hold little of the object, or several pieces of it, make more aggregates than cells.
  int aim = wanted;
  BuildOnce(tissue, free, aim);
  for (int again = 0; again < kTries && count() > kTooMany * wanted && aim > 1; ++again) {
    aim = std::max(1, aim * wanted / count());
    BuildOnce(tissue, free, aim);
  }
  BuildBasis(tissue);
  sites_.clear();
  for (int j : particles) sites_.push_back({tissue.particle_rest[j], of_particle[j], basis[j]});
  std::sort(sites_.begin(), sites_.end(), [](const Site& a, const Site& b) { return Before(a.X, b.X); });
}

void Aggregates::Extend(const Tissue& tissue, const std::vector<double>& free) {
  const std::size_t known = of_particle.size();
  of_particle.resize(free.size(), -1);
  basis.resize(free.size());
  for (std::size_t j = 0; j < free.size(); ++j) {
    if (free[j] == 0) of_particle[j] = -1;
    if (free[j] == 0 || j < known) continue;
    const Eigen::Vector3d& X = tissue.particle_rest[j];
    const auto site = std::lower_bound(sites_.begin(), sites_.end(), X,
                                       [](const Site& a, const Eigen::Vector3d& b) { return Before(a.X, b); });
    if (site == sites_.end() || Before(X, site->X)) continue;
    of_particle[j] = site->aggregate;
    basis[j] = site->basis;
  }
  List();
}

void Aggregates::BuildOnce(const Tissue& tissue, const std::vector<double>& free, int wanted) {
  const int count = tissue.particle_count();
  Eigen::AlignedBox3d bounds;
  double volume = 0;
  for (const Eigen::Vector3d& X : tissue.particle_rest) bounds.extend(X);
  for (double v : tissue.point_volume) volume += v;
  const double size = std::max(std::cbrt(volume / std::max(wanted, 1)), 1e-3 * bounds.sizes().maxCoeff());
  // Whole coarse cells along every axis, so that none is a sliver.
  const Eigen::Array3d cells = (bounds.sizes().array() / size).round().max(1.0);
  // Cells are numbered layer by layer, across first and along the object last, so that each is coupled to few before it.
  std::array<int, 3> axes{0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](int a, int b) { return cells[a] != cells[b] ? cells[a] < cells[b] : a < b; });

  cell_.resize(count);
  parent_.resize(count);
  size_.assign(count, 1);
  for (int j = 0; j < count; ++j) {
    const Eigen::Array3d share = (tissue.particle_rest[j] - bounds.min()).array() / bounds.sizes().array().max(1e-300);
    const Eigen::Array3d at = (share * cells).floor().min(cells - 1).max(0.0);
    const double cell = (at[axes[2]] * cells[axes[1]] + at[axes[1]]) * cells[axes[0]] + at[axes[0]];
    cell_[j] = free[j] > 0 ? static_cast<int>(cell) : -1;
    parent_[j] = j;
  }
  Join(tissue);
  MergeSmall(tissue);
  Number(free);
}

void Aggregates::Join(const Tissue& tissue) {
  const int K = tissue.support_size;
  for (int p = 0; p < tissue.point_count(); ++p) {
    const int* support = &tissue.point_particles[static_cast<std::size_t>(p) * K];
    for (int a = 1; a < K; ++a) {
      if (cell_[support[a]] < 0) continue;
      // Any earlier particle of the cell will do: those before it have been joined to that one.
      for (int b = 0; b < a; ++b) {
        if (cell_[support[b]] != cell_[support[a]]) continue;
        const int x = Find(support[a]), y = Find(support[b]);
        if (x != y) {
          parent_[std::max(x, y)] = std::min(x, y);
          size_[std::min(x, y)] += size_[std::max(x, y)];
        }
        break;
      }
    }
  }
}

void Aggregates::MergeSmall(const Tissue& tissue) {
  const int K = tissue.support_size;
  for (int p = 0; p < tissue.point_count(); ++p) {
    const int* support = &tissue.point_particles[static_cast<std::size_t>(p) * K];
    for (int a = 0; a < K; ++a) {
      if (cell_[support[a]] < 0) continue;
      for (int b = 0; b < a; ++b) {
        if (cell_[support[b]] < 0) continue;
        const int x = Find(support[a]), y = Find(support[b]);
        if (x == y || std::min(size_[x], size_[y]) >= kSmall) continue;
        parent_[std::max(x, y)] = std::min(x, y);
        size_[std::min(x, y)] += size_[std::max(x, y)];
      }
    }
  }
}

void Aggregates::Number(const std::vector<double>& free) {
  const int total = static_cast<int>(free.size());
  of_particle.assign(total, -1);
  number_.assign(total, -1);
  begin.assign(1, 0);
  // In the order of the coarse grid, which keeps the bandwidth of the coarse matrix low.
  particles.clear();
  for (int j = 0; j < total; ++j) {
    if (cell_[j] >= 0 && Find(j) == j) particles.push_back(j);
  }
  std::sort(particles.begin(), particles.end(),
            [&](int a, int b) { return cell_[a] != cell_[b] ? cell_[a] < cell_[b] : a < b; });
  for (int root : particles) {
    number_[root] = count();
    begin.push_back(0);
  }
  for (int j = 0; j < total; ++j) {
    if (cell_[j] >= 0) of_particle[j] = number_[Find(j)];
  }
  List();
}

/// Particles by aggregate, from of_particle and the number of aggregates.
void Aggregates::List() {
  size_.assign(count(), 0);
  for (int a : of_particle) {
    if (a >= 0) ++size_[a];
  }
  for (int a = 0; a < count(); ++a) begin[a + 1] = begin[a] + size_[a];
  particles.resize(begin.back());
  size_.assign(count(), 0);
  for (std::size_t j = 0; j < of_particle.size(); ++j) {
    const int a = of_particle[j];
    if (a >= 0) particles[begin[a] + size_[a]++] = static_cast<int>(j);
  }
}

void Aggregates::BuildBasis(const Tissue& tissue) {
  basis.assign(of_particle.size(), Vector4());
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  for (int a = 0; a < count(); ++a) {
    const int n = begin[a + 1] - begin[a];
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (int i = begin[a]; i < begin[a + 1]; ++i) mean += tissue.particle_rest[particles[i]];
    mean /= n;
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    for (int i = begin[a]; i < begin[a + 1]; ++i) {
      const Eigen::Vector3d d = tissue.particle_rest[particles[i]] - mean;
      moment += d * d.transpose();
    }
    eigen.computeDirect(moment);
    int functions = 0;
    Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
    for (int axis = 2; axis >= 0; --axis) {  // largest first
      const double value = eigen.eigenvalues()[axis];
      if (value > kFlat * moment.trace()) axes.row(functions++) = eigen.eigenvectors().col(axis) / std::sqrt(value);
    }
    for (int i = begin[a]; i < begin[a + 1]; ++i) {
      const Eigen::Vector3d b = axes * (tissue.particle_rest[particles[i]] - mean);
      basis[particles[i]] = {1 / std::sqrt(static_cast<double>(n)), b.x(), b.y(), b.z()};
    }
  }
}

}  // namespace meshless_cutting
