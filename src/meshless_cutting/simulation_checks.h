// The invariants of topology and mapping as named predicates. Each returns nothing when it holds, else the first thing
// that breaks it, in words.
#pragma once

#include <string>

#include "cut/soft_body.h"
#include "surface/surface.h"

namespace meshless_cutting {

/// Every directed edge of the surface is matched by exactly one opposite one (edge-manifold, closed, oriented), no
/// triangle has two equal corners or zero area at rest, all arrays fit.
std::string CheckSurfaceClosed(const Surface& surface);

/// Volume enclosed by the surface at rest, m^3.
double RestVolume(const Surface& surface);

/// Fragments of the surface = connected groups of the graph = pieces of the physics; volumes of the points add up to
/// the enclosed volume, and of each fragment but for what cuts that meet redraw; mass is density times volume.
std::string CheckPieces(const SoftBody& body);

/// No integration point sees a particle across a cut: the points that share a particle are joined through material
/// inside its support.
std::string CheckTwins(const SoftBody& body);

/// No piece hangs on a wall that it does not touch: of the twins at a node in a fixed or prescribed box those are held whose
/// material reaches into the box, and the others only where none does.
std::string CheckHeld(const SoftBody& body);

/// No vertex is mapped across a cut: the graph joins the vertex to the point within the cells that the point's group
/// touches.
std::string CheckMapping(const SoftBody& body);

/// Shape functions at all points and vertices reproduce constant and linear fields to 1e-10.
std::string CheckReproduction(const SoftBody& body);

/// All of the above.
std::string CheckBody(const SoftBody& body);

}  // namespace meshless_cutting
