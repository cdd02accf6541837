// The tetrahedral lattice that fills the object: the nodes and links of the material graph, at rest. Immutable.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace meshless_cutting {

/// The six links of a tetrahedron by its local vertices: link l joins kTetrahedronLinks[l][0] and [1].
inline constexpr std::array<std::array<int, 2>, 6> kTetrahedronLinks = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
/// The four faces by local vertices, counter-clockwise seen from outside; face f is opposite to vertex f.
inline constexpr std::array<std::array<int, 3>, 4> kTetrahedronFaces = {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// Compressed rows: row i holds items[offsets[i]] .. items[offsets[i + 1]].
struct Incidence {
  std::vector<int> offsets;
  std::vector<int> items;
  const int* begin(int row) const { return items.data() + offsets[row]; }
  const int* end(int row) const { return items.data() + offsets[row + 1]; }
};

/// A conforming tetrahedral mesh whose boundary is the skin: an oriented 2-manifold, closed.
struct Lattice {
  std::vector<Eigen::Vector3d> vertices;       // rest positions X, m, object frame
  std::vector<std::array<int, 4>> tetrahedra;  // positive volume
  std::vector<std::array<int, 2>> links;       // vertex pairs, first < second, sorted
  std::vector<std::array<int, 3>> faces;       // vertices, counter-clockwise seen from outside the first tetrahedron
  std::vector<std::array<int, 3>> face_links;  // link between face vertices (0,1), (1,2), (2,0)
  std::vector<std::array<int, 2>> face_tetrahedra;    // second is -1 on the skin
  std::vector<std::array<int, 6>> tetrahedron_links;  // by kTetrahedronLinks
  std::vector<std::array<int, 4>> tetrahedron_faces;  // by kTetrahedronFaces
  Incidence link_tetrahedra;                          // link -> tetrahedra around it
  Incidence vertex_links;                             // vertex -> links at it
};

/// Derives links, faces and incidences from vertices and tetrahedra (positive volume, conforming).
Lattice BuildLattice(std::vector<Eigen::Vector3d> vertices, std::vector<std::array<int, 4>> tetrahedra);

}  // namespace meshless_cutting
