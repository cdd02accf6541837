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
    const bool shares = std::all_of(neighbours.begin(), neighbours.end(),
                                    [&](int w) { return point_[w] < 0 || SharesParticle(p, point_[w]); });
    if (shares && d < chosen_d) chosen = p, chosen_d = d;
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
  point_[v] = point;
  Refresh(v);
  const size_t K = static_cast<size_t>(links_.support_size);
  shape_->Values(points_->points()[point].cell, rest_[v], &links_.weights[v * K]);
}

bool VertexMapping::convex(int v) const {
  const size_t K = static_cast<size_t>(links_.support_size);
  return std::all_of(&links_.weights[v * K], &links_.weights[v * K] + K, [](double w) { return w >= 0; });
}

Eigen::Vector3d VertexMapping::Position(int v, const std::vector<Eigen::Vector3d>& particles) const {
  const size_t K = static_cast<size_t>(links_.support_size);
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (size_t k = 0; k < K; ++k) x += links_.weights[v * K + k] * particles[links_.particles[v * K + k]];
  return x;
}

}  // namespace meshless_cutting
