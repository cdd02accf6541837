#include "cut/soft_body.h"

#include <Eigen/Geometry>
#include <algorithm>
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

/// Vertices that share a triangle with each vertex.
Incidence VertexNeighbours(const Surface& surface) {
  Incidence neighbours;
  neighbours.offsets.assign(surface.rest_positions.size() + 1, 0);
  for (const auto& t : surface.triangles)
    for (std::uint32_t v : t) neighbours.offsets[v + 1] += 2;
  std::partial_sum(neighbours.offsets.begin(), neighbours.offsets.end(), neighbours.offsets.begin());
  neighbours.items.resize(neighbours.offsets.back());
  std::vector<int> next(neighbours.offsets.begin(), neighbours.offsets.end() - 1);
  for (const auto& t : surface.triangles)
    for (int i = 0; i < 3; ++i) {
      neighbours.items[next[t[i]]++] = static_cast<int>(t[(i + 1) % 3]);
      neighbours.items[next[t[i]]++] = static_cast<int>(t[(i + 2) % 3]);
    }
  return neighbours;
}

std::vector<Eigen::Vector3d> RestNormals(const Surface& surface) {
  std::vector<Eigen::Vector3d> normals(surface.rest_positions.size(), Eigen::Vector3d::Zero());
  for (const auto& t : surface.triangles) {
    const Eigen::Vector3d& a = surface.rest_positions[t[0]];
    const Eigen::Vector3d n = (surface.rest_positions[t[1]] - a).cross(surface.rest_positions[t[2]] - a);
    for (std::uint32_t v : t) normals[v] += n;
  }
  return normals;
}

}  // namespace

SoftBody::SoftBody(const Lattice& lattice, const ObjectConfig& config, bool can_be_cut)
    : lattice_(&lattice),
      graph_(lattice),
      cut_surface_(lattice, graph_),
      grid_(FitGrid(lattice, config)),
      shape_(grid_, config.support_radius_cells),
      points_(lattice, graph_, grid_),
      twins_(grid_, shape_, points_, config.material.density_kg_m3, config.fixed, tissue_),
      mapping_(points_, shape_, tissue_) {
  for (const Eigen::Vector3d& X : tissue_.particle_rest) state_.position.push_back(config.T_WO * X);
  state_.velocity.assign(state_.position.size(), Eigen::Vector3d::Zero());
  state_.acceleration = state_.velocity;
  cut_surface_.WriteTriangles(surface_);
  MapSurface({}, 0, {});
  if (can_be_cut) motion_.emplace(lattice, cut_surface_, points_, shape_, tissue_);
  EndAdvance();    // positions of the surface as mapped,
  BeginAdvance();  // where the first window starts
  EndAdvance();
}

void SoftBody::Cut(const std::vector<LinkCut>& cuts) {
  std::vector<int> links;
  for (const LinkCut& cut : cuts)
    if (graph_.Cut(cut)) links.push_back(cut.link);
  const int first_new_vertex = static_cast<int>(cut_surface_.vertices().size());
  cut_surface_.Update(links);

  // Inner lattice vertices whose point is about to change start their next window where they were published.
  const std::vector<int>& changed = points_.Update(cut_surface_, cut_surface_.changed_tetrahedra());
  std::vector<int> lattice_vertices;
  for (int p : changed)
    if (p < motion_->block_count())
      lattice_vertices.insert(lattice_vertices.end(), motion_->block_vertices(p).begin(), motion_->block_vertices(p).end());
  std::sort(lattice_vertices.begin(), lattice_vertices.end());
  motion_->KeepStart(lattice_vertices, state_.position);

  std::vector<int> source;
  const std::vector<int>& relinked = twins_.Update(changed, tissue_, source);
  for (int from : source)
    for (auto* values : {&state_.position, &state_.velocity, &state_.acceleration}) values->push_back((*values)[from]);
  // Points that only had a particle replaced by its twin: same weights, same positions, other indices.
  for (int p : relinked)
    if (p < motion_->block_count() && !std::binary_search(changed.begin(), changed.end(), p))
      lattice_vertices.insert(lattice_vertices.end(), motion_->block_vertices(p).begin(), motion_->block_vertices(p).end());
  std::sort(lattice_vertices.begin(), lattice_vertices.end());
  motion_->Remap(lattice_vertices);

  cut_surface_.WriteTriangles(surface_);
  MapSurface(relinked, first_new_vertex, cuts);
}

// Who is mapped anew (section 2.3): new vertices, the ends of cut links, and vertices on points that changed.
void SoftBody::MapSurface(const std::vector<int>& relinked_points, int first_new_vertex, const std::vector<LinkCut>& cuts) {
  const auto& vertices = cut_surface_.vertices();
  std::vector<std::uint8_t> affected(vertices.size(), 0);
  for (size_t v = static_cast<size_t>(first_new_vertex); v < vertices.size(); ++v) {
    mapping_.Add(vertices[v].rest, vertices[v].anchor);
    surface_.rest_positions.push_back(vertices[v].rest);
    surface_.positions.emplace_back();
    affected[v] = 1;
  }
  std::vector<std::uint8_t> on_changed_point(points_.points().size(), 0);
  for (int p : relinked_points) on_changed_point[p] = 1;
  for (int v = 0; v < first_new_vertex; ++v) affected[v] = on_changed_point[mapping_.point(v)];
  for (const LinkCut& cut : cuts)
    for (int end : lattice_->links[cut.link])
      if (const int v = cut_surface_.VertexOf(end); v >= 0) affected[v] = 1;

  const Incidence neighbours = VertexNeighbours(surface_);
  const std::vector<Eigen::Vector3d> normals = RestNormals(surface_);
  for (size_t v = 0; v < vertices.size(); ++v)
    if (affected[v]) mapping_.Unmap(static_cast<int>(v));
  for (size_t v = 0; v < vertices.size(); ++v)
    if (affected[v])
      mapping_.Map(static_cast<int>(v), normals[v],
                   {neighbours.begin(static_cast<int>(v)), neighbours.end(static_cast<int>(v))});
  FindFragments();
  ++surface_.version;
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
    for (size_t k = 1; k < K; ++k) root[find(tissue_.point_particles[p * K + k])] = a;
  }
  std::vector<double> volume(root.size(), 0);
  for (int p = 0; p < tissue_.point_count(); ++p) volume[find(tissue_.point_particles[p * K])] += tissue_.point_volume[p];
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
    surface_.fragment[t] = static_cast<std::uint32_t>(point_fragment_[mapping_.point(static_cast<int>(surface_.triangles[t][0]))]);
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
