// Where the points of the lattice lie, and where its edges leave the object.
#pragma once

#include <cstdint>
#include <vector>

#include "lattice/bcc_grid.h"
#include "lattice/triangle_mesh.h"

namespace meshless_cutting {

/// What isosurface stuffing needs to know of a surface, in lattice units.
struct LatticeSigns {
  std::vector<std::int8_t> sign;  // per point: 1 inside, -1 outside, 0 on the surface
  std::vector<int> cut_edges;     // lower point * kEdgesPerPoint + step, ascending: edges from inside to outside
  std::vector<double> cut_at;     // per cut edge: where it leaves, in (0, 1) from its lower point
};

/// Finds inside points by the winding number of `mesh` (lattice units, oriented outward) above one half, and for each
/// edge from inside to outside the crossing with a triangle at which the indicator changes; in a hole of the mesh,
/// where no triangle is crossed, the point where the winding number is one half.
LatticeSigns FindSigns(const BccGrid& grid, const TriangleMesh& mesh);

}  // namespace meshless_cutting
