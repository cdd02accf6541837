#include "crossing/lattice_motion.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace meshless_cutting {

// Offset of a vertex in the search as a share of the lattice size. Larger: safer against a blade that runs along
// lattice planes within rounding or the solver's residual; smaller: truer. At 1e-6 it is nanometres.
constexpr double kOffsetShare = 1e-6;

namespace {

/// Three well mixed numbers in [-1, 1] from an index (the finaliser of MurmurHash3, A. Appleby, public domain).
Eigen::Vector3d Scatter(int index) {
  Eigen::Vector3d values;
  std::uint64_t h = static_cast<std::uint64_t>(index) + 0x9e3779b97f4a7c15u;
  for (int axis = 0; axis < 3; ++axis) {
    h = (h ^ h >> 33) * 0xff51afd7ed558ccdu;
    h = (h ^ h >> 33) * 0xc4ceb9fe1a85ec53u;
    h ^= h >> 33;
    values[axis] = static_cast<double>(h >> 11) * 0x1p-52 - 1;
  }
  return values;
}

}  // namespace

LatticeMotion::LatticeMotion(const Lattice& lattice, const CutSurface& surface, const VertexMapping& drawn,
                             const IntegrationPoints& points, const BackgroundGrid& grid, const ShapeFunctions& shape,
                             const Tissue& tissue)
    : surface_(&surface),
      drawn_(&drawn),
      points_(&points),
      tissue_(&tissue),
      inner_(points, shape, tissue),
      blocks_(lattice, grid),
      kept_of_(lattice.vertices.size(), -1) {
  const auto& [a, b] = lattice.links[0];
  offset_size_ = kOffsetShare * (lattice.vertices[a] - lattice.vertices[b]).norm();
  const int count = static_cast<int>(lattice.vertices.size());
  for (int v = 0; v < count; ++v) {
    offset_.push_back(offset_size_ * Scatter(v));
    inner_.Add(lattice.vertices[v], v);
    if (surface.VertexOf(v) < 0) inner_.MapInside(v);
    Place(v);
  }
  for (int v = 0; v < count; ++v) blocks_.Connect(v);
  std::vector<int> all(points.points().size());
  std::iota(all.begin(), all.end(), 0);
  blocks_.Regroup(all, tissue);
}

void LatticeMotion::Place(int vertex) {
  const int s = surface_->VertexOf(vertex);
  const int point = s >= 0 ? drawn_->point(s) : inner_.point(vertex);
  blocks_.Assign(vertex, point, points_->points()[point].cell, Overshoot(vertex));
}

void LatticeMotion::SetWindow(const std::vector<Eigen::Vector3d>* particles_t0,
                              const std::vector<Eigen::Vector3d>* particles_t1,
                              const std::vector<Eigen::Vector3d>* surface_t0,
                              const std::vector<Eigen::Vector3d>* surface_t1) {
  particles_t0_ = particles_t0;
  particles_t1_ = particles_t1;
  surface_t0_ = surface_t0;
  surface_t1_ = surface_t1;
  blocks_.AddTravel(*particles_t0, *particles_t1);
}

void LatticeMotion::KeepStarts(const std::vector<int>& points, const std::vector<Eigen::Vector3d>& particles) {
  lost_.clear();
  const int block_count = static_cast<int>(blocks_.blocks().size());
  for (int p : points)
    if (p < block_count)
      for (int v : blocks_.blocks()[p].vertices)
        if (surface_->VertexOf(v) < 0 && !inner_.IsJoined(v)) lost_.push_back(v);
  std::sort(lost_.begin(), lost_.end());
  for (int v : lost_) {
    if (kept_of_[v] >= 0) continue;
    kept_of_[v] = static_cast<int>(kept_.size());
    kept_.emplace_back(v, inner_.Position(v, particles));
  }
}

void LatticeMotion::Remap(const std::vector<int>& points, const std::vector<int>& redrawn) {
  std::vector<int> moved;
  for (int v : lost_) {
    inner_.MapInside(v);
    moved.push_back(v);
  }
  for (int s : redrawn)
    if (const int v = drawn_->anchor(s); surface_->VertexOf(v) == s) moved.push_back(v);
  for (int v : moved) Place(v);
  for (int v : moved) blocks_.MarkAstray(v);
  for (int v : moved) blocks_.Connect(v);
  const int block_count = static_cast<int>(blocks_.blocks().size());
  for (int p : points)
    if (p < block_count)
      for (int v : blocks_.blocks()[p].vertices)
        if (surface_->VertexOf(v) < 0) inner_.Refresh(v);
  blocks_.Regroup(points, *tissue_);
}

void LatticeMotion::ForgetStarts() {
  for (const auto& [vertex, start] : kept_) kept_of_[vertex] = -1;
  kept_.clear();
  blocks_.ForgetAstray();
}

LatticeMotion::Window LatticeMotion::At(int vertex) const {
  const Eigen::Vector3d& offset = offset_[vertex];
  if (const int s = surface_->VertexOf(vertex); s >= 0) return {(*surface_t0_)[s] + offset, (*surface_t1_)[s] + offset};
  Window window;
  inner_.Positions(vertex, *particles_t0_, *particles_t1_, window.start, window.end);
  if (const int k = kept_of_[vertex]; k >= 0) window.start = kept_[static_cast<size_t>(k)].second;
  window.start += offset;
  window.end += offset;
  return window;
}

}  // namespace meshless_cutting
