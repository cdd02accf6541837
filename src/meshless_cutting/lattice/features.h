// Creases and corners of a surface.
#pragma once

#include <array>
#include <vector>

#include "lattice/triangle_mesh.h"

namespace meshless_cutting {

/// Sharp features by vertex numbers of the mesh that they were found in.
struct Features {
  std::vector<std::array<int, 2>> creases;  // edges of two triangles whose normals differ by more than 40 degrees
  std::vector<int> corners;                 // ends of creases, where more than two meet or one turns by more than that
};

/// Features of an oriented mesh, in ascending order.
Features FindFeatures(const TriangleMesh& mesh);

}  // namespace meshless_cutting
