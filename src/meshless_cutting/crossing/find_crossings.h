// Step 2 of the frame: which uncut links the blades cross.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "crossing/lattice_motion.h"
#include "cut/material_graph.h"
#include "tool/blade_motion.h"

namespace meshless_cutting {

/// First contact of a blade with a link during a frame.
struct Crossing {
  LinkCut cut;
  double t;               // frame time, [0, 1]
  double along_m;         // where on the blade, from the start of its polyline
  Eigen::Vector3d point;  // scene frame, m
};

/// Searches uncut links near the blade, from the coarse to the fine: groups of blocks, blocks of vertices with their
/// links, links. Each gets an outcode, eight bits that say beyond which sides of the blade's reach, a box and a slab,
/// all of it stays during the window; a link between two groups or two vertices can come within reach only where their
/// codes have no bit in common. Bounds of groups and blocks serve for many windows: they drift with their group, and
/// are widened by what its particles can have moved beside that. Buffers are kept between frames.
class CrossingFinder {
 public:
  CrossingFinder(const Lattice& lattice, const MaterialGraph& graph);

  /// Crossings of one blade in one frame, at most one per link (the earliest), sorted by link. Valid until the next
  /// call.
  const std::vector<Crossing>& Find(const BladeMotion& blade, const LatticeMotion& object);

 private:
  struct Bounds {
    Eigen::Vector3d min = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), max = -min;
  };
  /// What the blade sweeps in the frame lies within a box and within a slab: the box alone is wide where the blade goes
  /// askew to the axes.
  struct Reach {
    Bounds box;
    Eigen::Vector3d normal, abs_normal;  // of the slab, unit or zero, and its absolute values
    double low = std::numeric_limits<double>::infinity(), high = -low;  // along the normal, m
  };
  /// Bounds of what follows some particles, as they were in a window.
  struct KeptBounds {
    Bounds bounds;
    Eigen::Vector3d drift = Eigen::Vector3d::Zero();  // of the group until the end of that window, m
    double travel = 0;                                // and of the particles beside it, m
    double overshoot = 0;                             // of all vertices
    std::uint32_t version = 0;                        // of the group or block
  };
  /// Small, because those of a search lie scattered among all.
  struct PlacedVertex {
    std::uint32_t search = 0;  // the last in which it was evaluated
    std::uint32_t window = 0;  // where in windows_
    std::uint8_t code = 0;
  };
  Reach BoundBlade(const BladeMotion& blade, double slack);
  void FindNearGroups(const Reach& reach, const LatticeMotion& object);
  void SearchBlock(int block, const Reach& reach, const BladeMotion& blade, const LatticeMotion& object);
  std::uint8_t Place(int vertex, const Reach& reach, const LatticeMotion& object);
  const LatticeMotion::Window& WindowOf(int vertex) const { return windows_[placed_[vertex].window]; }
  void TestLink(int link, const BladeMotion& blade);

  const Lattice* lattice_;
  const MaterialGraph* graph_;
  double tight_;  // m
  std::vector<Crossing> found_;
  // Of the blade, in order: each window, stretches of edges in each window, each edge in each window.
  std::vector<Bounds> window_bounds_, stretch_bounds_, edge_bounds_;
  std::vector<KeptBounds> group_bounds_, block_bounds_;
  std::vector<std::uint8_t> group_code_, group_near_;
  std::vector<int> first_link_;                 // per vertex, one past the last included: links that start there
  std::vector<PlacedVertex> placed_;            // per vertex
  std::vector<LatticeMotion::Window> windows_;  // of those evaluated in this search
  std::uint32_t search_ = 0;
};

}  // namespace meshless_cutting
