// The object: one lattice, the graph of its links, and everything that is read from the graph, kept in step by Cut().
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "crossing/lattice_motion.h"
#include "cut/cut_surface.h"
#include "cut/integration_points.h"
#include "cut/material_graph.h"
#include "cut/twins.h"
#include "scene/scene.h"
#include "surface/surface.h"
#include "surface/vertex_mapping.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

/// Topology, mapping and state of the tissue. Not movable: its parts refer to each other.
class SoftBody {
 public:
  /// `lattice` outlives the body. With `can_be_cut` false nothing is built for the crossing search.
  SoftBody(const Lattice& lattice, const ObjectConfig& config, bool can_be_cut);
  SoftBody(const SoftBody&) = delete;
  SoftBody& operator=(const SoftBody&) = delete;

  /// Step 3 of the frame. Cuts the links (each not cut before) and brings surface, points, twins and mapping after it.
  void Cut(const std::vector<LinkCut>& cuts) {
    CutMaterial(cuts);
    Redraw(cuts);
  }
  /// Its two halves: what the dynamics reads, and what is drawn. The second may run beside Dynamics::TissueChanged().
  void CutMaterial(const std::vector<LinkCut>& cuts);
  void Redraw(const std::vector<LinkCut>& cuts);

  /// The crossing window that EndAdvance() opened has been searched; call before Cut().
  void CloseWindow();

  /// End of step 4: call before the state changes, then after it. Evaluates the drawn surface and opens the next
  /// crossing window.
  void BeginAdvance();
  void EndAdvance();

  const Lattice& lattice() const { return *lattice_; }
  const MaterialGraph& graph() const { return graph_; }
  const CutSurface& cut_surface() const { return cut_surface_; }
  const BackgroundGrid& grid() const { return grid_; }
  const ShapeFunctions& shape() const { return shape_; }
  const IntegrationPoints& points() const { return points_; }
  const Tissue& tissue() const { return tissue_; }
  /// Boxes whose particles are held where their material reaches into them, see Twins.
  const std::vector<Box>& held() const { return twins_.held(); }
  const TissueState& state() const { return state_; }
  TissueState& mutable_state() { return state_; }
  const VertexMapping& mapping() const { return mapping_; }
  /// From now on counts what the paper's mapping criteria would do without the graph; see PaperCriteria.
  void CountPaperCriteria() { mapping_.CountPaperCriteria(grid_); }
  const Surface& surface() const { return surface_; }
  const LatticeMotion& motion() const { return *motion_; }  // only where it can be cut
  /// Fragment of each integration point, numbered as in Surface.
  const std::vector<int>& point_fragment() const { return point_fragment_; }

 private:
  /// Returns the drawn vertices that were mapped anew, sorted.
  std::vector<int> MapSurface(const std::vector<LinkCut>& cuts);
  void FindFragments();

  const Lattice* lattice_;
  MaterialGraph graph_;
  CutSurface cut_surface_;
  BackgroundGrid grid_;
  ShapeFunctions shape_;
  IntegrationPoints points_;
  Tissue tissue_;
  Twins twins_;
  TissueState state_;
  VertexMapping mapping_;
  Surface surface_;
  std::vector<int> point_fragment_;
  // Of the last CutMaterial(): points that changed, those whose particles did, and the first drawn vertex that is new.
  std::vector<int> changed_points_, relinked_points_;
  int first_new_vertex_ = 0;
  std::vector<int> slot_;  // scratch of MapSurface: per drawn vertex, -1 between calls
  std::optional<LatticeMotion> motion_;
  std::vector<Eigen::Vector3d> particles_t0_, surface_t0_;  // start of the next crossing window
};

}  // namespace meshless_cutting
