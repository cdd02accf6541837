// The criteria of section 2.2 alone, without the graph: how often would they have mapped a vertex across a cut or a fold?
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "cut/integration_points.h"
#include "tissue/background_grid.h"

namespace meshless_cutting {

/// Choices since counting began, and how many of them fall across a cut or a fold, with one criterion after the other
/// taken into account. Across: neither a point of the vertex nor one that has material in common with such a point.
struct PaperCriteriaCounts {
  std::uint64_t mapped = 0;
  std::uint64_t nearest = 0;          // distance alone
  std::uint64_t tangent_plane = 0;    // and below the tangent plane
  std::uint64_t cut_plane = 0;        // and on this side of the latest cut
  std::uint64_t shared_particle = 0;  // and a particle in common with every neighbouring vertex: all of section 2.2
  std::uint64_t none = 0;             // no point within reach meets all of them
};

class PaperCriteria {
 public:
  PaperCriteria(const IntegrationPoints& points, const BackgroundGrid& grid) : points_(&points), grid_(&grid) {}

  /// Each tells whether point p meets one criterion for the vertex at hand.
  struct Criteria {
    std::function<bool(int p)> tangent_plane, cut_plane, shared_particle;
  };
  /// Counts the choices for a vertex at rest position X (m) whose own points, by the graph, are `own` (sorted).
  void Count(const Eigen::Vector3d& X, const std::vector<int>& own, const Criteria& criteria);

  const PaperCriteriaCounts& counts() const { return counts_; }

 private:
  const IntegrationPoints* points_;
  const BackgroundGrid* grid_;
  PaperCriteriaCounts counts_;
};

}  // namespace meshless_cutting
