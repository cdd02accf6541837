// Bodies that a scene describes by numbers, as triangle meshes.
#pragma once

#include "lattice/triangle_mesh.h"
#include "scene/scene.h"

namespace meshless_cutting {

/// Closed and oriented outward. A box is exact. A cylinder is a prism of 96 sides whose volume is that of the cylinder:
/// its faces lie within 0.1 % of the radius of the true surface.
TriangleMesh MeshOf(const Primitive& primitive);

}  // namespace meshless_cutting
