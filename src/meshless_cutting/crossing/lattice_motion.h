// Where lattice vertices were published last and where they are now: the object's half of a crossing window.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "cut/cut_surface.h"
#include "surface/vertex_mapping.h"

namespace meshless_cutting {

/// Positions of the lattice vertices at the two ends of the window, scene frame. Vertices of the skin are the drawn
/// ones; inside the object a vertex gets a position only when one is asked for. Windows of consecutive frames chain
/// without a gap, also where a vertex was mapped anew: its window starts where it was published.
///
/// For the search alone every vertex stands off its place by a constant vector of its own, a millionth of the lattice
/// size. A blade that runs exactly through vertices or along links, as one guided along the axes of a block does, then
/// passes each vertex on one side instead of touching, and so cutting, all links around it.
class LatticeMotion {
 public:
  LatticeMotion(const Lattice& lattice, const CutSurface& surface, const IntegrationPoints& points,
                const ShapeFunctions& shape, const Tissue& tissue);

  /// After the frame's advance: particle and surface positions at both ends of the window of the next frame.
  void SetWindow(const std::vector<Eigen::Vector3d>* particles_t0, const std::vector<Eigen::Vector3d>* particles_t1,
                 const std::vector<Eigen::Vector3d>* surface_t0, const std::vector<Eigen::Vector3d>* surface_t1);

  /// During a cut, before the tissue's particles change: the blocks of `points` were split or lost material. Inner
  /// vertices that the graph no longer joins to their point keep where they are (`particles`: positions now) as the
  /// start of the next window.
  void KeepStarts(const std::vector<int>& points, const std::vector<Eigen::Vector3d>& particles);
  /// After it: maps those anew, and follows the particles of all `points` whose links changed.
  void Remap(const std::vector<int>& points);
  /// Forgets what KeepStarts() kept; call when a window has been searched.
  void ForgetStarts();

  Eigen::Vector3d Start(int vertex) const;
  Eigen::Vector3d End(int vertex) const;

  // For the broad phase: vertices that are mapped on the same integration point form a block.
  int block(int vertex) const { return mapping_.point(vertex); }
  int block_count() const { return static_cast<int>(block_vertices_.size()); }
  const std::vector<int>& block_vertices(int block) const { return block_vertices_[block]; }
  /// Blocks that some lattice edge leads to from this one (a superset: never shrinks). Sorted.
  const std::vector<int>& block_neighbours(int block) const { return block_neighbours_[block]; }
  /// Particles that bound the vertices of a block, but for its loose ones.
  const int* block_particles(int block) const {
    return &tissue_->point_particles[static_cast<size_t>(block) * tissue_->support_size];
  }
  int support_size() const { return tissue_->support_size; }
  /// Vertices of a block that its particles do not bound: those of the skin, and those mapped from outside a cell.
  const std::vector<int>& block_loose(int block) const { return block_loose_[block]; }
  /// How far a vertex can be outside the bounds of its block, m.
  double slack() const { return 4 * offset_size_; }
  /// Skin vertex of the drawn surface, -1 inside.
  int SurfaceVertex(int vertex) const { return surface_->VertexOf(vertex); }
  const std::vector<Eigen::Vector3d>& surface_t0() const { return *surface_t0_; }
  const std::vector<Eigen::Vector3d>& surface_t1() const { return *surface_t1_; }
  const std::vector<Eigen::Vector3d>& particles_t0() const { return *particles_t0_; }
  const std::vector<Eigen::Vector3d>& particles_t1() const { return *particles_t1_; }

  const VertexMapping& mapping() const { return mapping_; }

 private:
  void Enter(int vertex);
  void Leave(int vertex);
  void Link(int vertex);

  const Lattice* lattice_;
  const CutSurface* surface_;
  const Tissue* tissue_;
  double offset_size_;                   // m
  std::vector<Eigen::Vector3d> offset_;  // per vertex, m
  VertexMapping mapping_;                // all lattice vertices; those of the skin use it for their block alone
  std::vector<std::vector<int>> block_vertices_, block_loose_, block_neighbours_;
  std::vector<int> lost_;                              // vertices to be mapped anew
  std::vector<std::pair<int, Eigen::Vector3d>> kept_;  // sorted by vertex
  const std::vector<Eigen::Vector3d>*particles_t0_ = nullptr, *particles_t1_ = nullptr;
  const std::vector<Eigen::Vector3d>*surface_t0_ = nullptr, *surface_t1_ = nullptr;
};

}  // namespace meshless_cutting
