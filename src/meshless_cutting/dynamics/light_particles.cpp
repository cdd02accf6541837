#include "dynamics/light_particles.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace meshless_cutting {
namespace {

/// Particles that two points share when material goes on from one to the other across a face of the grid.
constexpr int kFace = 4;

/// How far away, in points, the material behind a flake may begin.
constexpr int kFarthest = 3;

/// Determinant over cubed trace of their spread, 1/27 for a cube, below which particles lie in a plane.
constexpr double kFlat = 1e-8;

}  // namespace

void LightParticles::Build(const Tissue& tissue, double cell_m) {
  reach_ = kReach * cell_m;
  ForgetChanged(tissue);
  by_mass_.clear();
  double most = 0;
  for (double m : tissue.particle_mass) most = std::max(most, m);
  for (int j = 0; j < tissue.particle_count(); ++j) {
    const double m = tissue.particle_mass[j];
    if (m > 0 && m < kShare * most && !tissue.particle_fixed[j]) by_mass_.emplace_back(-m, j);
  }
  std::sort(by_mass_.begin(), by_mass_.end());
  particles_.clear();
  bool are_listed = false;
  for (const auto& [mass, j] : by_mass_) {
    if (followers_[j].own < 0) {
      if (!std::exchange(are_listed, true)) ListPoints(tissue);
      FindAnchor(tissue, j);
    }
    if (followers_[j].anchor >= 0) particles_.push_back(j);
  }
}

void LightParticles::ForgetChanged(const Tissue& tissue) {
  const std::size_t K = tissue.support_size;
  if (std::exchange(support_, tissue.support_size) != tissue.support_size) {
    point_particles_.clear();
    point_volume_.clear();
    followers_.clear();
  }
  touched_.assign(tissue.particle_count(), 0);
  ResizeWithRoom(followers_, tissue.particle_count());
  ResizeWithRoom(weights_, static_cast<std::size_t>(tissue.particle_count()) * K);
  for (std::size_t p = 0; p < tissue.point_volume.size(); ++p) {
    const int* now = &tissue.point_particles[p * K];
    const bool is_new = p >= point_volume_.size();
    if (!is_new && tissue.point_volume[p] == point_volume_[p] && std::equal(now, now + K, &point_particles_[p * K])) {
      continue;
    }
    for (std::size_t k = 0; k < K; ++k) {
      touched_[now[k]] = 1;
      if (!is_new) touched_[point_particles_[p * K + k]] = 1;
    }
  }
  // Also of particles that are not light just now, and may be later.
  for (Follower& follower : followers_) {
    if (follower.own < 0) continue;
    const int* support = &tissue.point_particles[static_cast<std::size_t>(follower.own) * K];
    const bool is_touched = std::any_of(support, support + K, [&](int s) { return touched_[s] != 0; });
    if (follower.is_far || is_touched) follower = Follower();
  }
  point_particles_ = tissue.point_particles;
  point_volume_ = tissue.point_volume;
}

void LightParticles::ListPoints(const Tissue& tissue) {
  point_begin_.assign(tissue.particle_count() + 1, 0);
  for (int j : tissue.point_particles) ++point_begin_[j];
  for (int j = 1; j <= tissue.particle_count(); ++j) point_begin_[j] += point_begin_[j - 1];
  ResizeWithRoom(points_, tissue.point_particles.size());
  shared_.assign(tissue.point_count(), 0);
  for (int p = tissue.point_count() - 1; p >= 0; --p) {
    for (int k = 0; k < support_; ++k) points_[--point_begin_[tissue.point_particles[p * support_ + k]]] = p;
  }
}

void LightParticles::FindAnchor(const Tissue& tissue, int particle) {
  auto& [own, anchor, is_far] = followers_[particle];
  own = anchor = -1;
  for (int i = point_begin_[particle]; i < point_begin_[particle + 1]; ++i) {
    if (own < 0 || tissue.point_volume[points_[i]] > tissue.point_volume[own]) own = points_[i];
  }
  // The largest point within reach across faces, larger than that one, that does not hold the particle: material behind the
  // flake. Mostly a neighbour; a flake that hangs on a smaller one has it farther away.
  const auto holds = [&](int p) {
    const int* support = &tissue.point_particles[static_cast<std::size_t>(p) * support_];
    return std::find(support, support + support_, particle) != support + support_;
  };
  double largest = tissue.point_volume[own];
  reached_.assign(1, own);
  std::size_t begin = 0;
  for (int way = 1; way <= kFarthest && anchor < 0; ++way) {
    const std::size_t end = reached_.size();
    for (; begin < end; ++begin) ReachNeighbours(tissue, reached_[begin]);
    for (std::size_t i = end; i < reached_.size(); ++i) {
      const int p = reached_[i];
      const double volume = tissue.point_volume[p];
      if (volume < largest || (volume == largest && (anchor < 0 || p >= anchor)) || holds(p)) continue;
      anchor = p;
      largest = volume;
    }
    is_far = way > 1;
  }
  if (anchor >= 0 && !Fit(tissue, particle)) anchor = -1;
}

void LightParticles::ReachNeighbours(const Tissue& tissue, int point) {
  const int* support = &tissue.point_particles[static_cast<std::size_t>(point) * support_];
  const auto for_each = [&](auto&& visit) {
    for (int k = 0; k < support_; ++k) {
      for (int i = point_begin_[support[k]]; i < point_begin_[support[k] + 1]; ++i) visit(points_[i]);
    }
  };
  for_each([&](int p) { ++shared_[p]; });
  for (int p : reached_) shared_[p] = 0;
  for_each([&](int p) {
    if (std::exchange(shared_[p], 0) >= kFace) reached_.push_back(p);
  });
}

bool LightParticles::Fit(const Tissue& tissue, int particle) {
  const int* support = &tissue.point_particles[static_cast<std::size_t>(followers_[particle].anchor) * support_];
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
  if (!is_spread_out) return false;
  const Eigen::Vector3d way = inverse * (tissue.particle_rest[particle] - mean);
  double* weights = &weights_[static_cast<std::size_t>(particle) * support_];
  for (int k = 0; k < support_; ++k) weights[k] = 1.0 / support_ + way.dot(tissue.particle_rest[support[k]] - mean);
  return true;
}

void LightParticles::Follow(Field& position, Field& velocity, Field& acceleration) const {
  for (int j : particles_) {
    const int* anchor = &point_particles_[static_cast<std::size_t>(followers_[j].anchor) * support_];
    const double* weight = &weights_[static_cast<std::size_t>(j) * support_];
    Vector4 x, v, a;
    for (int k = 0; k < support_; ++k) {
      x += weight[k] * position[anchor[k]];
      v += weight[k] * velocity[anchor[k]];
      a += weight[k] * acceleration[anchor[k]];
    }
    velocity[j] = v;
    acceleration[j] = a;
    const Vector4 off = position[j] - x;
    const double distance = std::sqrt(Dot(off, off));
    if (distance > reach_) position[j] = x + (reach_ / distance) * off;
  }
}

}  // namespace meshless_cutting
