#include "dynamics/grains.h"

#include <Eigen/Dense>
#include <algorithm>

namespace meshless_cutting {
namespace {

/// Of all rotations the one nearest to A; of a mirrored A, too.
Eigen::Matrix3d NearestRotation(const Eigen::Matrix3d& A) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) *= -1;
  return U * svd.matrixV().transpose();
}

}  // namespace

void Grains::Build(const Tissue& tissue, const Fragments& fragments) {
  volume_.assign(fragments.count(), 0.0);
  double cell = 0;
  for (int p = 0; p < tissue.point_count(); ++p) {
    const int first = tissue.point_particles[static_cast<std::size_t>(p) * tissue.support_size];
    volume_[fragments.of_particle[first]] += tissue.point_volume[p];
    cell = std::max(cell, tissue.point_volume[p]);
  }
  const auto moves = [&](int j) { return tissue.particle_mass[j] > 0 && !tissue.particle_fixed[j]; };
  place_.assign(fragments.count(), -1);
  for (int f = 0; f < fragments.count(); ++f) {
    if (!fragments.held[f] && volume_[f] > 0 && volume_[f] < cell) place_[f] = 0;
  }
  for (int j = 0; j < tissue.particle_count(); ++j) {
    int& place = place_[fragments.of_particle[j]];
    if (place >= 0 && moves(j)) ++place;
  }
  end_.clear();
  int total = 0;
  for (int& place : place_) {
    if (place < 0) continue;
    const int size = place;
    place = total;
    total += size;
    end_.push_back(total);
  }
  particles_.resize(total);
  for (int j = 0; j < tissue.particle_count(); ++j) {
    int& place = place_[fragments.of_particle[j]];
    if (place >= 0 && moves(j)) particles_[place++] = j;
  }
}

void Grains::Restore(const Tissue& tissue, double time_step, Field& position, Field& velocity,
                     Field& acceleration) const {
  int begin = 0;
  for (const int end : end_) {
    double mass = 0;
    Vector4 x, v, a;
    Eigen::Vector3d X = Eigen::Vector3d::Zero();
    for (int i = begin; i < end; ++i) {
      const int j = particles_[i];
      const double m = tissue.particle_mass[j];
      mass += m;
      x += m * position[j];
      v += m * velocity[j];
      a += m * acceleration[j];
      X += m * tissue.particle_rest[j];
    }
    x = (1 / mass) * x;
    v = (1 / mass) * v;
    a = (1 / mass) * a;
    X /= mass;
    Eigen::Vector3d momentum = Eigen::Vector3d::Zero();  // angular, kg m^2/s
    Eigen::Matrix3d fit = Eigen::Matrix3d::Zero();       // kg m^2
    for (int i = begin; i < end; ++i) {
      const int j = particles_[i];
      const double m = tissue.particle_mass[j];
      const Eigen::Vector3d r = (position[j] - x).vector();
      momentum += m * r.cross((velocity[j] - v).vector());
      fit += m * r * (tissue.particle_rest[j] - X).transpose();
    }
    const Eigen::Matrix3d R = NearestRotation(fit);
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // kg m^2
    for (int i = begin; i < end; ++i) {
      const int j = particles_[i];
      const Eigen::Vector3d r = R * (tissue.particle_rest[j] - X);
      position[j] = x + Vector4::From(r);
      inertia += tissue.particle_mass[j] * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
    }
    // One that has a single particle has no inertia.
    inertia += (1e-9 * inertia.trace() + 1e-300) * Eigen::Matrix3d::Identity();
    Eigen::Vector3d spin = inertia.ldlt().solve(momentum);
    const double turn = spin.norm() * time_step;
    if (turn > kMostTurn) spin *= kMostTurn / turn;
    for (int i = begin; i < end; ++i) {
      const int j = particles_[i];
      velocity[j] = v + Vector4::From(spin.cross((position[j] - x).vector()));
      acceleration[j] = a;
    }
    begin = end;
  }
}

}  // namespace meshless_cutting
