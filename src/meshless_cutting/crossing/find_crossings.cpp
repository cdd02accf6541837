#include "crossing/find_crossings.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "crossing/edge_edge.h"

namespace meshless_cutting {
namespace {

constexpr std::uint8_t kBeyondAll = 63;

/// Six bits, one per side of the box [min, max] that all of [low, high] lies beyond (Cohen-Sutherland).
template <typename Box>
std::uint8_t Outcode(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Box& box) {
  return static_cast<std::uint8_t>((high[0] < box.min[0]) | (low[0] > box.max[0]) << 1 | (high[1] < box.min[1]) << 2 |
                                   (low[1] > box.max[1]) << 3 | (high[2] < box.min[2]) << 4 |
                                   (low[2] > box.max[2]) << 5);
}

/// Bounds of particles at both ends of the window, widened by `overshoot` times their extent.
template <typename Box>
Box BoundParticles(const int* particles, int count, double overshoot, const LatticeMotion& object) {
  const Eigen::Vector3d *x0 = object.particles_t0().data(), *x1 = object.particles_t1().data();
  // Eigen's three-vectors are not packed; two halves of four lanes would be, at the price of another copy.
  double low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) low[axis] = high[axis] = x0[particles[0]][axis];
  for (int k = 0; k < count; ++k) {
    const double *a = x0[particles[k]].data(), *b = x1[particles[k]].data();
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], std::min(a[axis], b[axis]));
      high[axis] = std::max(high[axis], std::max(a[axis], b[axis]));
    }
  }
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const double margin = overshoot * (high[axis] - low[axis]);
    box.min[axis] = low[axis] - margin;
    box.max[axis] = high[axis] + margin;
  }
  return box;
}

/// Something apart from the box matters for its links to something else on another side. Links between it and what
/// lies in the box are found from there.
bool IsNear(std::uint8_t code, const std::vector<int>& neighbours, const std::vector<std::uint8_t>& codes) {
  if (code == 0) return true;
  for (int n : neighbours)
    if (codes[n] != 0 && (code & codes[n]) == 0) return true;
  return false;
}

/// (1 - t) x0 + t x1 gives x0 and x1 themselves at the ends, so windows meet in the same bits.
Eigen::Vector3d At(const Eigen::Vector3d& x0, const Eigen::Vector3d& x1, double t) { return (1 - t) * x0 + t * x1; }

}  // namespace

CrossingFinder::CrossingFinder(const Lattice& lattice, const MaterialGraph& graph)
    : lattice_(&lattice), graph_(&graph), vertices_(lattice.vertices.size()) {
  for (size_t v = 0; v < lattice.vertices.size(); ++v)
    for (const int* l = lattice.vertex_links.begin(static_cast<int>(v));
         l != lattice.vertex_links.end(static_cast<int>(v)); ++l)
      far_end_.push_back(lattice.links[*l][lattice.links[*l][0] == static_cast<int>(v)]);
}

CrossingFinder::Bounds CrossingFinder::BoundBlade(const BladeMotion& blade) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Bounds nothing = {Eigen::Vector3d::Constant(kInfinity), Eigen::Vector3d::Constant(-kInfinity)};
  auto add = [](Bounds& bounds, const Bounds& other) {
    bounds.min = bounds.min.cwiseMin(other.min);
    bounds.max = bounds.max.cwiseMax(other.max);
  };
  Bounds all = nothing;
  window_bounds_.clear();
  edge_bounds_.clear();
  for (const BladeWindow& window : blade) {
    Bounds whole = nothing;
    for (size_t e = 0; e + 1 < window.points_t0.size(); ++e) {
      Bounds edge = {window.points_t0[e], window.points_t0[e]};
      for (const Eigen::Vector3d* p : {&window.points_t0[e + 1], &window.points_t1[e], &window.points_t1[e + 1]})
        add(edge, {*p, *p});
      edge_bounds_.push_back(edge);
      add(whole, edge);
    }
    window_bounds_.push_back(whole);
    add(all, whole);
  }
  return all;
}

