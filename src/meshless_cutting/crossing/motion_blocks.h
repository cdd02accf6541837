// The broad phase's view of the lattice: vertices gathered in blocks, blocks in groups. Bounds of a group or a block
// come from the particles that its vertices follow, so that a search touches single vertices only near a blade.
#pragma once

#include <cstdint>
#include <vector>

#include "lattice/lattice.h"
#include "tissue/background_grid.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

/// The lattice vertices that follow one integration point.
struct MotionBlock {
  std::vector<int> vertices;
  std::vector<int> astray;      // those of them whose present window does not start where their particles were
  std::vector<int> neighbours;  // blocks that some lattice edge leads to, sorted; a superset: never shrinks
  /// A vertex is at most this share of the extent of the particles' bounds outside these bounds, per axis.
  double overshoot = 0;
  int group = -1;
};

/// The blocks in some 2 x 2 x 2 cells of the background grid.
struct MotionGroup {
  std::vector<int> blocks;
  std::vector<int> particles;   // of all its blocks
  std::vector<int> later_neighbours;  // groups of higher index that some lattice edge leads to, as above
  double overshoot = 0;         // the largest of its blocks
  std::uint32_t version = 0;    // +1 whenever blocks or particles change
};

class MotionBlocks {
 public:
  MotionBlocks(const Lattice& lattice, const BackgroundGrid& grid);

  /// `vertex` follows integration point `block` in `cell`, with an overshoot, from now on.
  void Assign(int vertex, int block, int cell, double overshoot);
  /// Call when the vertex and its neighbours in the lattice have their blocks.
  void Connect(int vertex);
  /// Gathers the particles of the groups of `blocks` anew: their supports changed. Call after every Assign().
  void Regroup(const std::vector<int>& blocks, const Tissue& tissue);
  void MarkAstray(int vertex);
  void ForgetAstray();

  int block_of(int vertex) const { return block_of_[vertex]; }
  const std::vector<MotionBlock>& blocks() const { return blocks_; }
  const std::vector<MotionGroup>& groups() const { return groups_; }
  /// Blocks that have astray vertices.
  const std::vector<int>& with_astray() const { return with_astray_; }

 private:
  int GroupAt(int cell) const;

  const Lattice* lattice_;
  const BackgroundGrid* grid_;
  std::vector<int> block_of_;  // per lattice vertex
  std::vector<MotionBlock> blocks_;
  std::vector<MotionGroup> groups_;
  std::vector<int> with_astray_;  // blocks
  std::vector<int> outdated_;     // groups with new blocks
};

}  // namespace meshless_cutting
