#include "surface/vertex_mapping.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace meshless_cutting {
namespace {

/// A weighted sum of three-vectors: two components in one instruction, which Eigen does not do for them.
class PackedSum {
 public:
  void Add(double weight, const Eigen::Vector3d& x) {
    xy_ += weight * Eigen::Map<const Eigen::Vector2d>(x.data());
    z_ += weight * x[2];
  }
  Eigen::Vector3d value() const { return {xy_[0], xy_[1], z_}; }

 private:
  Eigen::Vector2d xy_ = Eigen::Vector2d::Zero();
  double z_ = 0;
};

}  // namespace

VertexMapping::VertexMapping(const IntegrationPoints& points, const ShapeFunctions& shape, const Tissue& tissue)
    : points_(&points), shape_(&shape), tissue_(&tissue) {
  links_.support_size = tissue.support_size;
}

void VertexMapping::Add(const Eigen::Vector3d& X, int anchor) {
  rest_.push_back(X);
  anchor_.push_back(anchor);
  point_.push_back(-1);
  cell_.push_back(-1);
  overshoot_.push_back(0);
  cut_plane_.emplace_back();
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

void VertexMapping::CountPaperCriteria(const BackgroundGrid& grid) { paper_.emplace(*points_, grid); }

bool VertexMapping::SharesParticles(int p, const std::vector<int>& vertices) const {
  const int K = links_.support_size;
  const int* a = &tissue_->point_particles[static_cast<size_t>(p) * K];
  return std::all_of(vertices.begin(), vertices.end(), [&](int w) {
    const int q = point_[w];
    if (q < 0 || q == p) return true;
    const int* b = &tissue_->point_particles[static_cast<size_t>(q) * K];
    return std::find_first_of(a, a + K, b, b + K) != a + K;
  });
}

void VertexMapping::Map(int v, const MappingConditions& conditions) {
  const Eigen::Vector3d& X = rest_[v];
  const CutPlane& plane = cut_plane_[v];
  auto below_tangent = [&](int p) { return (points_->points()[p].centroid - X).dot(conditions.normal) <= 0; };
  auto below_cut = [&](int p) { return (points_->points()[p].centroid - plane.point).dot(plane.normal) <= 0; };
  auto shares = [&](int p) { return SharesParticles(p, conditions.neighbours); };
  // The nearest point of those that meet the criteria up to each.
  struct Choice {
    int point = -1;
    double distance2 = std::numeric_limits<double>::infinity();
    bool Offer(int p, double d) {
      if (d >= distance2) return false;
      point = p;
      distance2 = d;
      return true;
    }
  } nearest, tangent, cut, chosen;
  for (int p : points_->OfVertex(anchor_[v])) {
    const double d = (points_->points()[p].centroid - X).squaredNorm();
    nearest.Offer(p, d);
    if (!below_tangent(p)) continue;
    tangent.Offer(p, d);
    if (!below_cut(p)) continue;
    cut.Offer(p, d);
    if (d < chosen.distance2 && shares(p)) chosen.Offer(p, d);
  }
  ++statistics_.mapped;
  if (chosen.point < 0) {
    ++statistics_.relaxed;
    chosen.point = cut.point >= 0 ? cut.point : tangent.point >= 0 ? tangent.point : nearest.point;
  } else {
    statistics_.tangent_plane += nearest.point != tangent.point;
    statistics_.cut_plane += tangent.point != cut.point;
    statistics_.shared_particle += cut.point != chosen.point;
  }
  if (paper_) paper_->Count(X, points_->OfVertex(anchor_[v]), {below_tangent, below_cut, shares});
  Assign(v, chosen.point);
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
  const int cell = points_->points()[point].cell;
  if (std::exchange(cell_[v], cell) == cell) return;  // the weights are those of the cell
  const size_t K = static_cast<size_t>(links_.support_size);
  double* weights = &links_.weights[v * K];
  shape_->Values(cell, rest_[v], weights);
  overshoot_[v] = 0;
  for (size_t k = 0; k < K; ++k) overshoot_[v] += std::max(0.0, -weights[k]);
}

Eigen::Vector3d VertexMapping::Position(int v, const std::vector<Eigen::Vector3d>& particles) const {
  const size_t K = static_cast<size_t>(links_.support_size);
  const double* weights = &links_.weights[v * K];
  const int* indices = &links_.particles[v * K];
  PackedSum x;
  for (size_t k = 0; k < K; ++k) x.Add(weights[k], particles[indices[k]]);
  return x.value();
}

void VertexMapping::Positions(int v, const std::vector<Eigen::Vector3d>& particles_t0,
                              const std::vector<Eigen::Vector3d>& particles_t1, Eigen::Vector3d& x_t0,
                              Eigen::Vector3d& x_t1) const {
  const size_t K = static_cast<size_t>(links_.support_size);
  const double* weights = &links_.weights[v * K];
  const int* indices = &links_.particles[v * K];
  PackedSum sum_t0, sum_t1;
  for (size_t k = 0; k < K; ++k) {
    sum_t0.Add(weights[k], particles_t0[indices[k]]);
    sum_t1.Add(weights[k], particles_t1[indices[k]]);
  }
  x_t0 = sum_t0.value();
  x_t1 = sum_t1.value();
}

}  // namespace meshless_cutting
