// Step 2 of the frame: which uncut links the blades cross.
#pragma once

#include <cstdint>
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

/// Searches uncut links near the blade. All buffers are kept between frames.
class CrossingFinder {
 public:
  CrossingFinder(const Lattice& lattice, const MaterialGraph& graph);

  /// Crossings of one blade in one frame, at most one per link (the earliest), sorted by link. Valid until the next
  /// call.
  const std::vector<Crossing>& Find(const BladeMotion& blade, const LatticeMotion& object);

 private:
  struct Aabb {
    Eigen::Vector3d min, max;
  };
  void FindNearBlocks(const Aabb& box, const LatticeMotion& object);
  void TestLink(int link, const BladeMotion& blade, const Aabb& box, const LatticeMotion& object);
  const std::pair<Eigen::Vector3d, Eigen::Vector3d>& Motion(int vertex, const LatticeMotion& object);

  const Lattice* lattice_;
  const MaterialGraph* graph_;
  std::vector<Crossing> found_;
  std::vector<std::uint8_t> particle_code_, surface_code_, block_code_, near_;
  std::vector<int> near_blocks_;
  std::vector<std::uint32_t> stamp_;  // per vertex: search in which its motion was evaluated
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> motion_;
  std::uint32_t search_ = 0;
};

}  // namespace meshless_cutting
