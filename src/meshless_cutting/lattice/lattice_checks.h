// What must hold of every lattice, as one predicate for tests and assertions.
#pragma once

#include <string>

#include "lattice/lattice.h"

namespace meshless_cutting {

/// Empty when the lattice is valid, else what is wrong first: positive volume of each tetrahedron, every vertex used,
/// links and faces unique and consistent with the tables, incidences complete, skin an oriented closed 2-manifold
/// (edges and vertices).
std::string CheckLattice(const Lattice& lattice);

}  // namespace meshless_cutting