void CrossingFinder::FindNearGroups(const Bounds& box, const LatticeMotion& object) {
  const auto& groups = object.blocks().groups();
  const auto& blocks = object.blocks().blocks();
  group_bounds_.resize(groups.size());
  group_code_.assign(groups.size(), kBeyondAll);
  near_groups_.clear();
  for (size_t g = 0; g < groups.size(); ++g) {
    const MotionGroup& group = groups[g];
    if (group.blocks.empty()) continue;
    GroupBounds& kept = group_bounds_[g];
    auto encode = [&] {
      const double margin = (1 + 2 * group.overshoot) * (object.travel() - kept.travel);
      return Outcode(kept.bounds.min.array() - margin, kept.bounds.max.array() + margin, box);
    };
    std::uint8_t code = kept.version == group.version ? encode() : 0;
    if (code == 0 && !(kept.version == group.version && kept.travel == object.travel())) {
      kept = {BoundParticles<Bounds>(group.particles.data(), static_cast<int>(group.particles.size()), group.overshoot,
                                     object),
              object.travel(), group.version};
      code = encode();
    }
    group_code_[g] = code;
  }
  for (int b : object.blocks().with_astray())
    for (int v : blocks[b].astray) {
      const Eigen::Vector3d x = object.At(v).start;
      group_code_[blocks[b].group] &= Outcode(x, x, box);
    }
  for (size_t g = 0; g < groups.size(); ++g)
    if (!groups[g].blocks.empty() && IsNear(group_code_[g], groups[g].neighbours, group_code_))
      near_groups_.push_back(static_cast<int>(g));
}

std::uint8_t CrossingFinder::BlockCode(int b, const Bounds& box, const LatticeMotion& object) {
  const MotionBlock& block = object.blocks().blocks()[b];
  const int *particles = object.block_particles(b), count = object.support_size();
  std::uint8_t code = kBeyondAll;
  for (int k = 0; k < count; ++k) {
    const int j = particles[k];
    if (std::exchange(particle_search_[j], search_) != search_) {
      const Eigen::Vector3d &x0 = object.particles_t0()[j], &x1 = object.particles_t1()[j];
      particle_code_[j] = Outcode(x0.cwiseMin(x1), x0.cwiseMax(x1), box);
    }
    code &= particle_code_[j];
  }
  if (code != 0 && block.overshoot > 0) {
    const Bounds bounds = BoundParticles<Bounds>(particles, count, block.overshoot, object);
    code = Outcode(bounds.min, bounds.max, box);
  }
  for (int v : block.astray) {
    const Eigen::Vector3d x = object.At(v).start;
    code &= Outcode(x, x, box);
  }
  return code;
}

void CrossingFinder::FindNearBlocks(const Bounds& box, const LatticeMotion& object) {
  const auto& blocks = object.blocks().blocks();
  const auto& groups = object.blocks().groups();
  block_code_.resize(blocks.size());
  for (size_t b = 0; b < blocks.size(); ++b) block_code_[b] = blocks[b].group < 0 ? kBeyondAll : group_code_[blocks[b].group];
  particle_code_.resize(object.particles_t1().size());
  particle_search_.resize(object.particles_t1().size(), 0);
  for (int g : near_groups_)
    for (int b : groups[g].blocks) block_code_[b] = BlockCode(b, box, object);
  block_near_.assign(blocks.size(), 0);
  near_blocks_.clear();
  for (int g : near_groups_)
    for (int b : groups[g].blocks)
      if (IsNear(block_code_[b], blocks[b].neighbours, block_code_)) {
        block_near_[b] = 1;
        near_blocks_.push_back(b);
      }
}

