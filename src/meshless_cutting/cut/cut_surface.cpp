#include "cut/cut_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace meshless_cutting {
namespace {

using Kind = CutPoint::Kind;

template <typename Values>
int IndexOf(const Values& values, int value) {
  return static_cast<int>(std::find(values.begin(), values.end(), value) - values.begin());
}

void SortUnique(std::vector<int>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

CutSurface::CutSurface(const Lattice& lattice, const MaterialGraph& graph)
    : lattice_(&lattice),
      graph_(&graph),
      skin_vertex_(lattice.vertices.size(), -1),
      link_vertex_(lattice.links.size(), {-1, -1}),
      link_split_(lattice.links.size(), 0),
      face_slot_(lattice.faces.size(), -1),
      skin_slot_(lattice.faces.size(), -1),
      cap_slot_(lattice.tetrahedra.size(), -1) {
  for (size_t face = 0; face < lattice.faces.size(); ++face) {
    if (lattice.face_tetrahedra[face][1] >= 0) continue;
    skin_slot_[face] = static_cast<int>(skin_.size());
    Triangle triangle;
    for (int i = 0; i < 3; ++i) {
      const int v = lattice.faces[face][i];
      triangle[i] = static_cast<std::uint32_t>(Resolve({{Kind::kVertex, v, -1}, v}));
    }
    skin_.push_back(triangle);
  }
  torn_slot_.assign(skin_.size(), -1);
}

bool CutSurface::Joined(int tetrahedron, int a, int b) const {
  const TetrahedronPieces& pieces = PiecesOf(graph_->CutMask(tetrahedron));
  const std::array<int, 4>& t = lattice_->tetrahedra[tetrahedron];
  return pieces.piece[IndexOf(t, a)] == pieces.piece[IndexOf(t, b)];
}

bool CutSurface::SplitAround(int link) const {
  const auto& [a, b] = lattice_->links[link];
  return std::none_of(lattice_->link_tetrahedra.begin(link), lattice_->link_tetrahedra.end(link),
                      [&, first = a, second = b](int t) { return Joined(t, first, second); });
}

CutSurface::FaceSlot& CutSurface::SlotOf(int face) {
  if (face_slot_[face] < 0) {
    face_slot_[face] = static_cast<int>(faces_.size());
    faces_.emplace_back();
  }
  return faces_[face_slot_[face]];
}

void CutSurface::UpdateFace(int face) {
  const std::array<int, 3>&v = lattice_->faces[face], &links = lattice_->face_links[face];
  std::array<Segment, 3> segments;
  const int count = FaceSegments(*lattice_, *graph_, face, v, links, segments);
  if (count == 0) return;
  FaceSlot& slot = SlotOf(face);
  if (slot.segment_count != count) {  // the third link was cut: the segments are others now
    slot.segment_count = count;
    slot.has_middle = {};
    slot.middle.fill({-1, -1});
  }
  auto joined = [&](int a, int b) {
    const auto& [t0, t1] = lattice_->face_tetrahedra[face];
    return Joined(t0, a, b) || (t1 >= 0 && Joined(t1, a, b));
  };
  if (count == 3) {
    // Groups only ever split: the part with the point's anchor keeps the point.
    std::array<int, 3> group = {0, 1, 2};
    for (int round = 0; round < 2; ++round)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < i; ++j)
          if (group[i] != group[j] && joined(v[i], v[j])) group[i] = group[j] = std::min(group[i], group[j]);
    for (int i = 0; i < 3; ++i)
      if (slot.face_point[i] >= 0 && group[i] != group[IndexOf(v, vertices_[slot.face_point[i]].anchor)])
        slot.face_point[i] = -1;
    slot.group = group;
  }
  for (int i = 0; i < count; ++i) {
    const Segment& s = segments[i];
    if (slot.has_middle[s.key] || joined(s.left, s.right)) continue;
    auto shared = [&](const Corner& here, const Corner& across) {
      if (here.point.kind == Kind::kLink) return !link_split_[here.point.id];
      return slot.group[IndexOf(v, here.side)] == slot.group[IndexOf(v, across.side)];
    };
    slot.has_middle[s.key] = shared(s.from, s.from_right) && shared(s.to, s.to_right);
  }
}

int CutSurface::AddVertex(const Corner& corner) {
  vertices_.push_back({RestPosition(*lattice_, *graph_, corner.point), corner.side});
  return static_cast<int>(vertices_.size()) - 1;
}

int CutSurface::Resolve(const Corner& corner) {
  const int id = corner.point.id;
  switch (corner.point.kind) {
    case Kind::kVertex:
      if (skin_vertex_[id] < 0) skin_vertex_[id] = AddVertex(corner);
      return skin_vertex_[id];
    case Kind::kLink: {
      std::array<int, 2>& copies = link_vertex_[id];
      int& copy = copies[lattice_->links[id][1] == corner.side];
      if (copy < 0) {
        const int vertex = AddVertex(corner);
        if (link_split_[id])
          copy = vertex;
        else
          copies = {vertex, vertex};
      }
      return copy;
    }
    case Kind::kFace: {
      FaceSlot& slot = faces_[face_slot_[id]];
      const int i = IndexOf(lattice_->faces[id], corner.side);
      if (slot.face_point[i] < 0) {
        const int vertex = AddVertex(corner);
        for (int j = 0; j < 3; ++j)
          if (slot.group[j] == slot.group[i]) slot.face_point[j] = vertex;
      }
      return slot.face_point[i];
    }
    case Kind::kMiddle: {
      // A segment parts one face vertex from the next (Y), or the vertex opposite to its key from the two others.
      FaceSlot& slot = faces_[face_slot_[id]];
      const int i = IndexOf(lattice_->faces[id], corner.side), key = corner.point.segment;
      const bool second = slot.segment_count == 1 ? i != (key + 2) % 3 : i == (key + 1) % 3;
      int& copy = slot.middle[key][second];
      if (copy < 0) copy = AddVertex(corner);
      return copy;
    }
    case Kind::kCentre:
      break;
  }
  CapSlot& slot = caps_[cap_slot_[id]];
  const TetrahedronPieces& pieces = PiecesOf(graph_->CutMask(id));
  int& copy = slot.centre[pieces.piece[IndexOf(lattice_->tetrahedra[id], corner.side)]];
  if (copy < 0) copy = AddVertex(corner);
  return copy;
}

CapContext CutSurface::ContextOf(int tetrahedron) const {
  CapContext context;
  for (int l = 0; l < 6; ++l) context.link_split[l] = link_split_[lattice_->tetrahedron_links[tetrahedron][l]];
  for (int f = 0; f < 4; ++f) {
    const int slot = face_slot_[lattice_->tetrahedron_faces[tetrahedron][f]];
    if (slot < 0) continue;
    context.middles[f] = faces_[slot].has_middle;
    context.face_groups[f] = faces_[slot].group;
  }
  return context;
}

void CutSurface::DrawSkin(int face) {
  std::vector<CornerTriangle> corners;
  const int slot = face_slot_[face];
  FaceTriangles(*lattice_, *graph_, face, lattice_->faces[face], lattice_->face_links[face],
                slot < 0 ? std::array<bool, 3>{} : faces_[slot].has_middle, corners);
  int& torn = torn_slot_[skin_slot_[face]];
  if (torn < 0) {
    torn = static_cast<int>(torn_.size());
    torn_.emplace_back();
  }
  std::vector<Triangle>& triangles = torn_[torn];
  triangles.clear();
  for (const CornerTriangle& c : corners)
    triangles.push_back({static_cast<std::uint32_t>(Resolve(c[0])), static_cast<std::uint32_t>(Resolve(c[1])),
                         static_cast<std::uint32_t>(Resolve(c[2]))});
}

bool CutSurface::DrawCaps(int tetrahedron) {
  const unsigned mask = graph_->CutMask(tetrahedron);
  if (PiecesOf(mask).count == 1) return false;
  if (cap_slot_[tetrahedron] < 0) {
    cap_slot_[tetrahedron] = static_cast<int>(caps_.size());
    caps_.emplace_back();
  }
  CapSlot& slot = caps_[cap_slot_[tetrahedron]];
  if (slot.pieces_mask != mask) slot.centre.fill(-1);
  slot.pieces_mask = mask;
  std::vector<CornerTriangle> corners;
  const CapShape shape = CapTriangles(*lattice_, *graph_, tetrahedron, ContextOf(tetrahedron), corners);
  slot.triangles.clear();
  double area = 0;
  for (const CornerTriangle& c : corners) {
    Triangle triangle;
    for (int i = 0; i < 3; ++i) triangle[i] = static_cast<std::uint32_t>(Resolve(c[i]));
    slot.triangles.push_back(triangle);
    const Eigen::Vector3d& a = vertices_[triangle[0]].rest;
    area +=
        0.25 * (vertices_[triangle[1]].rest - a).cross(vertices_[triangle[2]].rest - a).norm();  // both lips are here
  }
  cut_area_ += area - slot.area;
  slot.area = area;
  return std::exchange(slot.shape, shape) != shape;
}

void CutSurface::Update(const std::vector<int>& links) {
  changed_.clear();
  for (int link : links)
    changed_.insert(changed_.end(), lattice_->link_tetrahedra.begin(link), lattice_->link_tetrahedra.end(link));
  SortUnique(changed_);

  std::vector<int> touched_links;
  for (int t : changed_)
    for (unsigned l = 0; l < 6; ++l)
      if (graph_->CutMask(t) >> l & 1u) touched_links.push_back(lattice_->tetrahedron_links[t][l]);
  SortUnique(touched_links);

  std::vector<int> tetrahedra, faces;
  for (int link : touched_links) {
    if (!link_split_[link] && SplitAround(link)) {
      link_split_[link] = 1;
      std::array<int, 2>& copies = link_vertex_[link];  // one point until now; it stays with its anchor
      if (copies[0] >= 0) copies[vertices_[copies[0]].anchor == lattice_->links[link][0]] = -1;
    }
    tetrahedra.insert(tetrahedra.end(), lattice_->link_tetrahedra.begin(link), lattice_->link_tetrahedra.end(link));
  }
  SortUnique(tetrahedra);
  for (int t : tetrahedra)
    faces.insert(faces.end(), lattice_->tetrahedron_faces[t].begin(), lattice_->tetrahedron_faces[t].end());
  SortUnique(faces);

  for (int face : faces) UpdateFace(face);
  for (int face : faces)
    if (const auto& l = lattice_->face_links[face];
        skin_slot_[face] >= 0 && (graph_->IsCut(l[0]) || graph_->IsCut(l[1]) || graph_->IsCut(l[2])))
      DrawSkin(face);
  for (int t : tetrahedra)
    if (DrawCaps(t)) changed_.push_back(t);
  SortUnique(changed_);
}

void CutSurface::WriteTriangles(Surface& surface) const {
  surface.triangles.clear();
  surface.region.clear();
  for (size_t i = 0; i < skin_.size(); ++i) {
    if (torn_slot_[i] < 0)
      surface.triangles.push_back(skin_[i]);
    else
      surface.triangles.insert(surface.triangles.end(), torn_[torn_slot_[i]].begin(), torn_[torn_slot_[i]].end());
  }
  surface.region.resize(surface.triangles.size(), SurfaceRegion::kSkin);
  for (const CapSlot& cap : caps_)
    surface.triangles.insert(surface.triangles.end(), cap.triangles.begin(), cap.triangles.end());
  surface.region.resize(surface.triangles.size(), SurfaceRegion::kCutFace);
}

void CutSurface::PieceTriangles(int tetrahedron, std::vector<CornerTriangle>& triangles) const {
  triangles.clear();
  for (int f = 0; f < 4; ++f) {
    std::array<int, 3> v, links;
    TetrahedronFace(*lattice_, tetrahedron, f, v, links);
    FaceTriangles(*lattice_, *graph_, lattice_->tetrahedron_faces[tetrahedron][f], v, links, {}, triangles);
  }
  CapTriangles(*lattice_, *graph_, tetrahedron, ContextOf(tetrahedron), triangles);
}

}  // namespace meshless_cutting
