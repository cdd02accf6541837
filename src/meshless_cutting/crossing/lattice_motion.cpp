#include "crossing/lattice_motion.h"

#include <algorithm>

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

LatticeMotion::LatticeMotion(const Lattice& lattice, const CutSurface& surface, const IntegrationPoints& points,
                             const ShapeFunctions& shape, const Tissue& tissue)
    : lattice_(&lattice), surface_(&surface), tissue_(&tissue), mapping_(points, shape, tissue) {
  const auto& [a, b] = lattice.links[0];
  offset_size_ = kOffsetShare * (lattice.vertices[a] - lattice.vertices[b]).norm();
  const int count = static_cast<int>(lattice.vertices.size());
  for (int v = 0; v < count; ++v) {
    offset_.push_back(offset_size_ * Scatter(v));
    mapping_.Add(lattice.vertices[v], v);
    mapping_.MapInside(v);
    Enter(v);
  }
  for (int v = 0; v < count; ++v) Link(v);
}

void LatticeMotion::Enter(int vertex) {
  const size_t block = static_cast<size_t>(mapping_.point(vertex));
  if (block >= block_vertices_.size())
    for (auto* lists : {&block_vertices_, &block_loose_, &block_neighbours_}) lists->resize(block + 1);
  block_vertices_[block].push_back(vertex);
  if (surface_->VertexOf(vertex) >= 0 || !mapping_.convex(vertex)) block_loose_[block].push_back(vertex);
}

void LatticeMotion::Leave(int vertex) {
  for (auto* list : {&block_vertices_[mapping_.point(vertex)], &block_loose_[mapping_.point(vertex)]}) {
    const auto at = std::find(list->begin(), list->end(), vertex);
    if (at != list->end()) list->erase(at);
  }
}

void LatticeMotion::Link(int vertex) {
  const int p = mapping_.point(vertex);
  auto insert = [](std::vector<int>& values, int value) {
    const auto at = std::lower_bound(values.begin(), values.end(), value);
    if (at == values.end() || *at != value) values.insert(at, value);
  };
  for (const int* l = lattice_->vertex_links.begin(vertex); l != lattice_->vertex_links.end(vertex); ++l) {
    const auto& [a, b] = lattice_->links[*l];
    const int q = mapping_.point(a == vertex ? b : a);
    if (p == q) continue;
    insert(block_neighbours_[p], q);
    insert(block_neighbours_[q], p);
  }
}

void LatticeMotion::SetWindow(const std::vector<Eigen::Vector3d>* particles_t0,
                              const std::vector<Eigen::Vector3d>* particles_t1,
                              const std::vector<Eigen::Vector3d>* surface_t0,
                              const std::vector<Eigen::Vector3d>* surface_t1) {
  particles_t0_ = particles_t0;
  particles_t1_ = particles_t1;
  surface_t0_ = surface_t0;
  surface_t1_ = surface_t1;
}

void LatticeMotion::KeepStarts(const std::vector<int>& points, const std::vector<Eigen::Vector3d>& particles) {
  lost_.clear();
  for (int p : points)
    if (p < block_count())
      for (int v : block_vertices_[p])
        if (!mapping_.IsJoined(v)) lost_.push_back(v);
  std::sort(lost_.begin(), lost_.end());
  for (int v : lost_)
    if (surface_->VertexOf(v) < 0) kept_.emplace_back(v, mapping_.Position(v, particles));
}

void LatticeMotion::Remap(const std::vector<int>& points) {
  for (int v : lost_) {
    Leave(v);
    mapping_.MapInside(v);
    Enter(v);
  }
  for (int v : lost_) Link(v);
  for (int p : points)
    if (p < block_count())
      for (int v : block_vertices_[p]) mapping_.Refresh(v);
}

void LatticeMotion::ForgetStarts() { kept_.clear(); }

Eigen::Vector3d LatticeMotion::Start(int vertex) const {
  const int s = surface_->VertexOf(vertex);
  if (s >= 0) return (*surface_t0_)[s] + offset_[vertex];
  const auto kept =
      std::lower_bound(kept_.begin(), kept_.end(), vertex, [](const auto& entry, int v) { return entry.first < v; });
  if (kept != kept_.end() && kept->first == vertex) return kept->second + offset_[vertex];
  return mapping_.Position(vertex, *particles_t0_) + offset_[vertex];
}

Eigen::Vector3d LatticeMotion::End(int vertex) const {
  const int s = surface_->VertexOf(vertex);
  return (s >= 0 ? (*surface_t1_)[s] : mapping_.Position(vertex, *particles_t1_)) + offset_[vertex];
}

}  // namespace meshless_cutting
