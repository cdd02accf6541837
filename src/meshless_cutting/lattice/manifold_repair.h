// Makes the boundary of a tetrahedral mesh an oriented, closed 2-manifold.
#pragma once

#include "lattice/stuffing.h"

namespace meshless_cutting {

/// Where the boundary touches itself:
///  * at a vertex whose tetrahedra fall into several face-connected groups, each group gets its own copy of the vertex;
///  * at an edge with several fans of tetrahedra, the fans beyond the first are split at a midpoint of their own: the
///  same
///    shape, but the edge is no longer shared;
///  * at a vertex where two cavities meet, a path of tetrahedra between them is removed.
/// Vertices that no tetrahedron uses are dropped. Returns the number of tetrahedra removed.
int RepairManifold(TetrahedronSoup* soup);

}  // namespace meshless_cutting
