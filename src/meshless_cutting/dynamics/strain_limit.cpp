#include "dynamics/strain_limit.h"

#include <Eigen/Dense>

namespace meshless_cutting {
namespace {

constexpr double kMost = StrainLimit::kMost;

/// The nearest deformation with stretches within the limit that is not mirrored; false if that is F itself.
bool Limit(Eigen::Matrix3d& F) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) *= -1;
  Eigen::Vector3d stretch = (U.transpose() * F * svd.matrixV()).diagonal();  // sorted; the last below 0 if mirrored
  if (stretch[0] <= kMost && stretch[2] >= 1 / kMost) return false;
  stretch = stretch.cwiseMin(kMost).cwiseMax(1 / kMost);
  F = U * stretch.asDiagonal() * svd.matrixV().transpose();
  return true;
}

}  // namespace

int StrainLimit::Apply(const Tissue& tissue, const std::vector<double>& free, Field& position) {
  const std::size_t K = tissue.support_size;
  int beyond = 0;
  weight_.assign(position.size(), 0);
  for (int p = 0; p < tissue.point_count(); ++p) {
    for (std::size_t k = 0; k < K; ++k) weight_[tissue.point_particles[p * K + k]] += tissue.point_volume[p];
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    pull_.assign(position.size(), Vector4());
    int moved = 0;
    for (int p = 0; p < tissue.point_count(); ++p) {
      const int* support = &tissue.point_particles[p * K];
      const Eigen::Vector3d* gradient = &tissue.point_gradients[p * K];
      Eigen::Matrix3d F = Eigen::Matrix3d::Zero();
      Eigen::Vector3d x = Eigen::Vector3d::Zero(), X = x;
      for (std::size_t k = 0; k < K; ++k) {
        F += position[support[k]].vector() * gradient[k].transpose();
        x += position[support[k]].vector() / static_cast<double>(K);
        X += tissue.particle_rest[support[k]] / static_cast<double>(K);
      }
      if (!Limit(F)) continue;
      ++moved;
      for (std::size_t k = 0; k < K; ++k) {
        const int j = support[k];
        const Eigen::Vector3d goal = x + F * (tissue.particle_rest[j] - X);
        pull_[j] += tissue.point_volume[p] * (Vector4::From(goal) - position[j]);
      }
    }
    if (sweep == 0) beyond = moved;
    if (moved == 0) break;
    for (std::size_t j = 0; j < position.size(); ++j) {
      if (free[j] > 0 && weight_[j] > 0) position[j] += (1 / weight_[j]) * pull_[j];
    }
  }
  return beyond;
}

}  // namespace meshless_cutting
