#include "crossing/lattice_motion.h"

#include <algorithm>

namespace meshless_cutting {

// Offset of a vertex in the search as a share of the lattice size. Larger: safer against a blade that runs along lattice planes
// within rounding or the solver's residual; smaller: truer. At 1e-6 it is nanometres.
constexpr double kOffsetShare = 1e-6;

LatticeMotion::LatticeMotion(const Lattice& lattice, const CutSurface& surface, const IntegrationPoints& points,
                             const ShapeFunctions& shape, const Tissue& tissue)
    : lattice_(&lattice), surface_(&surface), tissue_(&tissue), mapping_(points, shape, tissue) {
  const auto& [a, b] = lattice.links[0];
  offset_size_ = kOffsetShare * (lattice.vertices[a] - lattice.vertices[b]).norm();
  block_vertices_.resize(points.points().size());
  block_neighbours_.resize(points.points().size());
  const int count = static_cast<int>(lattice.vertices.size());
  for (int v = 0; v < count; ++v) {
    mapping_.Add(lattice.vertices[v], v);
    mapping_.MapInside(v);
    block_vertices_[mapping_.point(v)].push_back(v);
  }
  for (int v = 0; v < count; ++v) Link(v);
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

void LatticeMotion::KeepStart(const std::vector<int>& vertices, const std::vector<Eigen::Vector3d>& particles) {
  for (int v : vertices)
    if (surface_->VertexOf(v) < 0) kept_.emplace_back(v, mapping_.Position(v, particles));
  std::sort(kept_.begin(), kept_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
}

void LatticeMotion::Remap(const std::vector<int>& vertices) {
  for (int v : vertices) {
    std::vector<int>& old = block_vertices_[mapping_.point(v)];
    old.erase(std::find(old.begin(), old.end(), v));
    mapping_.MapInside(v);
    const size_t block = static_cast<size_t>(mapping_.point(v));
    if (block >= block_vertices_.size()) {
      block_vertices_.resize(block + 1);
      block_neighbours_.resize(block + 1);
    }
    block_vertices_[block].push_back(v);
  }
  for (int v : vertices) Link(v);
}

void LatticeMotion::ForgetStarts() { kept_.clear(); }

Eigen::Vector3d LatticeMotion::Offset(int vertex) const {
  // Three well mixed numbers in [-1, 1] from the index (the finaliser of MurmurHash3, A. Appleby, public domain).
  Eigen::Vector3d offset;
  std::uint64_t h = static_cast<std::uint64_t>(vertex) + 0x9e3779b97f4a7c15u;
  for (int axis = 0; axis < 3; ++axis) {
    h = (h ^ h >> 33) * 0xff51afd7ed558ccdu;
    h = (h ^ h >> 33) * 0xc4ceb9fe1a85ec53u;
    h ^= h >> 33;
    offset[axis] = static_cast<double>(h >> 11) * 0x1p-52 - 1;
  }
  return offset_size_ * offset;
}

Eigen::Vector3d LatticeMotion::Start(int vertex) const {
  const int s = surface_->VertexOf(vertex);
  if (s >= 0) return (*surface_t0_)[s] + Offset(vertex);
  const auto kept = std::lower_bound(kept_.begin(), kept_.end(), vertex,
                                     [](const auto& entry, int v) { return entry.first < v; });
  if (kept != kept_.end() && kept->first == vertex) return kept->second + Offset(vertex);
  return mapping_.Position(vertex, *particles_t0_) + Offset(vertex);
}

Eigen::Vector3d LatticeMotion::End(int vertex) const {
  const int s = surface_->VertexOf(vertex);
  return (s >= 0 ? (*surface_t1_)[s] : mapping_.Position(vertex, *particles_t1_)) + Offset(vertex);
}

}  // namespace meshless_cutting
