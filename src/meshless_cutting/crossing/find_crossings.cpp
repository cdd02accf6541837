#include "crossing/find_crossings.h"

#include <algorithm>

#include "crossing/edge_edge.h"

namespace meshless_cutting {
namespace {

/// Six bits, one per side of the box [min, max] that the point lies beyond (Cohen-Sutherland). Things whose codes share
/// a bit have a face of the box between them and it.
std::uint8_t Outcode(const Eigen::Vector3d& x, const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
  return static_cast<std::uint8_t>((x[0] < min[0]) | (x[0] > max[0]) << 1 | (x[1] < min[1]) << 2 |
                                   (x[1] > max[1]) << 3 | (x[2] < min[2]) << 4 | (x[2] > max[2]) << 5);
}

}  // namespace

CrossingFinder::CrossingFinder(const Lattice& lattice, const MaterialGraph& graph)
    : lattice_(&lattice), graph_(&graph), stamp_(lattice.vertices.size(), 0), motion_(lattice.vertices.size()) {}

const std::pair<Eigen::Vector3d, Eigen::Vector3d>& CrossingFinder::Motion(int vertex, const LatticeMotion& object) {
  if (stamp_[vertex] != search_) {
    stamp_[vertex] = search_;
    motion_[vertex] = {object.Start(vertex), object.End(vertex)};
  }
  return motion_[vertex];
}

void CrossingFinder::FindNearBlocks(const Aabb& box, const LatticeMotion& object) {
  auto encode = [&](const std::vector<Eigen::Vector3d>& x0, const std::vector<Eigen::Vector3d>& x1,
                    std::vector<std::uint8_t>& codes) {
    codes.resize(x1.size());
    for (size_t i = 0; i < x1.size(); ++i)
      codes[i] = Outcode(x0[i], box.min, box.max) & Outcode(x1[i], box.min, box.max);
  };
  encode(object.particles_t0(), object.particles_t1(), particle_code_);
  encode(object.surface_t0(), object.surface_t1(), surface_code_);
  // A block lies beyond a side when the particles that bound it and its loose vertices do.
  const int count = object.block_count();
  block_code_.assign(count, 63);
  near_.assign(count, 0);
  near_blocks_.clear();
  for (int b = 0; b < count; ++b) {
    std::uint8_t code = 63;
    const int* particles = object.block_particles(b);
    for (int k = 0; k < object.support_size(); ++k) code &= particle_code_[particles[k]];
    for (int v : object.block_loose(b)) {
      if (code == 0) break;
      if (const int s = object.SurfaceVertex(v); s >= 0) {
        code &= surface_code_[s];
      } else {
        const auto& [start, end] = Motion(v, object);
        code &= Outcode(start, box.min, box.max) & Outcode(end, box.min, box.max);
      }
    }
    block_code_[b] = code;
  }
  // A link can reach the box when no side has both its ends beyond.
  for (int b = 0; b < count; ++b) {
    bool near = block_code_[b] == 0;
    for (int q : object.block_neighbours(b)) near = near || (block_code_[b] & block_code_[q]) == 0;
    if (!near) continue;
    near_[b] = 1;
    near_blocks_.push_back(b);
  }
}

void CrossingFinder::TestLink(int link, const BladeMotion& blade, const Aabb& box, const LatticeMotion& object) {
  const auto& [a, b] = lattice_->links[link];
  const auto [a0, a1] = Motion(a, object);
  const auto [b0, b1] = Motion(b, object);
  if (Outcode(a0, box.min, box.max) & Outcode(a1, box.min, box.max) & Outcode(b0, box.min, box.max) &
      Outcode(b1, box.min, box.max))
    return;
  // (1 - t) x0 + t x1 gives x0 and x1 themselves at the ends, so windows meet in the same bits.
  auto at = [](const Eigen::Vector3d& x0, const Eigen::Vector3d& x1, double t) -> Eigen::Vector3d {
    return (1 - t) * x0 + t * x1;
  };
  for (const BladeWindow& window : blade) {
    const MovingSegment object_edge = {at(a0, a1, window.t0), at(b0, b1, window.t0), at(a0, a1, window.t1),
                                       at(b0, b1, window.t1)};
    Crossing first;
    bool hit = false;
    double along = 0;
    for (size_t e = 0; e + 1 < window.points_t0.size(); ++e) {
      const MovingSegment blade_edge = {window.points_t0[e], window.points_t0[e + 1], window.points_t1[e],
                                        window.points_t1[e + 1]};
      const double length = (blade_edge.q_t1 - blade_edge.p_t1).norm();
      if (const auto crossing = FindFirstCrossing(blade_edge, object_edge)) {
        const double t = window.t0 + crossing->t * (window.t1 - window.t0);
        if (!hit || t < first.t) {
          hit = true;
          const Eigen::Vector3d p = at(object_edge.p_t0, object_edge.p_t1, crossing->t);
          const Eigen::Vector3d q = at(object_edge.q_t0, object_edge.q_t1, crossing->t);
          first = {{link, crossing->v}, t, along + crossing->u * length, at(p, q, crossing->v)};
        }
      }
      along += length;
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
  Aabb box = {blade[0].points_t0[0], blade[0].points_t0[0]};
  for (const BladeWindow& window : blade)
    for (const auto* points : {&window.points_t0, &window.points_t1})
      for (const Eigen::Vector3d& p : *points) {
        box.min = box.min.cwiseMin(p);
        box.max = box.max.cwiseMax(p);
      }
  // Vertices may leave the bounds of their particles by rounding and by their offset.
  const double slack = object.slack() + 1e-12 * box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  box.min.array() -= slack;
  box.max.array() += slack;
  FindNearBlocks(box, object);
  for (int block : near_blocks_)
    for (int a : object.block_vertices(block))
      for (const int* l = lattice_->vertex_links.begin(a); l != lattice_->vertex_links.end(a); ++l) {
        if (graph_->IsCut(*l)) continue;
        const auto& ends = lattice_->links[*l];
        const int b = ends[0] == a ? ends[1] : ends[0];
        if (near_[object.block(b)] && b < a) continue;  // its turn comes from the other end
        TestLink(*l, blade, box, object);
      }
  std::sort(found_.begin(), found_.end(), [](const Crossing& p, const Crossing& q) { return p.cut.link < q.cut.link; });
  return found_;
}

}  // namespace meshless_cutting
