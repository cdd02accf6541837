#include "crossing/motion_blocks.h"

#include <algorithm>
#include <array>
#include <utility>

namespace meshless_cutting {
namespace {

/// Cells per axis in a group. Larger: fewer groups to look at in every frame; smaller: fewer blocks near the blade.
/// Measured with cut_benchmark: 2 is better up to some 160,000 links, 3 at 380,000.
int GroupCells(const BackgroundGrid& grid) { return grid.cell_count() > 8000 ? 3 : 2; }

/// Of a way kept in single precision, half a unit in its last place and a margin.
constexpr double kWayRounding = 0x1p-23;

/// Of some particles, four at a time, so that none waits for the minimum before it.
template <typename Ways>
Ways BoundWays(const std::vector<int>& particles, const std::vector<Eigen::Array4f>& way) {
  std::array<Ways, 4> ways;
  size_t k = 0;
  for (; k + 4 <= particles.size(); k += 4)
    for (size_t i = 0; i < 4; ++i) ways[i].Add(way[static_cast<size_t>(particles[k + i])]);
  for (; k < particles.size(); ++k) ways[0].Add(way[static_cast<size_t>(particles[k])]);
  for (size_t i = 1; i < 4; ++i) ways[0].Add(ways[i]);
  return ways[0];
}

/// How far the ways are from `middle` at most, along any axis.
template <typename Ways>
double Deviation(const Ways& ways, const Eigen::Array3d& middle) {
  const Eigen::Array3d low = ways.low.template head<3>().template cast<double>();
  const Eigen::Array3d high = ways.high.template head<3>().template cast<double>();
  return (high - middle).max(middle - low).maxCoeff() + kWayRounding * low.abs().max(high.abs()).maxCoeff();
}

void InsertSorted(std::vector<int>& values, int value) {
  const auto at = std::lower_bound(values.begin(), values.end(), value);
  if (at == values.end() || *at != value) values.insert(at, value);
}

void SortUnique(std::vector<int>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

Eigen::Vector3i GroupsOf(const BackgroundGrid& grid) {
  return (grid.cells().array() + GroupCells(grid) - 1) / GroupCells(grid);
}

}  // namespace

MotionBlocks::MotionBlocks(const Lattice& lattice, const BackgroundGrid& grid)
    : lattice_(&lattice), grid_(&grid), block_of_(lattice.vertices.size(), -1), groups_(GroupsOf(grid).prod()) {}

int MotionBlocks::GroupAt(int cell) const {
  const Eigen::Vector3i g = grid_->CellCoordinates(cell) / GroupCells(*grid_), count = GroupsOf(*grid_);
  return g[0] + count[0] * (g[1] + count[1] * g[2]);
}

void MotionBlocks::Assign(int vertex, int block, int cell, double overshoot) {
  if (static_cast<size_t>(block) >= blocks_.size()) blocks_.resize(block + 1);
  MotionBlock& to = blocks_[block];
  if (to.group < 0) {
    to.group = GroupAt(cell);
    groups_[to.group].blocks.push_back(block);
    outdated_.push_back(to.group);
  }
  groups_[to.group].overshoot = std::max(groups_[to.group].overshoot, overshoot);
  const int from = std::exchange(block_of_[vertex], block);
  if (from == block) return;
  if (from >= 0) {
    std::vector<int>& left = blocks_[from].vertices;
    left.erase(std::find(left.begin(), left.end(), vertex));
  }
  to.vertices.push_back(vertex);
}

void MotionBlocks::Connect(int vertex) {
  MotionBlock& own = blocks_[block_of_[vertex]];
  ++own.version;
  for (const int* l = lattice_->vertex_links.begin(vertex); l != lattice_->vertex_links.end(vertex); ++l) {
    const auto& [a, b] = lattice_->links[*l];
    MotionBlock& other = blocks_[block_of_[a == vertex ? b : a]];
    if (b == vertex) ++other.version;
    if (own.group == other.group) continue;
    const auto& [g, h] = std::minmax(own.group, other.group);
    InsertSorted(groups_[g].later_neighbours, h);
  }
}

void MotionBlocks::Regroup(const std::vector<int>& blocks, const Tissue& tissue) {
  std::vector<int> changed;
  changed.swap(outdated_);
  for (int b : blocks)
    if (static_cast<size_t>(b) < blocks_.size() && blocks_[b].group >= 0) changed.push_back(blocks_[b].group);
  SortUnique(changed);
  for (int g : changed) {
    MotionGroup& group = groups_[g];
    group.particles.clear();
    for (int b : group.blocks) {
      const int* particles = &tissue.point_particles[static_cast<size_t>(b) * tissue.support_size];
      group.particles.insert(group.particles.end(), particles, particles + tissue.support_size);
    }
    SortUnique(group.particles);
    ++group.version;
  }
}

void MotionBlocks::AddTravel(const std::vector<Eigen::Vector3d>& particles_t0,
                             const std::vector<Eigen::Vector3d>& particles_t1) {
  way_.resize(particles_t1.size());
  for (size_t j = 0; j < particles_t1.size(); ++j) {
    const Eigen::Vector3d way = particles_t1[j] - particles_t0[j];
    way_[j] = Eigen::Array4d(way[0], way[1], way[2], 0).cast<float>();
  }
  ways_.assign(groups_.size(), Ways());
  for (size_t g = 0; g < groups_.size(); ++g) ways_[g] = BoundWays<Ways>(groups_[g].particles, way_);
  reach_ways_ = ways_;
  for (size_t g = 0; g < groups_.size(); ++g)
    for (int n : groups_[g].later_neighbours) {
      reach_ways_[g].Add(ways_[static_cast<size_t>(n)]);
      reach_ways_[static_cast<size_t>(n)].Add(ways_[g]);
    }
  for (size_t g = 0; g < groups_.size(); ++g) {
    MotionGroup& group = groups_[g];
    if (group.particles.empty()) continue;
    const Eigen::Array3d middle =
        0.5 * (ways_[g].low.head<3>().cast<double>() + ways_[g].high.head<3>().cast<double>());
    group.drift_t0 = group.drift_t1;
    group.drift_t1 += middle.matrix();
    group.travel += Deviation(ways_[g], middle);
    group.reach_travel += Deviation(reach_ways_[g], middle);
  }
}

}  // namespace meshless_cutting
