#include "crossing/find_crossings.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "crossing/edge_edge.h"

namespace meshless_cutting {
namespace {

constexpr std::uint8_t kBeyondAll = 63;
/// Edges of the blade that share one more box.
constexpr size_t kEdgesTogether = 5;

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

/// The code of what moves with the particles: from bounds of an earlier window where these, widened by what particles
/// can have moved since, still lie beyond a side, else from new ones.
template <typename Kept, typename Box>
std::uint8_t CodeOf(Kept& kept, const int* particles, int count, double overshoot, std::uint32_t version,
                    const Box& box, const LatticeMotion& object) {
  auto encode = [&] {
    const double margin = (1 + 2 * overshoot) * (object.travel() - kept.travel);
    return Outcode(kept.bounds.min.array() - margin, kept.bounds.max.array() + margin, box);
  };
  if (kept.version == version) {
    const std::uint8_t code = encode();
    if (code != 0 || kept.travel == object.travel()) return code;
  }
  kept = {BoundParticles<Box>(particles, count, overshoot, object), object.travel(), version};
  return encode();
}

/// Two things apart from the box matter for the links between them only where they lie on different sides of it. What
/// lies in the box is near itself, and what lies apart is found from there.
bool AreOnBothSides(std::uint8_t a, std::uint8_t b) { return a != 0 && b != 0 && (a & b) == 0; }

/// (1 - t) x0 + t x1 gives x0 and x1 themselves at the ends, so windows meet in the same bits.
Eigen::Vector3d At(const Eigen::Vector3d& x0, const Eigen::Vector3d& x1, double t) { return (1 - t) * x0 + t * x1; }

}  // namespace

CrossingFinder::CrossingFinder(const Lattice& lattice, const MaterialGraph& graph)
    : lattice_(&lattice),
      graph_(&graph),
      vertex_code_(lattice.vertices.size()),
      placed_(lattice.vertices.size()),
      window_(lattice.vertices.size()) {
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
  stretch_bounds_.clear();
  edge_bounds_.clear();
  for (const BladeWindow& window : blade) {
    Bounds whole = nothing;
    for (size_t e = 0; e + 1 < window.points_t0.size(); ++e) {
      Bounds edge = {window.points_t0[e], window.points_t0[e]};
      for (const Eigen::Vector3d* p : {&window.points_t0[e + 1], &window.points_t1[e], &window.points_t1[e + 1]})
        add(edge, {*p, *p});
      edge_bounds_.push_back(edge);
      if (e % kEdgesTogether == 0) stretch_bounds_.push_back(nothing);
      add(stretch_bounds_.back(), edge);
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
  group_near_.assign(groups.size(), 0);
  for (size_t g = 0; g < groups.size(); ++g) {
    const MotionGroup& group = groups[g];
    if (group.blocks.empty()) continue;
    group_code_[g] = CodeOf(group_bounds_[g], group.particles.data(), static_cast<int>(group.particles.size()),
                            group.overshoot, group.version, box, object);
  }
  for (int b : object.blocks().with_astray())
    for (int v : blocks[b].astray) {
      const Eigen::Vector3d x = object.At(v).start;
      group_code_[blocks[b].group] &= Outcode(x, x, box);
    }
  for (size_t g = 0; g < groups.size(); ++g) {
    if (group_code_[g] == 0) group_near_[g] = 1;
    for (int n : groups[g].later_neighbours)
      if (AreOnBothSides(group_code_[g], group_code_[n])) group_near_[g] = group_near_[n] = 1;
  }
  near_groups_.clear();
  for (size_t g = 0; g < groups.size(); ++g)
    if (group_near_[g]) near_groups_.push_back(static_cast<int>(g));
}

void CrossingFinder::Encode(int b, const Bounds& box, const LatticeMotion& object) {
  Block& block = blocks_[b];
  block.coded = search_;
  const MotionBlock& moving = object.blocks().blocks()[b];
  const MotionGroup& group = object.blocks().groups()[moving.group];
  block.code = group_code_[moving.group];
  if (group_near_[moving.group]) {
    block.code |= CodeOf(block.kept, object.block_particles(b), object.support_size(), moving.overshoot, group.version,
                         box, object);
  }
  for (int v : moving.astray) {
    const Eigen::Vector3d x = object.At(v).start;
    block.code &= Outcode(x, x, box);
  }
}

void CrossingFinder::FindNearBlocks(const Bounds& box, const LatticeMotion& object) {
  const auto& blocks = object.blocks().blocks();
  const auto& groups = object.blocks().groups();
  blocks_.resize(blocks.size());
  near_blocks_.clear();
  auto code_of = [&](int b) {
    if (blocks_[b].coded != search_) Encode(b, box, object);
    return blocks_[b].code;
  };
  for (int g : near_groups_)
    for (int b : groups[g].blocks) {
      const std::uint8_t code = code_of(b);
      const auto& neighbours = blocks[b].neighbours;
      if (code != 0 &&
          std::none_of(neighbours.begin(), neighbours.end(), [&](int n) { return AreOnBothSides(code, code_of(n)); }))
        continue;
      blocks_[b].near = search_;
      near_blocks_.push_back(b);
    }
  // A vertex has the code of its block until it is placed.
  auto spread = [&](int b) {
    if (std::exchange(blocks_[b].spread, search_) == search_) return;
    const std::uint8_t code = code_of(b);
    for (int v : blocks[b].vertices) vertex_code_[v] = code;
  };
  for (int b : near_blocks_) {
    spread(b);
    for (int n : blocks[b].neighbours) spread(n);
  }
}

/// Evaluates the window of a vertex, if that was not done yet, and gives it its own code.
std::uint8_t CrossingFinder::Place(int vertex, const Bounds& box, const LatticeMotion& object) {
  if (std::exchange(placed_[vertex], search_) != search_) {
    const auto& [start, end] = window_[vertex] = object.At(vertex);
    vertex_code_[vertex] = Outcode(start.cwiseMin(end), start.cwiseMax(end), box);
  }
  return vertex_code_[vertex];
}

void CrossingFinder::TestLink(int link, const BladeMotion& blade) {
  const LatticeMotion::Window &a = window_[lattice_->links[link][0]], &b = window_[lattice_->links[link][1]];
  const Eigen::Vector3d low = a.start.cwiseMin(a.end).cwiseMin(b.start).cwiseMin(b.end);
  const Eigen::Vector3d high = a.start.cwiseMax(a.end).cwiseMax(b.start).cwiseMax(b.end);
  const Bounds *edge_bounds = edge_bounds_.data(), *stretch_bounds = stretch_bounds_.data();
  for (size_t w = 0; w < blade.size(); ++w) {
    const BladeWindow& window = blade[w];
    const size_t edges = window.points_t0.size() - 1;
    const Bounds* bounds = std::exchange(edge_bounds, edge_bounds + edges);
    const Bounds* stretches =
        std::exchange(stretch_bounds, stretch_bounds + (edges + kEdgesTogether - 1) / kEdgesTogether);
    if (Outcode(low, high, window_bounds_[w]) != 0) continue;
    const MovingSegment object_edge = {At(a.start, a.end, window.t0), At(b.start, b.end, window.t0),
                                       At(a.start, a.end, window.t1), At(b.start, b.end, window.t1)};
    Crossing first;
    bool hit = false;
    for (size_t e = 0; e < edges; ++e) {
      if (e % kEdgesTogether == 0 && Outcode(low, high, stretches[e / kEdgesTogether]) != 0) {
        e += kEdgesTogether - 1;
        continue;
      }
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
      std::uint8_t code = vertex_code_[a];
      for (int i = lattice_->vertex_links.offsets[a]; i < lattice_->vertex_links.offsets[a + 1]; ++i) {
        const int b = far_end_[i];
        if ((code & vertex_code_[b]) != 0) continue;
        if (b < a && blocks_[blocks.block_of(b)].near == search_) continue;  // its turn comes from the other end
        const int link = lattice_->vertex_links.items[i];
        if (graph_->IsCut(link)) continue;
        code = Place(a, box, object);
        if ((code & vertex_code_[b]) == 0 && (code & Place(b, box, object)) == 0) TestLink(link, blade);
      }
    }
  std::sort(found_.begin(), found_.end(), [](const Crossing& p, const Crossing& q) { return p.cut.link < q.cut.link; });
  return found_;
}

}  // namespace meshless_cutting
