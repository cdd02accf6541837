#include "lattice/lattice_builder.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "lattice/bcc_grid.h"
#include "lattice/feature_fit.h"
#include "lattice/lattice_quality.h"
#include "lattice/lattice_signs.h"
#include "lattice/manifold_repair.h"
#include "lattice/stuffing.h"
#include "lattice/surface_orientation.h"

namespace meshless_cutting {
namespace {

/// More lattice cubes than this in the bounding box is a mistake in the units: 100 million tetrahedra.
constexpr double kMostCubes = 1e7;

}  // namespace

FilledLattice FillWithLattice(const TriangleMesh& mesh, double lattice_size) {
  if (!(lattice_size > 0) || !std::isfinite(lattice_size)) {
    throw std::runtime_error("lattice size is " + std::to_string(lattice_size) + " m; expected a finite number > 0");
  }
  for (const Eigen::Vector3d& p : mesh.vertices) {
    if (!p.allFinite()) throw std::runtime_error("a vertex of the surface is not finite; expected finite coordinates");
  }
  const TriangleMesh surface = OrientOutward(mesh);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : surface.vertices) box.extend(p);
  if (surface.triangles.empty()) throw std::runtime_error("nothing to fill: the surface has no triangle");
  const double cubes = (box.sizes() / lattice_size).array().max(1).prod();
  if (cubes > kMostCubes) {
    throw std::runtime_error("lattice size of " + std::to_string(lattice_size) + " m gives " +
                             std::to_string(static_cast<long long>(cubes)) + " lattice cubes; expected at most " +
                             std::to_string(static_cast<long long>(kMostCubes)) +
                             ": use a larger lattice size or check the scale of the mesh");
  }
  const BccGrid grid(box, lattice_size);
  TriangleMesh in_lattice_units = surface;
  for (Eigen::Vector3d& p : in_lattice_units.vertices) p = grid.ToLattice(p);

  TetrahedronSoup soup = Stuff(grid, FindSigns(grid, in_lattice_units));
  RepairManifold(&soup);
  if (soup.tetrahedra.empty()) {
    throw std::runtime_error(
        "nothing is inside the surface; expected a surface that encloses a volume, of features larger than the lattice "
        "size of " +
        std::to_string(lattice_size) + " m");
  }
  FilledLattice filled;
  filled.lattice = BuildLattice(std::move(soup.vertices), std::move(soup.tetrahedra));
  PullOntoFeatures(in_lattice_units, &filled.lattice);
  for (Eigen::Vector3d& p : filled.lattice.vertices) p = grid.ToObject(p);
  filled.report.spacing = grid.spacing();
  MeasureLattice(filled.lattice, surface, lattice_size, &filled.report);
  return filled;
}

}  // namespace meshless_cutting
