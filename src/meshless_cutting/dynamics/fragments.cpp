#include "dynamics/fragments.h"

#include <algorithm>

namespace meshless_cutting {

void Fragments::Build(const Tissue& tissue) {
  const int particles = tissue.particle_count(), K = tissue.support_size;
  ResizeWithRoom(parent_, particles);
  for (int j = 0; j < particles; ++j) parent_[j] = j;
  const auto find = [&](int j) {
    while (parent_[j] != j) {
      parent_[j] = parent_[parent_[j]];
      j = parent_[j];
    }
    return j;
  };
  for (int p = 0; p < tissue.point_count(); ++p) {
    const int* support = &tissue.point_particles[static_cast<std::size_t>(p) * K];
    int root = find(support[0]);
    for (int k = 1; k < K; ++k) {
      if (parent_[support[k]] == root) continue;
      const int other = find(support[k]);
      parent_[std::max(root, other)] = std::min(root, other);
      root = std::min(root, other);
    }
  }
  ResizeWithRoom(of_particle, particles);
  held.clear();
  for (int j = 0; j < particles; ++j) {
    const int root = find(j);  // root <= j: numbered already unless it is j
    if (root == j) {
      of_particle[j] = count();
      held.push_back(0);
    } else {
      of_particle[j] = of_particle[root];
    }
    if (tissue.particle_fixed[j]) held[of_particle[j]] = 1;
  }
  force_.resize(count());
  weight_.resize(count());
}

void Fragments::Balance(const Field& residual, const std::vector<double>& inertia, Field& y) {
  std::fill(force_.begin(), force_.end(), Vector4());
  std::fill(weight_.begin(), weight_.end(), 0.0);
  for (std::size_t j = 0; j < y.size(); ++j) {
    force_[of_particle[j]] += residual[j];
    weight_[of_particle[j]] += inertia[j];
  }
  for (std::size_t j = 0; j < y.size(); ++j) {
    const int f = of_particle[j];
    if (!held[f] && weight_[f] > 0 && inertia[j] > 0) y[j] += (-1 / weight_[f]) * force_[f];
  }
}

double Fragments::EnergyOfFlight(const std::vector<double>& mass, const Vector4& gravity, const Field& start,
                                 const Field& x, const Field& v) {
  std::vector<double>& total = weight_;
  Field& momentum = force_;
  std::fill(momentum.begin(), momentum.end(), Vector4());
  std::fill(total.begin(), total.end(), 0.0);
  double energy = 0;
  for (std::size_t j = 0; j < x.size(); ++j) {
    const int f = of_particle[j];
    if (held[f]) continue;
    momentum[f] += mass[j] * v[j];
    total[f] += mass[j];
    energy -= mass[j] * Dot(gravity, x[j] - start[j]);
  }
  for (int f = 0; f < count(); ++f) {
    if (total[f] > 0) energy += 0.5 / total[f] * Dot(momentum[f], momentum[f]);
  }
  return energy;
}

}  // namespace meshless_cutting
