#include "cut/soft_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <numeric>

namespace meshless_cutting {
namespace {

BackgroundGrid FitGrid(const Lattice& lattice, const ObjectConfig& config) {
  Eigen::Vector3d low = lattice.vertices[0], high = low;
  for (const Eigen::Vector3d& X : lattice.vertices) {
    low = low.cwiseMin(X);
    high = high.cwiseMax(X);
  }
  return BackgroundGrid(low, high, config.cell_size_m, ShapeFunctions::Margin(config.support_radius_cells));
}

/// Outward normals and neighbours of some vertices of a surface. `slot`: for each vertex its place in the result, -1
/// for vertices that are not asked for.
std::vector<MappingConditions> FindConditions(const Surface& surface, const std::vector<int>& slot, size_t count) {
  std::vector<MappingConditions> conditions(count);
  for (const auto& t : surface.triangles) {
    if ((slot[t[0]] & slot[t[1]] & slot[t[2]]) == -1) continue;
    const Eigen::Vector3d& a = surface.rest_positions[t[0]];
    const Eigen::Vector3d n = (surface.rest_positions[t[1]] - a).cross(surface.rest_positions[t[2]] - a);
    for (int i = 0; i < 3; ++i) {
      const int s = slot[t[i]];
      if (s < 0) continue;
      conditions[s].normal += n;
      conditions[s].neighbours.push_back(static_cast<int>(t[(i + 1) % 3]));  // each once: the surface is closed
    }
  }
  return conditions;
}

}  // namespace

SoftBody::SoftBody(const Lattice& lattice, const ObjectConfig& config, bool can_be_cut)
    : lattice_(&lattice),
      graph_(lattice),
      cut_surface_(lattice, graph_),
      grid_(FitGrid(lattice, config)),
      shape_(grid_, config.support_radius_cells),
      points_(lattice, graph_, grid_),
      twins_(lattice, grid_, shape_, points_, config, tissue_),
      mapping_(points_, shape_, tissue_) {
  for (const Eigen::Vector3d& X : tissue_.particle_rest) state_.position.push_back(config.T_WO * X);
  state_.velocity.assign(state_.position.size(), Eigen::Vector3d::Zero());
  state_.acceleration = state_.velocity;
  cut_surface_.WriteTriangles(surface_);
  MapSurface({});
  EndAdvance();  // positions of the surface as mapped,
  if (can_be_cut) motion_.emplace(lattice, cut_surface_, mapping_, points_, grid_, shape_, tissue_);
  BeginAdvance();  // where the first window starts
  EndAdvance();
}

void SoftBody::CutMaterial(const std::vector<LinkCut>& cuts) {
  std::vector<int> links;
  for (const LinkCut& cut : cuts)
    if (graph_.Cut(cut)) links.push_back(cut.link);
  first_new_vertex_ = static_cast<int>(cut_surface_.vertices().size());
  cut_surface_.Update(links);

  changed_points_ = points_.Update(cut_surface_, cut_surface_.changed_tetrahedra());
  motion_->KeepStarts(changed_points_, state_.position);
  std::vector<int> source;
  relinked_points_ = twins_.Update(changed_points_, tissue_, source);
  for (int from : source)
    for (auto* values : {&state_.position, &state_.velocity, &state_.acceleration}) values->push_back((*values)[from]);
}

void SoftBody::Redraw(const std::vector<LinkCut>& cuts) {
  cut_surface_.WriteTriangles(surface_);
  const std::vector<int> redrawn = MapSurface(cuts);
  motion_->Remap(relinked_points_, redrawn);
}

// Who is mapped anew (section 2.3): new vertices, the ends of cut links, and vertices on points that changed.
std::vector<int> SoftBody::MapSurface(const std::vector<LinkCut>& cuts) {
  const auto& vertices = cut_surface_.vertices();
  const int count = static_cast<int>(vertices.size());
  std::vector<int> affected;
  for (int v = first_new_vertex_; v < count; ++v) {
    mapping_.Add(vertices[v].rest, vertices[v].anchor);
    surface_.rest_positions.push_back(vertices[v].rest);
    surface_.positions.emplace_back();
    affected.push_back(v);
  }
  for (int p : changed_points_) affected.insert(affected.end(), mapping_.OnPoint(p).begin(), mapping_.OnPoint(p).end());
  for (const LinkCut& cut : cuts)
    for (int end : lattice_->links[cut.link])
      if (const int v = cut_surface_.VertexOf(end); v >= 0) affected.push_back(v);
  std::sort(affected.begin(), affected.end());
  affected.erase(std::unique(affected.begin(), affected.end()), affected.end());
  for (int p : relinked_points_)
    for (int v : mapping_.OnPoint(p)) mapping_.Refresh(v);

  slot_.resize(vertices.size(), -1);
  for (size_t i = 0; i < affected.size(); ++i) slot_[affected[i]] = static_cast<int>(i);
  const std::vector<MappingConditions> conditions = FindConditions(surface_, slot_, affected.size());
  // The ends of a cut link get the plane of the cut: through the cut, with the normal of the lip on their side.
  for (const LinkCut& cut : cuts)
    for (int side : {0, 1}) {
      const int end = cut_surface_.VertexOf(lattice_->links[cut.link][side]);
      const int lip = cut_surface_.VertexOnLink(cut.link, side);
      if (end < 0 || lip < 0 || lip == cut_surface_.VertexOnLink(cut.link, 1 - side)) continue;
      if (slot_[lip] >= 0) mapping_.SetCutPlane(end, {vertices[lip].rest, conditions[slot_[lip]].normal});
    }
  for (int v : affected) {
    mapping_.Unmap(v);
    slot_[v] = -1;
  }
  for (size_t i = 0; i < affected.size(); ++i) mapping_.Map(affected[i], conditions[i]);
  FindFragments();
  ++surface_.version;
  return affected;
}

void SoftBody::FindFragments() {
  // Pieces of the physics: points joined by particles. They are the pieces of the graph (see CheckInvariants).
  const size_t K = static_cast<size_t>(tissue_.support_size);
  std::vector<int> root(tissue_.particle_rest.size());
  std::iota(root.begin(), root.end(), 0);
  auto find = [&](int j) {
    while (root[j] != j) j = root[j] = root[root[j]];
    return j;
  };
  for (int p = 0; p < tissue_.point_count(); ++p) {
    const int a = find(tissue_.point_particles[p * K]);
    for (size_t k = 1; k < K; ++k)
      if (const int j = tissue_.point_particles[p * K + k]; root[j] != a) root[find(j)] = a;
  }
  std::vector<double> volume(root.size(), 0);
  for (int p = 0; p < tissue_.point_count(); ++p)
    volume[find(tissue_.point_particles[p * K])] += tissue_.point_volume[p];
  std::vector<int> order;
  for (size_t j = 0; j < root.size(); ++j)
    if (volume[j] > 0) order.push_back(static_cast<int>(j));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return volume[a] > volume[b]; });
  std::vector<int> number(root.size(), -1);
  surface_.fragment_volume_m3.clear();
  for (int j : order) {
    number[j] = static_cast<int>(surface_.fragment_volume_m3.size());
    surface_.fragment_volume_m3.push_back(volume[j]);
  }
  point_fragment_.resize(tissue_.point_count());
  for (int p = 0; p < tissue_.point_count(); ++p) point_fragment_[p] = number[find(tissue_.point_particles[p * K])];
  surface_.fragment.resize(surface_.triangles.size());
  for (size_t t = 0; t < surface_.triangles.size(); ++t)
    surface_.fragment[t] =
        static_cast<std::uint32_t>(point_fragment_[mapping_.point(static_cast<int>(surface_.triangles[t][0]))]);
}

void SoftBody::CloseWindow() { motion_->ForgetStarts(); }

void SoftBody::BeginAdvance() {
  if (!motion_) return;
  particles_t0_ = state_.position;
  surface_t0_ = surface_.positions;
}

void SoftBody::EndAdvance() {
  for (size_t v = 0; v < surface_.positions.size(); ++v)
    surface_.positions[v] = mapping_.Position(static_cast<int>(v), state_.position);
  if (motion_) motion_->SetWindow(&particles_t0_, &state_.position, &surface_t0_, &surface_.positions);
}

}  // namespace meshless_cutting
