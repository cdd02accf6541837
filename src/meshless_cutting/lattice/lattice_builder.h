// Fills a triangle mesh with a tetrahedral lattice: isosurface stuffing (Labelle & Shewchuk 2007).
#pragma once

#include "lattice/lattice.h"
#include "lattice/triangle_mesh.h"

namespace meshless_cutting {

struct LatticeReport {
  Eigen::Vector3d spacing = Eigen::Vector3d::Zero();  // m, lattice size per axis as fitted to the bounding box
  // Distance of samples of the input surface from the skin; input that does not bound the object (an inner wall) is
  // left out.
  double input_to_skin_max_m = 0;
  double input_to_skin_mean_m = 0;
  double skin_to_input_max_m = 0;  // largest distance of a skin vertex from the input surface
  double min_dihedral_deg = 0;     // over all tetrahedra
  double max_dihedral_deg = 0;
  double volume_m3 = 0;  // enclosed by the skin
};

struct FilledLattice {
  Lattice lattice;
  LatticeReport report;
};

/// Body-centred cubic lattice of about `lattice_size` (m), cut off at the surface of `mesh`. A point is inside where
/// the generalised winding number is above one half, after faces are turned outward and equal ones dropped
/// (surface_orientation.h): holes, flipped or doubled faces and self-intersections are allowed. The lattice size is
/// fitted per axis so that the bounding box is a whole number of lattice cubes: boxes come out exact.
/// Vertices of the skin lie on the input surface; in a hole of it, where the winding number is one half; a few may lie
/// inside where the object is thinner than 1.5 lattice sizes. Edges and corners are kept where tetrahedra stay good.
/// Deterministic. Throws std::runtime_error, one line: nothing is inside, lattice size not > 0 or too small for memory,
/// vertex not finite.
FilledLattice FillWithLattice(const TriangleMesh& mesh, double lattice_size);

}  // namespace meshless_cutting
