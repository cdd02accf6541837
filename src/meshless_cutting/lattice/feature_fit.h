// Pulls the skin of a lattice onto creases and corners of the input surface.
#pragma once

#include "lattice/lattice.h"
#include "lattice/triangle_mesh.h"

namespace meshless_cutting {

/// Isosurface stuffing cuts edges off: where a skin link bridges a crease or a skin vertex is nearest to a corner, the
/// vertex moves onto it, if all tetrahedra there keep good angles. Only positions change. `lattice` and `surface` in
/// units in which the lattice size is about 1. Returns how many vertices moved.
int PullOntoFeatures(const TriangleMesh& surface, Lattice* lattice);

}  // namespace meshless_cutting
