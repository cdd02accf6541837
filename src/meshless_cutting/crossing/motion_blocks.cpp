#include "crossing/motion_blocks.h"

#include <algorithm>
#include <utility>

namespace meshless_cutting {
namespace {

/// Cells per axis in a group. Larger: fewer groups to look at in every frame; smaller: fewer blocks near the blade.
/// Measured with cut_benchmark: 2 is better up to some 160,000 links, 3 at 380,000.
int GroupCells(const BackgroundGrid& grid) { return grid.cell_count() > 8000 ? 3 : 2; }

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
  to.overshoot = std::max(to.overshoot, overshoot);
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
  const int p = block_of_[vertex];
  for (const int* l = lattice_->vertex_links.begin(vertex); l != lattice_->vertex_links.end(vertex); ++l) {
    const auto& [a, b] = lattice_->links[*l];
    const int q = block_of_[a == vertex ? b : a];
    if (p == q) continue;
    InsertSorted(blocks_[p].neighbours, q);
    InsertSorted(blocks_[q].neighbours, p);
    const int g = blocks_[p].group, h = blocks_[q].group;
    if (g == h) continue;
    InsertSorted(groups_[std::min(g, h)].later_neighbours, std::max(g, h));
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

void MotionBlocks::MarkAstray(int vertex) {
  const int block = block_of_[vertex];
  std::vector<int>& astray = blocks_[block].astray;
  if (astray.empty()) with_astray_.push_back(block);
  astray.push_back(vertex);
}

void MotionBlocks::ForgetAstray() {
  for (int b : with_astray_) blocks_[b].astray.clear();
  with_astray_.clear();
}

}  // namespace meshless_cutting
