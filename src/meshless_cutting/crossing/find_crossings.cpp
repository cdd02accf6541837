#include "crossing/find_crossings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "crossing/edge_edge.h"

namespace meshless_cutting {
namespace {

constexpr std::uint8_t kBeyondAll = 255;
/// Bits of an outcode that tell of the slab.
constexpr int kSlabBit = 6;
/// Bounds of a block are renewed near the blade when they are wider than this share of the lattice size.
constexpr double kTight = 0.1;
/// Edges of the blade that share one more box.
constexpr size_t kEdgesTogether = 5;

/// Six bits, one per side of the box [min, max] that all of [low, high] lies beyond (Cohen-Sutherland).
template <typename Box>
std::uint8_t BoxCode(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Box& box) {
  return static_cast<std::uint8_t>((high[0] < box.min[0]) | (low[0] > box.max[0]) << 1 | (high[1] < box.min[1]) << 2 |
                                   (low[1] > box.max[1]) << 3 | (high[2] < box.min[2]) << 4 |
                                   (low[2] > box.max[2]) << 5);
}

/// Two more, one per side of the slab that all of [low, high] lies beyond, along its normal.
template <typename Reach>
std::uint8_t SlabCode(double low, double high, const Reach& reach) {
  return static_cast<std::uint8_t>(((high < reach.low) | (low > reach.high) << 1) << kSlabBit);
}

/// The code of a box. Boxes beyond a side of the other box are not held against the slab.
template <typename Reach>
std::uint8_t Outcode(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Reach& reach) {
  if (const std::uint8_t code = BoxCode(low, high, reach.box); code != 0) return code;
  const double middle = 0.5 * reach.normal.dot(low + high), half = 0.5 * reach.abs_normal.dot(high - low);
  return SlabCode(middle - half, middle + half, reach);
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

/// How far along an axis, beside the drift, what was bounded can have moved until its particles had travelled `travel`.
template <typename Kept>
double Margin(const Kept& kept, double travel) {
  return (1 + 2 * kept.overshoot) * (travel - kept.travel);
}

/// The code of what was bounded in an earlier window.
template <typename Kept, typename Reach>
std::uint8_t CodeOf(const Kept& kept, const MotionGroup& group, double travel, const Reach& reach) {
  const double margin = Margin(kept, travel);
  const Eigen::Array3d drift_t0 = group.drift_t0 - kept.drift, drift_t1 = group.drift_t1 - kept.drift;
  return Outcode(kept.bounds.min.array() + drift_t0.min(drift_t1) - margin,
                 kept.bounds.max.array() + drift_t0.max(drift_t1) + margin, reach);
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

/// Bounds the blade, and those of its windows and edges for TestLink(). `slack`: how far vertices may leave the bounds
/// of their particles, m.
CrossingFinder::Reach CrossingFinder::BoundBlade(const BladeMotion& blade, double slack) {
  auto add = [](Bounds& bounds, const Bounds& other) {
    bounds.min = bounds.min.cwiseMin(other.min);
    bounds.max = bounds.max.cwiseMax(other.max);
  };
  Reach reach;
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
    add(reach.box, whole);
  }
  // Across the blade and its way, where what it sweeps is thinnest.
  const Eigen::Vector3d chord = blade.front().points_t0.back() - blade.front().points_t0.front();
  const Eigen::Vector3d way = blade.back().points_t1.front() - blade.front().points_t0.front();
  const Eigen::Vector3d far_way = blade.back().points_t1.back() - blade.front().points_t0.back();
  reach.normal = chord.cross(way + far_way).normalized();
  reach.abs_normal = reach.normal.cwiseAbs();
  for (const BladeWindow& window : blade)
    for (const auto* points : {&window.points_t0, &window.points_t1})
      for (const Eigen::Vector3d& p : *points) {
        const double s = reach.normal.dot(p);
        reach.low = std::min(reach.low, s);
        reach.high = std::max(reach.high, s);
      }
  slack += 1e-12 * reach.box.min.cwiseAbs().cwiseMax(reach.box.max.cwiseAbs()).maxCoeff();
  reach.box.min.array() -= slack;
  reach.box.max.array() += slack;
  reach.low -= 2 * slack;
  reach.high += 2 * slack;
  return reach;
}

void CrossingFinder::FindNearGroups(const Reach& reach, const LatticeMotion& object) {
  const auto& groups = object.blocks().groups();
  group_bounds_.resize(groups.size());
  group_code_.assign(groups.size(), kBeyondAll);
  group_near_.assign(groups.size(), 0);
  for (size_t g = 0; g < groups.size(); ++g) {
    const MotionGroup& group = groups[g];
    if (group.blocks.empty()) continue;
    KeptBounds& kept = group_bounds_[g];
    std::uint8_t code = kept.version == group.version ? CodeOf(kept, group, group.travel, reach) : 0;
    if (code == 0) {
      const Bounds bounds = BoundParticles<Bounds>(group.particles.data(), static_cast<int>(group.particles.size()),
                                                   group.overshoot, object);
      kept = {bounds, group.drift_t1, group.travel, group.overshoot, group.version};
      code = Outcode(bounds.min, bounds.max, reach);
    }
    group_code_[g] = code;
  }
  for (int v : object.blocks().astray()) {
    const Eigen::Vector3d x = object.At(v).start;
    group_code_[object.blocks().blocks()[object.blocks().block_of(v)].group] &= Outcode(x, x, reach);
  }
  for (size_t g = 0; g < groups.size(); ++g) {
    if (group_code_[g] == 0) group_near_[g] = 1;
    for (int n : groups[g].later_neighbours)
      if ((group_code_[g] & group_code_[n]) == 0) group_near_[g] = group_near_[n] = 1;
  }
}

/// Evaluates the window of a vertex, and its code.
std::uint8_t CrossingFinder::Place(int vertex, const Reach& reach, const LatticeMotion& object) {
  const auto& [start, end] = windows_.emplace_back(object.At(vertex));
  const double s0 = reach.normal.dot(start), s1 = reach.normal.dot(end);
  const auto code = static_cast<std::uint8_t>(BoxCode(start.cwiseMin(end), start.cwiseMax(end), reach.box) |
                                              SlabCode(std::min(s0, s1), std::max(s0, s1), reach));
  placed_[vertex] = {search_, static_cast<std::uint32_t>(windows_.size() - 1), code};
  return code;
}

/// Tests the links of a block, unless its bounds say that none can come within reach; brings these up to date if they
/// are not tight.
void CrossingFinder::SearchBlock(int b, const Reach& reach, const BladeMotion& blade, const LatticeMotion& object) {
  const MotionBlock& block = object.blocks().blocks()[b];
  KeptBounds& kept = block_bounds_[b];
  const MotionGroup& group = object.blocks().groups()[block.group];
  const bool is_known = kept.version == block.version;
  if (is_known && CodeOf(kept, group, group.reach_travel, reach) != 0) return;
  const auto code_of = [&](int vertex) {
    const PlacedVertex& placed = placed_[vertex];
    return placed.search == search_ ? placed.code : Place(vertex, reach, object);
  };
  for (int p : block.vertices) {
    if (first_link_[p] == first_link_[p + 1]) continue;
    const std::uint8_t code = code_of(p);
    for (int link = first_link_[p]; link < first_link_[p + 1]; ++link)
      if ((code & code_of(lattice_->links[link][1])) == 0 && !graph_->IsCut(link)) TestLink(link, blade);
  }
  if (is_known && Margin(kept, group.reach_travel) < tight_) return;
  Bounds bounds;
  double overshoot = 0;
  auto add = [&](int vertex) {
    overshoot = std::max(overshoot, object.Overshoot(vertex));
    const auto& [start, end] = WindowOf(vertex);
    bounds.min = bounds.min.cwiseMin(start.cwiseMin(end));
    bounds.max = bounds.max.cwiseMax(start.cwiseMax(end));
  };
  for (int p : block.vertices) {
    if (first_link_[p] == first_link_[p + 1]) continue;
    add(p);
    for (int link = first_link_[p]; link < first_link_[p + 1]; ++link) add(lattice_->links[link][1]);
  }
  kept = {bounds, group.drift_t1, group.reach_travel, overshoot, block.version};
}

void CrossingFinder::TestLink(int link, const BladeMotion& blade) {
  const LatticeMotion::Window &a = WindowOf(lattice_->links[link][0]), &b = WindowOf(lattice_->links[link][1]);
  const Eigen::Vector3d low = a.start.cwiseMin(a.end).cwiseMin(b.start).cwiseMin(b.end);
  const Eigen::Vector3d high = a.start.cwiseMax(a.end).cwiseMax(b.start).cwiseMax(b.end);
  const Bounds *edge_bounds = edge_bounds_.data(), *stretch_bounds = stretch_bounds_.data();
  for (size_t w = 0; w < blade.size(); ++w) {
    const BladeWindow& window = blade[w];
    const size_t edges = window.points_t0.size() - 1;
    const Bounds* bounds = std::exchange(edge_bounds, edge_bounds + edges);
    const Bounds* stretches =
        std::exchange(stretch_bounds, stretch_bounds + (edges + kEdgesTogether - 1) / kEdgesTogether);
    if (BoxCode(low, high, window_bounds_[w]) != 0) continue;
    const MovingSegment object_edge = {At(a.start, a.end, window.t0), At(b.start, b.end, window.t0),
                                       At(a.start, a.end, window.t1), At(b.start, b.end, window.t1)};
    Crossing first;
    bool hit = false;
    for (size_t e = 0; e < edges; ++e) {
      if (e % kEdgesTogether == 0 && BoxCode(low, high, stretches[e / kEdgesTogether]) != 0) {
        e += kEdgesTogether - 1;
        continue;
      }
      if (BoxCode(low, high, bounds[e]) != 0) continue;
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
  windows_.clear();
  const Reach reach = BoundBlade(blade, object.slack());
  FindNearGroups(reach, object);
  const auto& groups = object.blocks().groups();
  block_bounds_.resize(object.blocks().blocks().size());
  for (size_t g = 0; g < groups.size(); ++g)
    if (group_near_[g])
      for (int b : groups[g].blocks) SearchBlock(b, reach, blade, object);
  std::sort(found_.begin(), found_.end(), [](const Crossing& p, const Crossing& q) { return p.cut.link < q.cut.link; });
  return found_;
}

}  // namespace meshless_cutting
