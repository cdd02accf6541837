// The polygons that lie between the pieces of one tetrahedron and on its faces, in symbols: nothing here knows of
// indices of drawn vertices, so that the surface and the volumes of the integration points use the same geometry.
//
// Notation: a face has 0 to 3 cut links. Two cut: a segment parts one vertex from the two others. Three cut: a Y
// through the face point parts all three. What is drawn on a face depends on its three links alone, so its two
// tetrahedra agree.
#pragma once

#include <array>
#include <vector>

#include "cut/material_graph.h"
#include "cut/tetrahedron_pieces.h"

namespace meshless_cutting {

/// A corner of a polygon, before it is known from which side it is seen.
struct CutPoint {
  enum class Kind { kVertex, kLink, kFace, kMiddle, kCentre };
  Kind kind = Kind::kVertex;
  int id = -1;       // lattice vertex, link, face, face, tetrahedron
  int segment = -1;  // kMiddle: which segment of the face
  friend bool operator==(const CutPoint& a, const CutPoint& b) {
    return a.kind == b.kind && a.id == b.id && a.segment == b.segment;
  }
};

/// A corner as seen from the side of the lattice vertex `side`.
struct Corner {
  CutPoint point;
  int side;
};
using CornerTriangle = std::array<Corner, 3>;

/// A piece of curve on a face that parts the lattice vertices `left` and `right`. Seen from outside the tetrahedron the
/// region of `left` has it on its counter-clockwise boundary in the sense from -> to.
struct Segment {
  Corner from, to;  // sides of the left region
  Corner from_right, to_right;
  int key;  // 0..2, names the segment on its face: the link it starts at (Y), or the one link that is not cut
  int left, right;
};

/// Segments of a face whose vertices `v` are counter-clockwise from outside; link i joins v[i] and v[i + 1]. Returns
/// how many.
int FaceSegments(const Lattice& lattice, const MaterialGraph& graph, int face, const std::array<int, 3>& v,
                 const std::array<int, 3>& links, std::array<Segment, 3>& segments);

/// Triangles of a face, each region from its own side, in the sense of `v`. `middles[key]`: the segment has a middle
/// point.
void FaceTriangles(const Lattice& lattice, const MaterialGraph& graph, int face, const std::array<int, 3>& v,
                   const std::array<int, 3>& links, const std::array<bool, 3>& middles,
                   std::vector<CornerTriangle>& triangles);

/// What the caps of a tetrahedron depend on beside its own links.
struct CapContext {
  std::array<std::array<bool, 3>, 4> middles{};  // per face, per segment key
  std::array<bool, 6> link_split{};              // the two sides of a cut link have points of their own
  std::array<std::array<int, 3>, 4>
      face_groups{};  // per face: vertices of the face with equal numbers share a face point
};

/// How a cap is split into triangles.
enum class CapShape { kNone, kTriangle, kDiagonal02, kDiagonal13, kFan };

/// Triangles between the pieces of a tetrahedron, each drawn once from either side and closing the piece of its side.
CapShape CapTriangles(const Lattice& lattice, const MaterialGraph& graph, int tetrahedron, const CapContext& context,
                      std::vector<CornerTriangle>& triangles);

/// Rest position of a corner, m, object frame.
Eigen::Vector3d RestPosition(const Lattice& lattice, const MaterialGraph& graph, const CutPoint& point);

/// Vertices and links of local face f of a tetrahedron, counter-clockwise from outside it; link i joins v[i] and v[i +
/// 1].
void TetrahedronFace(const Lattice& lattice, int tetrahedron, int f, std::array<int, 3>& v, std::array<int, 3>& links);

}  // namespace meshless_cutting
