#include "lattice/lattice_builder.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

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

/// Interleaves the lowest 21 bits of three numbers (Morton 1966).
std::uint64_t MortonCode(const Eigen::Vector3d& p) {
  std::uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::uint64_t>(p[axis]);
    for (int bit = 0; bit < 21; ++bit) code |= (n >> bit & 1u) << (3 * bit + axis);
  }
  return code;
}

/// Numbers vertices and tetrahedra so that neighbours in space are neighbours in memory: what a cut or a search touches
/// lies in few cache lines.
void SortByPlace(TetrahedronSoup* soup) {
  Eigen::Vector3d low = soup->vertices[0];
  for (const Eigen::Vector3d& p : soup->vertices) low = low.cwiseMin(p);
  std::vector<std::pair<std::uint64_t, int>> order;
  for (size_t v = 0; v < soup->vertices.size(); ++v)
    order.emplace_back(MortonCode(2 * (soup->vertices[v] - low)), static_cast<int>(v));
  std::sort(order.begin(), order.end());
  std::vector<Eigen::Vector3d> vertices;
  std::vector<int> number(order.size());
  for (const auto& [code, v] : order) {
    number[v] = static_cast<int>(vertices.size());
    vertices.push_back(soup->vertices[v]);
  }
  soup->vertices = std::move(vertices);
  for (auto& tetrahedron : soup->tetrahedra)
    for (int& v : tetrahedron) v = number[v];
  std::sort(soup->tetrahedra.begin(), soup->tetrahedra.end(), [](const auto& a, const auto& b) {
    const int first_a = *std::min_element(a.begin(), a.end()), first_b = *std::min_element(b.begin(), b.end());
    return first_a != first_b ? first_a < first_b : a < b;
  });
}

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
  SortByPlace(&soup);
  FilledLattice filled;
  filled.lattice = BuildLattice(std::move(soup.vertices), std::move(soup.tetrahedra));
  PullOntoFeatures(in_lattice_units, &filled.lattice);
  for (Eigen::Vector3d& p : filled.lattice.vertices) p = grid.ToObject(p);
  filled.report.spacing = grid.spacing();
  MeasureLattice(filled.lattice, surface, lattice_size, &filled.report);
  return filled;
}

}  // namespace meshless_cutting
