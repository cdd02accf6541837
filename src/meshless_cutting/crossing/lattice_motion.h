// Where lattice vertices were published last and where they are now: the object's half of a crossing window.
#pragma once

#include <utility>
#include <vector>

#include "crossing/motion_blocks.h"
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
  /// `drawn` maps the vertices of `surface`.
  LatticeMotion(const Lattice& lattice, const CutSurface& surface, const VertexMapping& drawn,
                const IntegrationPoints& points, const BackgroundGrid& grid, const ShapeFunctions& shape,
                const Tissue& tissue);

  /// After the frame's advance: particle and surface positions at both ends of the window of the next frame.
  void SetWindow(const std::vector<Eigen::Vector3d>* particles_t0, const std::vector<Eigen::Vector3d>* particles_t1,
                 const std::vector<Eigen::Vector3d>* surface_t0, const std::vector<Eigen::Vector3d>* surface_t1);

  /// During a cut, before the tissue's particles change: the blocks of `points` were split or lost material. Inner
  /// vertices that the graph no longer joins to their point keep where they are (`particles`: positions now) as the
  /// start of the next window.
  void KeepStarts(const std::vector<int>& points, const std::vector<Eigen::Vector3d>& particles);
  /// After it: maps those anew, follows the particles of all `points` whose links changed, and the drawn vertices
  /// `redrawn` that were mapped anew.
  void Remap(const std::vector<int>& points, const std::vector<int>& redrawn);
  /// Forgets what KeepStarts() kept; call when a window has been searched.
  void ForgetStarts();

  /// Positions at the two ends of the window, m, scene frame.
  struct Window {
    Eigen::Vector3d start, end;
  };
  Window At(int vertex) const;
  /// How far a vertex can be outside the bounds of its particles, as a share of their extent.
  double Overshoot(int vertex) const {
    const int s = surface_->VertexOf(vertex);
    return s >= 0 ? drawn_->overshoot(s) : inner_.overshoot(vertex);
  }

  const MotionBlocks& blocks() const { return blocks_; }
  /// How far vertices can be outside the bounds of their particles beside their overshoot.
  double slack() const { return 4 * offset_size_; }  // m
  const std::vector<Eigen::Vector3d>& particles_t0() const { return *particles_t0_; }
  const std::vector<Eigen::Vector3d>& particles_t1() const { return *particles_t1_; }

 private:
  void Place(int vertex);

  const CutSurface* surface_;
  const VertexMapping* drawn_;
  const IntegrationPoints* points_;
  const Tissue* tissue_;
  double offset_size_;                   // m
  std::vector<Eigen::Vector3d> offset_;  // per vertex, m
  VertexMapping inner_;                  // lattice vertices inside the object; those of the skin stay unmapped
  MotionBlocks blocks_;
  std::vector<int> lost_;                              // inner vertices to be mapped anew
  std::vector<std::pair<int, Eigen::Vector3d>> kept_;  // where they were
  std::vector<int> kept_of_;                           // per vertex, index there, -1: none
  const std::vector<Eigen::Vector3d>*particles_t0_ = nullptr, *particles_t1_ = nullptr;
  const std::vector<Eigen::Vector3d>*surface_t0_ = nullptr, *surface_t1_ = nullptr;
};

}  // namespace meshless_cutting
