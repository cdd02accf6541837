// Mapping of vertices on the meshless tissue (paper section 2.2): one integration point per vertex, MLS weights of its
// particles.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "cut/integration_points.h"
#include "surface/paper_criteria.h"
#include "tissue/shape_functions.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

/// How often each criterion of section 2.2 ruled out a point that would otherwise have been chosen, since load.
struct MappingStatistics {
  std::uint64_t mapped = 0;           // choices made
  std::uint64_t tangent_plane = 0;    // the nearest point lay above the tangent plane
  std::uint64_t cut_plane = 0;        // the nearest point below it lay beyond the cut
  std::uint64_t shared_particle = 0;  // the nearest point below both shared no particle with a neighbouring vertex
  std::uint64_t relaxed = 0;          // no point met all criteria: the nearest that met the first of them was taken
};

/// What section 2.2 asks of the integration point of a vertex, beside the graph.
struct MappingConditions {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // outward surface normal at rest, not unit; zero: no condition
  std::vector<int> neighbours;  // vertices that form a triangle with it; those not mapped yet put no condition
};

/// A plane that a cut gave to a vertex: its integration point must not lie on the side that `normal` points to.
struct CutPlane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   // m, at rest
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // away from the vertex, not unit; zero: no condition
};

/// Vertices that follow the tissue. Candidates are only points that the graph connects to the vertex, so a mapping
/// across a cut is impossible whatever the criteria say.
class VertexMapping {
 public:
  VertexMapping(const IntegrationPoints& points, const ShapeFunctions& shape, const Tissue& tissue);

  /// Adds a vertex at rest position X (m, object frame) whose material belongs to lattice vertex `anchor`; not mapped
  /// yet.
  void Add(const Eigen::Vector3d& X, int anchor);

  /// Forgets the mapping of v, so that it puts no condition on its neighbours until it is mapped again.
  void Unmap(int v);

  /// The latest cut next to v (section 2.3: the ends of a cut link get the plane of the cut).
  void SetCutPlane(int v, const CutPlane& plane) { cut_plane_[v] = plane; }

  /// Maps vertex v on the nearest qualifying point.
  void Map(int v, const MappingConditions& conditions);

  /// Maps vertex v on the point of the cell that it lies in, if the graph connects them, else on the nearest.
  void MapInside(int v);

  /// The point of v has other particles (twins) than before: same weights, same place, other indices.
  void Refresh(int v);
  /// True while the graph joins v to its point.
  bool IsJoined(int v) const;

  int size() const { return static_cast<int>(point_.size()); }
  int point(int v) const { return point_[v]; }
  /// Vertices that are mapped on point p, in no particular order; none for a point that no vertex was ever mapped on.
  const std::vector<int>& OnPoint(int p) const;
  int anchor(int v) const { return anchor_[v]; }
  const Eigen::Vector3d& rest(int v) const { return rest_[v]; }
  /// How far x_v can be outside the bounding box of its particles, as a share of the box's extent per axis: the sum of
  /// its negative weights. 0: a convex combination.
  double overshoot(int v) const { return overshoot_[v]; }
  const SurfacePoints& links() const { return links_; }
  const MappingStatistics& statistics() const { return statistics_; }

  /// From now on counts what the criteria would do without the graph, for studies: it looks at far more points.
  void CountPaperCriteria(const BackgroundGrid& grid);
  /// Null unless counted.
  const PaperCriteria* paper_criteria() const { return paper_ ? &*paper_ : nullptr; }

  Eigen::Vector3d Position(int v, const std::vector<Eigen::Vector3d>& particles) const;
  /// The same for two states at once.
  void Positions(int v, const std::vector<Eigen::Vector3d>& particles_t0,
                 const std::vector<Eigen::Vector3d>& particles_t1, Eigen::Vector3d& x_t0, Eigen::Vector3d& x_t1) const;

 private:
  bool SharesParticles(int p, const std::vector<int>& vertices) const;
  void Assign(int v, int point);

  const IntegrationPoints* points_;
  const ShapeFunctions* shape_;
  const Tissue* tissue_;
  std::vector<Eigen::Vector3d> rest_;
  std::vector<int> anchor_, point_, cell_;  // cell_: of the point that a vertex was mapped on last
  std::vector<double> overshoot_;
  std::vector<CutPlane> cut_plane_;
  std::vector<std::vector<int>> on_point_;
  SurfacePoints links_;
  MappingStatistics statistics_;
  std::optional<PaperCriteria> paper_;
};

}  // namespace meshless_cutting
