#include "surface/vertex_mapping.h"

#include <algorithm>
#include <limits>

namespace meshless_cutting {

VertexMapping::VertexMapping(const IntegrationPoints& points, const ShapeFunctions& shape, const Tissue& tissue)
    : points_(&points), shape_(&shape), tissue_(&tissue) {
  links_.support_size = tissue.support_size;
}

void VertexMapping::Add(const Eigen::Vector3d& X, int anchor) {
  rest_.push_back(X);
  anchor_.push_back(anchor);
  point_.push_back(-1);
  links_.particles.resize(links_.particles.size() + links_.support_size, 0);
  links_.weights.resize(links_.weights.size() + links_.support_size, 0);
}

void VertexMapping::Unmap(int v) {
  if (point_[v] < 0) return;
  std::vector<int>& on_point = on_point_[point_[v]];
  on_point.erase(std::find(on_point.begin(), on_point.end(), v));
  point_[v] = -1;
}

const std::vector<int>& VertexMapping::OnPoint(int p) const {
  static const std::vector<int> none;
  return static_cast<size_t>(p) < on_point_.size() ? on_point_[p] : none;
}

bool VertexMapping::SharesParticle(int p, int q) const {
  if (p == q) return true;
  const int K = links_.support_size;
  const int* a = &tissue_->point_particles[static_cast<size_t>(p) * K];
  const int* b = &tissue_->point_particles[static_cast<size_t>(q) * K];
  return std::find_first_of(a, a + K, b, b + K) != a + K;
}

void VertexMapping::Map(int v, const Eigen::Vector3d& normal, const std::vector<int>& neighbours) {
  const Eigen::Vector3d& X = rest_[v];
  int nearest = -1, below = -1, chosen = -1;
  double nearest_d = std::numeric_limits<double>::infinity(), below_d = nearest_d, chosen_d = nearest_d;
  for (int p : points_->OfVertex(anchor_[v])) {
    const Eigen::Vector3d to_point = points_->points()[p].centroid - X;
    const double d = to_point.squaredNorm();
    if (d < nearest_d) nearest = p, nearest_d = d;
    if (to_point.dot(normal) > 0) continue;
    if (d < below_d) below = p, below_d = d;
    if (d >= chosen_d) continue;
    const bool shares = std::all_of(neighbours.begin(), neighbours.end(),
                                    [&](int w) { return point_[w] < 0 || SharesParticle(p, point_[w]); });
    if (shares) chosen = p, chosen_d = d;
  }
  ++statistics_.mapped;
  if (chosen < 0) {
    ++statistics_.relaxed;
    chosen = below >= 0 ? below : nearest;
  } else {
    if (nearest != below) ++statistics_.tangent_plane;
    if (below != chosen) ++statistics_.shared_particle;
  }
  Assign(v, chosen);
}

void VertexMapping::MapInside(int v) {
  const Eigen::Vector3d& X = rest_[v];
  const std::vector<int>& inside = points_->InCell(shape_->grid().CellAt(X));
  int chosen = -1;
  double chosen_d = std::numeric_limits<double>::infinity();
  for (int p : points_->OfVertex(anchor_[v])) {
    const bool own_cell = std::find(inside.begin(), inside.end(), p) != inside.end();
    const double d = own_cell ? -1 : (points_->points()[p].centroid - X).squaredNorm();
    if (d < chosen_d) chosen = p, chosen_d = d;
  }
  Assign(v, chosen);
}

bool VertexMapping::IsJoined(int v) const {
  const std::vector<int>& points = points_->OfVertex(anchor_[v]);
  return std::binary_search(points.begin(), points.end(), point_[v]);
}

void VertexMapping::Refresh(int v) {
  const size_t K = static_cast<size_t>(links_.support_size);
  std::copy_n(&tissue_->point_particles[point_[v] * K], K, &links_.particles[v * K]);
}

void VertexMapping::Assign(int v, int point) {
  Unmap(v);
  point_[v] = point;
  if (static_cast<size_t>(point) >= on_point_.size()) on_point_.resize(point + 1);
  on_point_[point].push_back(v);
  Refresh(v);
  const size_t K = static_cast<size_t>(links_.support_size);
  shape_->Values(points_->points()[point].cell, rest_[v], &links_.weights[v * K]);
}

double VertexMapping::overshoot(int v) const {
  const size_t K = static_cast<size_t>(links_.support_size);
  double sum = 0;
  for (size_t k = 0; k < K; ++k) sum += std::max(0.0, -links_.weights[v * K + k]);
  return sum;
}

Eigen::Vector3d VertexMapping::Position(int v, const std::vector<Eigen::Vector3d>& particles) const {
  const size_t K = static_cast<size_t>(links_.support_size);
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (size_t k = 0; k < K; ++k) x += links_.weights[v * K + k] * particles[links_.particles[v * K + k]];
  return x;
}

void VertexMapping::Positions(int v, const std::vector<Eigen::Vector3d>& particles_t0,
                              const std::vector<Eigen::Vector3d>& particles_t1, Eigen::Vector3d& x_t0,
                              Eigen::Vector3d& x_t1) const {
  const size_t K = static_cast<size_t>(links_.support_size);
  const double* weights = &links_.weights[v * K];
  const int* particles = &links_.particles[v * K];
  Eigen::Vector3d sum_t0 = Eigen::Vector3d::Zero(), sum_t1 = sum_t0;
  for (size_t k = 0; k < K; ++k) {
    sum_t0 += weights[k] * particles_t0[particles[k]];
    sum_t1 += weights[k] * particles_t1[particles[k]];
  }
  x_t0 = sum_t0;
  x_t1 = sum_t1;
}

}  // namespace meshless_cutting
