// The closed surface of the object for any set of cut links: skin faces, split where links are cut, and both lips of
// each cut.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cut/cut_geometry.h"
#include "surface/surface.h"

namespace meshless_cutting {

/// A vertex of the drawn surface: where it is at rest and on whose side of all cuts it lies.
struct SurfaceVertex {
  Eigen::Vector3d rest;  // m, object frame
  int anchor;            // lattice vertex that the material at this vertex belongs to
};

/// Keeps the triangles up to date with the graph, touching only what lies around newly cut links.
///
/// One drawn vertex stands for all corners that meet at a point through uncut material: around a cut link the two sides
/// are one as long as one tetrahedron around it holds both ends in one piece (the crack front); a face point is shared
/// by those of the face's three vertices that one of its two tetrahedra joins. Where both ends of a segment are shared
/// but its inside is open, a middle point keeps the mesh edge-manifold. The union of tetrahedron pieces glued along
/// face regions has exactly these triangles as its boundary: the surface is closed for any set of cut links.
class CutSurface {
 public:
  CutSurface(const Lattice& lattice, const MaterialGraph& graph);

  /// Call after `links` were cut in the graph. Allocates.
  void Update(const std::vector<int>& links);

  const std::vector<SurfaceVertex>& vertices() const { return vertices_; }
  /// Surface vertex of a lattice vertex, -1 for one inside the object.
  int VertexOf(int lattice_vertex) const { return skin_vertex_[lattice_vertex]; }
  /// Drawn vertex at the cut of a link on the side of its first (0) or second (1) vertex; -1: not drawn.
  int VertexOnLink(int link, int side) const { return link_vertex_[link][side]; }
  /// Tetrahedra whose pieces, or the shape of the faces between them, the last Update() changed. Sorted.
  const std::vector<int>& changed_tetrahedra() const { return changed_; }
  /// One lip of all cut faces, m^2, at rest.
  double cut_area() const { return cut_area_; }

  /// Triangles and regions of `surface`; the other members are left alone.
  void WriteTriangles(Surface& surface) const;

  /// Closed boundary of each piece of a tetrahedron, for volumes: triangle corners with the piece they belong to.
  void PieceTriangles(int tetrahedron, std::vector<CornerTriangle>& triangles) const;

 private:
  using Triangle = std::array<std::uint32_t, 3>;
  struct FaceSlot {
    int segment_count = 0;
    std::array<int, 3> face_point = {-1, -1, -1};  // surface vertex on the side of face vertex i
    std::array<int, 3> group = {0, 1, 2};          // face vertices that share a face point have equal numbers
    std::array<bool, 3> has_middle{};              // by segment key
    std::array<std::array<int, 2>, 3> middle = {{{-1, -1}, {-1, -1}, {-1, -1}}};  // left and right copy
  };
  struct CapSlot {
    unsigned pieces_mask = 0;                      // cut mask when the centres were made
    std::array<int, 4> centre = {-1, -1, -1, -1};  // by piece
    CapShape shape = CapShape::kNone;
    std::vector<Triangle> triangles;
    double area = 0;
  };

  bool Joined(int tetrahedron, int a, int b) const;
  bool SplitAround(int link) const;
  FaceSlot& SlotOf(int face);
  void UpdateFace(int face);
  int Resolve(const Corner& corner);
  int AddVertex(const Corner& corner);
  CapContext ContextOf(int tetrahedron) const;
  void DrawSkin(int face);
  bool DrawCaps(int tetrahedron);  // true when their shape is another

  const Lattice* lattice_;
  const MaterialGraph* graph_;
  std::vector<SurfaceVertex> vertices_;
  std::vector<int> skin_vertex_;                       // per lattice vertex
  std::vector<std::array<int, 2>> link_vertex_;        // per link: copy on the side of its first and second vertex
  std::vector<std::uint8_t> link_split_;               // per link
  std::vector<int> face_slot_, skin_slot_, cap_slot_;  // per face, face, tetrahedron: index below or -1
  std::vector<FaceSlot> faces_;
  std::vector<Triangle> skin_;               // per skin face, in the order of the lattice's faces, while it is whole
  std::vector<int> torn_slot_;               // per skin face: index below or -1
  std::vector<std::vector<Triangle>> torn_;  // triangles of the skin faces that have a cut link
  std::vector<CapSlot> caps_;
  std::vector<int> changed_;
  double cut_area_ = 0;
};

}  // namespace meshless_cutting
