// Joins vertices at equal positions: files such as STL repeat a vertex for each triangle.
#pragma once

#include "lattice/triangle_mesh.h"

namespace meshless_cutting {

/// Vertices at exactly equal positions become one, in order of first appearance; unused vertices are dropped. Triangles
/// keep their order and orientation; those that lose a corner (two equal vertices) are dropped, they have no area.
TriangleMesh WeldEqualVertices(const TriangleMesh& mesh);

}  // namespace meshless_cutting
