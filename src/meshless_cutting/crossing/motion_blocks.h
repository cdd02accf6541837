// The broad phase's view of the lattice: vertices gathered in blocks, blocks in groups. Bounds of a group come from the
// particles that its vertices follow, those of a block from its links, so that a search touches single vertices only
// near a blade.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "lattice/lattice.h"
#include "tissue/background_grid.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

/// The lattice vertices that follow one integration point, with the links of which they are the first vertex.
struct MotionBlock {
  std::vector<int> vertices;
  int group = -1;
  std::uint32_t version = 0;  // +1 whenever its vertices change, or where some vertex of its links is mapped
};

/// The blocks in some 2 x 2 x 2 cells of the background grid.
struct MotionGroup {
  std::vector<int> blocks;
  std::vector<int> particles;         // of all its blocks
  std::vector<int> later_neighbours;  // groups of higher index that some link leads to, sorted; never shrinks
  /// A vertex is at most this share of the extent of the particles' bounds outside these bounds, per axis.
  double overshoot = 0;
  std::uint32_t version = 0;  // +1 whenever blocks or particles change
  /// How far it has moved: the middle of the ways of its particles, summed over all windows but the last, and over
  /// all, m.
  Eigen::Vector3d drift_t0 = Eigen::Vector3d::Zero(), drift_t1 = Eigen::Vector3d::Zero();
  /// Upper bounds of the way beside this that any of its particles has moved along any axis, summed over all windows,
  /// m; and of the ways of those of all vertices of the links from and to its blocks.
  double travel = 0, reach_travel = 0;
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
  /// The particles moved from t0 to t1 in a new window, m.
  void AddTravel(const std::vector<Eigen::Vector3d>& particles_t0, const std::vector<Eigen::Vector3d>& particles_t1);
  /// The present window of a vertex does not start where its particles were.
  void MarkAstray(int vertex) { astray_.push_back(vertex); }
  void ForgetAstray() { astray_.clear(); }

  int block_of(int vertex) const { return block_of_[vertex]; }
  const std::vector<MotionBlock>& blocks() const { return blocks_; }
  const std::vector<MotionGroup>& groups() const { return groups_; }
  const std::vector<int>& astray() const { return astray_; }

 private:
  int GroupAt(int cell) const;

  const Lattice* lattice_;
  const BackgroundGrid* grid_;
  std::vector<int> block_of_;  // per lattice vertex
  std::vector<MotionBlock> blocks_;
  std::vector<MotionGroup> groups_;
  std::vector<int> astray_;    // vertices
  std::vector<int> outdated_;  // groups with new blocks
  // In the last window, m, in single precision: half to read, the rounding goes to the travel. The fourth entry is
  // there for packed instructions alone.
  struct Ways {
    Eigen::Array4f low = Eigen::Array4f::Constant(std::numeric_limits<float>::infinity()), high = -low;
    void Add(const Eigen::Array4f& way) {
      low = low.min(way);
      high = high.max(way);
    }
    void Add(const Ways& other) {
      low = low.min(other.low);
      high = high.max(other.high);
    }
  };
  std::vector<Eigen::Array4f> way_;      // per particle
  std::vector<Ways> ways_, reach_ways_;  // per group: of its particles; of its neighbours' too
};

}  // namespace meshless_cutting
