// Gives a triangle soup one orientation, so that its winding number tells inside from outside.
#pragma once

#include "lattice/triangle_mesh.h"

namespace meshless_cutting {

/// Vertices are welded, of equal triangles one is kept. Triangles joined by edges that two of them share form a *patch*
/// and are turned alike. Each patch is then turned by what can be seen (after Takayama et al. 2014, "A simple method
/// for correcting facet orientations in polygon meshes based on ray casting"): the side from which more rays get away
/// is outside. A patch that is seen from neither side
///  * and is a sheet rather than a shell (a wall inside of the object) is dropped;
///  * and was oriented in one way in the input keeps this, relative to the patches around it: a cavity stays a cavity;
///  * else is turned outward: what it encloses counts as inside.
/// Promised: an object that is closed up to small holes is filled whatever the order, direction and multiplicity of its
/// triangles. Not promised: the inside of two walls closer together than anything else, such as a double-sided copy
/// that is offset or triangulated differently; they are the object then.
TriangleMesh OrientOutward(const TriangleMesh& mesh);

}  // namespace meshless_cutting
