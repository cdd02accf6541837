#include "dynamics/light_particles.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace meshless_cutting {
namespace {

/// Particles that two points share when material goes on from one to the other across a face of the grid.
constexpr int kFace = 4;

/// Determinant over cubed trace of their spread, 1/27 for a cube, below which particles lie in a plane.
constexpr double kFlat = 1e-8;

}  // namespace

void LightParticles::Build(const Tissue& tissue, double cell_m) {
  support_ = tissue.support_size;
  reach_ = kReach * cell_m;
  particles_.clear();
  anchors_.clear();
  weights_.clear();
  by_mass_.clear();
  double most = 0;
  for (double m : tissue.particle_mass) most = std::max(most, m);
  for (int j = 0; j < tissue.particle_count(); ++j) {
    const double m = tissue.particle_mass[j];
    if (m > 0 && m < kShare * most && !tissue.particle_fixed[j]) by_mass_.emplace_back(-m, j);
  }
  if (by_mass_.empty()) return;
  std::sort(by_mass_.begin(), by_mass_.end());

  // The points of each particle.
  const std::size_t K = support_;
  point_begin_.assign(tissue.particle_count() + 1, 0);
  for (int j : tissue.point_particles) ++point_begin_[j];
  for (int j = 1; j <= tissue.particle_count(); ++j) point_begin_[j] += point_begin_[j - 1];
  points_.resize(tissue.point_particles.size());
  shared_.assign(tissue.point_count(), 0);
  for (int p = tissue.point_count() - 1; p >= 0; --p) {
    for (std::size_t k = 0; k < K; ++k) points_[--point_begin_[tissue.point_particles[p * K + k]]] = p;
  }

  for (const auto& [mass, j] : by_mass_) {
    int own = -1;  // the largest of its points
    for (int i = point_begin_[j]; i < point_begin_[j + 1]; ++i) {
      if (own < 0 || tissue.point_volume[points_[i]] > tissue.point_volume[own]) own = points_[i];
    }
    // The largest point that shares a face with that one and does not hold j: material behind the flake.
    const int* support = &tissue.point_particles[own * K];
    int anchor = -1;
    const auto for_each_neighbour = [&](auto&& visit) {
      for (std::size_t k = 0; k < K; ++k) {
        for (int i = point_begin_[support[k]]; i < point_begin_[support[k] + 1]; ++i) visit(points_[i]);
      }
    };
    for_each_neighbour([&](int p) { ++shared_[p]; });
    for (int i = point_begin_[j]; i < point_begin_[j + 1]; ++i) shared_[points_[i]] = 0;
    for_each_neighbour([&](int p) {
      const double volume = tissue.point_volume[p], most_so_far = tissue.point_volume[anchor < 0 ? own : anchor];
      if (shared_[p] >= kFace && (volume > most_so_far || (anchor >= 0 && volume == most_so_far && p < anchor))) anchor = p;
    });
    for_each_neighbour([&](int p) { shared_[p] = 0; });
    if (anchor >= 0) AddWeights(tissue, j, anchor);
  }
}

void LightParticles::AddWeights(const Tissue& tissue, int particle, int anchor) {
  const int* support = &tissue.point_particles[static_cast<std::size_t>(anchor) * support_];
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int k = 0; k < support_; ++k) mean += tissue.particle_rest[support[k]] / support_;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (int k = 0; k < support_; ++k) {
    const Eigen::Vector3d d = tissue.particle_rest[support[k]] - mean;
    spread += d * d.transpose();
  }
  Eigen::Matrix3d inverse;
  bool is_spread_out = false;  // else flat: says nothing about motion beyond itself
  spread.computeInverseWithCheck(inverse, is_spread_out, kFlat * std::pow(spread.trace(), 3));
  if (!is_spread_out) return;
  const Eigen::Vector3d way = inverse * (tissue.particle_rest[particle] - mean);
  particles_.push_back(particle);
  for (int k = 0; k < support_; ++k) {
    anchors_.push_back(support[k]);
    weights_.push_back(1.0 / support_ + way.dot(tissue.particle_rest[support[k]] - mean));
  }
}

void LightParticles::Follow(Field& position, Field& velocity, Field& acceleration) const {
  for (int n = 0; n < count(); ++n) {
    const int j = particles_[n];
    Vector4 x, v, a;
    for (int i = n * support_; i < (n + 1) * support_; ++i) {
      x += weights_[i] * position[anchors_[i]];
      v += weights_[i] * velocity[anchors_[i]];
      a += weights_[i] * acceleration[anchors_[i]];
    }
    velocity[j] = v;
    acceleration[j] = a;
    const Vector4 off = position[j] - x;
    const double distance = std::sqrt(Dot(off, off));
    if (distance > reach_) position[j] = x + (reach_ / distance) * off;
  }
}

}  // namespace meshless_cutting
