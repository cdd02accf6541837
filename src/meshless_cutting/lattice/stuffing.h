// Isosurface stuffing (Labelle & Shewchuk 2007): from signs and cut points to tetrahedra.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "lattice/bcc_grid.h"
#include "lattice/lattice_signs.h"

namespace meshless_cutting {

/// Vertices and tetrahedra (positive volume, conforming), before links and faces are derived.
struct TetrahedronSoup {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 4>> tetrahedra;
};

/// Warps lattice points that are too near to a cut point onto it and fills each lattice tetrahedron that has an inside
/// vertex by its stencil. Vertices in lattice units. The angles of the result are bounded (10.7 to 164.8 degrees) for
/// any signs and cut points, in units where lattice cubes are cubes.
TetrahedronSoup Stuff(const BccGrid& grid, LatticeSigns signs);

}  // namespace meshless_cutting
