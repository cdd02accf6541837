// Figures of merit of a lattice: angles, volume, distance between skin and input.
#pragma once

#include "lattice/lattice.h"
#include "lattice/lattice_builder.h"
#include "lattice/triangle_mesh.h"

namespace meshless_cutting {

/// Smallest and largest dihedral angle of a tetrahedron, degrees.
std::array<double, 2> DihedralRange(const std::array<Eigen::Vector3d, 4>& corners);

/// The skin of a lattice as triangles, with its own vertex numbers.
TriangleMesh SkinOf(const Lattice& lattice);

/// Volume that an oriented closed surface encloses, in the cube of its units.
double EnclosedVolume(const TriangleMesh& mesh);

/// Fills all of the report but `spacing`. The input surface is sampled at its vertices and, where its triangles are
/// larger than half of `lattice_size`, in between, about `lattice_size` apart. Input that does not bound the object
/// (inner walls, parts within other parts) does not count.
void MeasureLattice(const Lattice& lattice, const TriangleMesh& input, double lattice_size, LatticeReport* report);

}  // namespace meshless_cutting
