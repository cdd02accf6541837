#include "tissue/shape_functions.h"

#include <Eigen/Dense>
#include <cmath>

namespace meshless_cutting {
namespace {

// How far off the faces of a cell the window is evaluated, in cells. Smaller: closer to plain trilinear at the faces
// under wide supports; larger: a better conditioned moment matrix for points at or outside a face.
constexpr double kWindowMargin = 0.05;

struct Window {
  double value;
  Eigen::Vector3d gradient;  // per cell
};

Window Hat(const Eigen::Vector3d& distance, double half_width) {
  Eigen::Vector3d h, dh;
  for (int i = 0; i < 3; ++i) {
    h[i] = std::max(0.0, 1 - std::abs(distance[i]) / half_width);
    dh[i] = h[i] > 0 ? (distance[i] < 0 ? 1 : -1) / half_width : 0;
  }
  return {h.prod(), {dh[0] * h[1] * h[2], h[0] * dh[1] * h[2], h[0] * h[1] * dh[2]}};
}

}  // namespace

int ShapeFunctions::Margin(double radius) { return std::max(0, static_cast<int>(std::floor(radius + 0.5)) - 1); }

ShapeFunctions::ShapeFunctions(const BackgroundGrid& grid, double radius) : grid_(&grid), hat_(1 + Margin(radius)) {
  const int margin = Margin(radius);
  for (int k = -margin; k <= margin + 1; ++k)
    for (int j = -margin; j <= margin + 1; ++j)
      for (int i = -margin; i <= margin + 1; ++i)
        if ((Eigen::Vector3d(i, j, k).array() - 0.5).matrix().norm() <= radius) offsets_.emplace_back(i, j, k);
  centre_.resize(offsets_.size());
  Values(0, grid.CellCorner(grid.CellCoordinates(0)) + 0.5 * grid.spacing(), centre_.data());
}

Eigen::Vector3d ShapeFunctions::Local(int cell, const Eigen::Vector3d& X) const {
  return (X - grid_->CellCorner(grid_->CellCoordinates(cell))).cwiseQuotient(grid_->spacing());
}

// phi_k = w_k c . p_k with the basis p = (1, xi_k - xi) about the point itself and A c = e_0, A = sum w_k p_k p_k^T
// (Belytschko, Lu & Gu 1994, shifted basis).
void ShapeFunctions::Values(int cell, const Eigen::Vector3d& X, double* phi) const {
  const Eigen::Vector3d xi = Local(cell, X);
  const Eigen::Vector3d at = xi.cwiseMax(kWindowMargin).cwiseMin(1 - kWindowMargin);
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  for (size_t k = 0; k < offsets_.size(); ++k) {
    const Eigen::Vector3d node = offsets_[k].cast<double>();
    phi[k] = Hat(at - node, hat_).value;
    Eigen::Vector4d p;
    p << 1, node - at;
    A += phi[k] * p * p.transpose();
  }
  Eigen::Vector4d target;  // the linear basis at the true point, seen from where the window is
  target << 1, xi - at;
  const Eigen::Vector4d c = A.ldlt().solve(target);
  for (size_t k = 0; k < offsets_.size(); ++k) {
    Eigen::Vector4d p;
    p << 1, offsets_[k].cast<double>() - at;
    phi[k] *= c.dot(p);
  }
}

void ShapeFunctions::Gradients(int cell, const Eigen::Vector3d& X, Eigen::Vector3d* gradients) const {
  const Eigen::Vector3d at = Local(cell, X).cwiseMax(kWindowMargin).cwiseMin(1 - kWindowMargin);
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero(), dA[3];
  for (auto& m : dA) m.setZero();
  for (const Eigen::Vector3i& offset : offsets_) {
    const Window w = Hat(at - offset.cast<double>(), hat_);
    Eigen::Vector4d p;
    p << 1, offset.cast<double>() - at;
    const Eigen::Matrix4d pp = p * p.transpose();
    A += w.value * pp;
    for (int a = 0; a < 3; ++a) dA[a] += w.gradient[a] * pp;
  }
  // In the basis shifted to a *constant* `at`, phi_k(x) = w_k(x) p(x)^T A(x)^-1 p_k with p(x) = (1, x - at).
  const Eigen::LDLT<Eigen::Matrix4d> solver(A);
  const Eigen::Vector4d c = solver.solve(Eigen::Vector4d::Unit(0));
  Eigen::Vector4d dc[3];
  for (int a = 0; a < 3; ++a) dc[a] = solver.solve(Eigen::Vector4d(Eigen::Vector4d::Unit(1 + a) - dA[a] * c));
  for (size_t k = 0; k < offsets_.size(); ++k) {
    const Window w = Hat(at - offsets_[k].cast<double>(), hat_);
    Eigen::Vector4d p;
    p << 1, offsets_[k].cast<double>() - at;
    for (int a = 0; a < 3; ++a)
      gradients[k][a] = (w.gradient[a] * c.dot(p) + w.value * dc[a].dot(p)) / grid_->spacing()[a];
  }
}

}  // namespace meshless_cutting