const CrossingFinder::MovingVertex& CrossingFinder::Place(int vertex, const Bounds& box, const LatticeMotion& object) {
  MovingVertex& moving = vertices_[vertex];
  if (moving.search != search_) {
    moving.search = search_;
    moving.window = object.At(vertex);
    const auto& [start, end] = moving.window;
    moving.code = Outcode(start.cwiseMin(end), start.cwiseMax(end), box);
  }
  return moving;
}

void CrossingFinder::TestLink(int link, const BladeMotion& blade) {
  const LatticeMotion::Window &a = vertices_[lattice_->links[link][0]].window,
                              &b = vertices_[lattice_->links[link][1]].window;
  const Eigen::Vector3d low = a.start.cwiseMin(a.end).cwiseMin(b.start).cwiseMin(b.end);
  const Eigen::Vector3d high = a.start.cwiseMax(a.end).cwiseMax(b.start).cwiseMax(b.end);
  const Bounds* edge_bounds = edge_bounds_.data();
  for (size_t w = 0; w < blade.size(); ++w) {
    const BladeWindow& window = blade[w];
    const size_t edges = window.points_t0.size() - 1;
    const Bounds* bounds = std::exchange(edge_bounds, edge_bounds + edges);
    if (Outcode(low, high, window_bounds_[w]) != 0) continue;
    const MovingSegment object_edge = {At(a.start, a.end, window.t0), At(b.start, b.end, window.t0),
                                       At(a.start, a.end, window.t1), At(b.start, b.end, window.t1)};
    Crossing first;
    bool hit = false;
    for (size_t e = 0; e < edges; ++e) {
      if (Outcode(low, high, bounds[e]) != 0) continue;
      const MovingSegment blade_edge = {window.points_t0[e], window.points_t0[e + 1], window.points_t1[e],
                                        window.points_t1[e + 1]};
      const auto crossing = FindFirstCrossing(blade_edge, object_edge);
      if (!crossing) continue;
      const double t = window.t0 + crossing->t * (window.t1 - window.t0);
      if (hit && first.t <= t) continue;
      hit = true;
      double along = crossing->u * (blade_edge.q_t1 - blade_edge.p_t1).norm();
      for (size_t i = 0; i < e; ++i) along += (window.points_t1[i + 1] - window.points_t1[i]).norm();
      const Eigen::Vector3d p = At(object_edge.p_t0, object_edge.p_t1, crossing->t);
      const Eigen::Vector3d q = At(object_edge.q_t0, object_edge.q_t1, crossing->t);
      first = {{link, crossing->v}, t, along, At(p, q, crossing->v)};
    }
    if (hit) {
      found_.push_back(first);
      return;
    }
  }
}

const std::vector<Crossing>& CrossingFinder::Find(const BladeMotion& blade, const LatticeMotion& object) {
  found_.clear();
  if (blade.empty()) return found_;
  ++search_;
  Bounds box = BoundBlade(blade);
  // Vertices may leave the bounds of their particles by rounding and by their offset.
  const double slack = object.slack() + 1e-12 * box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  box.min.array() -= slack;
  box.max.array() += slack;
  FindNearGroups(box, object);
  FindNearBlocks(box, object);
  const MotionBlocks& blocks = object.blocks();
  for (int block : near_blocks_)
    for (int a : blocks.blocks()[block].vertices) {
      const std::uint8_t code = Place(a, box, object).code;
      for (int i = lattice_->vertex_links.offsets[a]; i < lattice_->vertex_links.offsets[a + 1]; ++i) {
        const int b = far_end_[i], other = blocks.block_of(b);
        if (block_near_[other] && b < a) continue;  // its turn comes from the other end
        if ((code & block_code_[other]) != 0 || (code & Place(b, box, object).code) != 0) continue;
        if (const int link = lattice_->vertex_links.items[i]; !graph_->IsCut(link)) TestLink(link, blade);
      }
    }
  std::sort(found_.begin(), found_.end(), [](const Crossing& p, const Crossing& q) { return p.cut.link < q.cut.link; });
  return found_;
}

}  // namespace meshless_cutting
