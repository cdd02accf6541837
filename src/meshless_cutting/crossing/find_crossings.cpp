#include "crossing/find_crossings.h"

#include <algorithm>
#include <utility>

#include "crossing/edge_edge.h"

namespace meshless_cutting {
namespace {

constexpr std::uint8_t kBeyondAll = 63;
/// Bounds of a block are renewed near the blade when they are wider than this share of the lattice size.
constexpr double kTight = 0.1;
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

/// How far along an axis what follows particles can have moved since the object had travelled `travel`.
double Margin(double travel, double overshoot, const LatticeMotion& object) {
  return (1 + 2 * overshoot) * (object.travel() - travel);
}

/// The code of what was bounded in an earlier window.
template <typename Kept, typename Box>
std::uint8_t CodeOf(const Kept& kept, double overshoot, const Box& box, const LatticeMotion& object) {
  const double margin = Margin(kept.travel, overshoot, object);
  return Outcode(kept.bounds.min.array() - margin, kept.bounds.max.array() + margin, box);
}

/// (1 - t) x0 + t x1 gives x0 and x1 themselves at the ends, so windows meet in the same bits.
Eigen::Vector3d At(const Eigen::Vector3d& x0, const Eigen::Vector3d& x1, double t) { return (1 - t) * x0 + t * x1; }

}  // namespace

CrossingFinder::CrossingFinder(const Lattice& lattice, const MaterialGraph& graph)
    : lattice_(&lattice), graph_(&graph), placed_(lattice.vertices.size()) {
  const auto& [a, b] = lattice.links[0];
  tight_ = kTight * (lattice.vertices[a] - lattice.vertices[b]).norm();
  for (size_t v = 0, l = 0; v <= lattice.vertices.size(); ++v) {
    while (l < lattice.links.size() && static_cast<size_t>(lattice.links[l][0]) < v) ++l;
    first_link_.push_back(static_cast<int>(l));
  }
}

CrossingFinder::Bounds CrossingFinder::BoundBlade(const BladeMotion& blade) {
  auto add = [](Bounds& bounds, const Bounds& other) {
    bounds.min = bounds.min.cwiseMin(other.min);
    bounds.max = bounds.max.cwiseMax(other.max);
  };
  Bounds all;
  window_bounds_.clear();
  stretch_bounds_.clear();
  edge_bounds_.clear();
  for (const BladeWindow& window : blade) {
    Bounds whole;
    for (size_t e = 0; e + 1 < window.points_t0.size(); ++e) {
      Bounds edge = {window.points_t0[e], window.points_t0[e]};
      for (const Eigen::Vector3d* p : {&window.points_t0[e + 1], &window.points_t1[e], &window.points_t1[e + 1]})
        add(edge, {*p, *p});
      edge_bounds_.push_back(edge);
      if (e % kEdgesTogether == 0) stretch_bounds_.emplace_back();
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
  group_bounds_.resize(groups.size());
  group_code_.assign(groups.size(), kBeyondAll);
  group_near_.assign(groups.size(), 0);
  for (size_t g = 0; g < groups.size(); ++g) {
    const MotionGroup& group = groups[g];
    if (group.blocks.empty()) continue;
    KeptBounds& kept = group_bounds_[g];
    std::uint8_t code = kept.version == group.version ? CodeOf(kept, group.overshoot, box, object) : 0;
    if (code == 0) {
      const Bounds bounds = BoundParticles<Bounds>(group.particles.data(), static_cast<int>(group.particles.size()),
                                                   group.overshoot, object);
      kept = {bounds, object.travel(), group.version};
      code = Outcode(bounds.min, bounds.max, box);
    }
    group_code_[g] = code;
  }
  for (int v : object.blocks().astray()) {
    const Eigen::Vector3d x = object.At(v).start;
    group_code_[object.blocks().blocks()[object.blocks().block_of(v)].group] &= Outcode(x, x, box);
  }
  for (size_t g = 0; g < groups.size(); ++g) {
    if (group_code_[g] == 0) group_near_[g] = 1;
    for (int n : groups[g].later_neighbours)
      if ((group_code_[g] & group_code_[n]) == 0) group_near_[g] = group_near_[n] = 1;
  }
}

/// Evaluates the window of a vertex, if that was not done yet, and gives it its code.
const CrossingFinder::PlacedVertex& CrossingFinder::Place(int vertex, const Bounds& box, const LatticeMotion& object) {
  PlacedVertex& placed = placed_[vertex];
  if (std::exchange(placed.search, search_) != search_) {
    const auto& [start, end] = placed.window = object.At(vertex);
    placed.code = Outcode(start.cwiseMin(end), start.cwiseMax(end), box);
  }
  return placed;
}

/// Tests the links of a block, unless its bounds say that none can reach the box; brings these up to date if they are
/// not tight.
void CrossingFinder::SearchBlock(int b, const Bounds& box, const BladeMotion& blade, const LatticeMotion& object) {
  const MotionBlock& block = object.blocks().blocks()[b];
  KeptBounds& kept = block_bounds_[b];
  const double overshoot = object.blocks().groups()[block.group].reach_overshoot;
  const bool is_known = kept.version == block.version;
  if (is_known && CodeOf(kept, overshoot, box, object) != 0) return;
  for (int p : block.vertices) {
    if (first_link_[p] == first_link_[p + 1]) continue;
    const std::uint8_t code = Place(p, box, object).code;
    for (int link = first_link_[p]; link < first_link_[p + 1]; ++link)
      if ((code & Place(lattice_->links[link][1], box, object).code) == 0 && !graph_->IsCut(link))
        TestLink(link, blade);
  }
  if (is_known && Margin(kept.travel, overshoot, object) < tight_) return;
  Bounds bounds;
  auto add = [&](int vertex) {
    const auto& [start, end] = placed_[vertex].window;
    bounds.min = bounds.min.cwiseMin(start.cwiseMin(end));
    bounds.max = bounds.max.cwiseMax(start.cwiseMax(end));
  };
  for (int p : block.vertices) {
    if (first_link_[p] == first_link_[p + 1]) continue;
    add(p);
    for (int link = first_link_[p]; link < first_link_[p + 1]; ++link) add(lattice_->links[link][1]);
  }
  kept = {bounds, object.travel(), block.version};
}

void CrossingFinder::TestLink(int link, const BladeMotion& blade) {
  const LatticeMotion::Window &a = placed_[lattice_->links[link][0]].window,
                              &b = placed_[lattice_->links[link][1]].window;
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
  const auto& groups = object.blocks().groups();
  block_bounds_.resize(object.blocks().blocks().size());
  for (size_t g = 0; g < groups.size(); ++g)
    if (group_near_[g])
      for (int b : groups[g].blocks) SearchBlock(b, box, blade, object);
  std::sort(found_.begin(), found_.end(), [](const Crossing& p, const Crossing& q) { return p.cut.link < q.cut.link; });
  return found_;
}

}  // namespace meshless_cutting
