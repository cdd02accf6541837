#include "cut/cut_geometry.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace meshless_cutting {
namespace {

using Kind = CutPoint::Kind;

int IndexOf(const std::array<int, 3>& values, int value) {
  return static_cast<int>(std::find(values.begin(), values.end(), value) - values.begin());
}

int LocalIndex(const std::array<int, 4>& values, int value) {
  return static_cast<int>(std::find(values.begin(), values.end(), value) - values.begin());
}

/// A directed edge on the boundary of a cap, seen from the piece that the cap closes.
struct CapEdge {
  Corner from, to;
  Corner from_other, to_other;  // the same points seen from the piece across
  bool has_middle = false;
  Corner middle, middle_other;
};

double SmallestArea(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                    const Eigen::Vector3d& d) {
  return std::min((b - a).cross(c - a).norm(), (c - a).cross(d - a).norm());  // split along a-c
}

}  // namespace

void TetrahedronFace(const Lattice& lattice, int tetrahedron, int f, std::array<int, 3>& v, std::array<int, 3>& links) {
  const std::array<int, 4>& t = lattice.tetrahedra[tetrahedron];
  const int face = lattice.tetrahedron_faces[tetrahedron][f];
  for (int i = 0; i < 3; ++i) v[i] = t[kTetrahedronFaces[f][i]];
  for (int i = 0; i < 3; ++i) {
    // Link i of the face joins its vertices i and i + 1; find it whichever way round the face is stored.
    const int opposite = v[(i + 2) % 3];
    const int stored = IndexOf(lattice.faces[face], opposite);
    links[i] = lattice.face_links[face][(stored + 1) % 3];
  }
}

int FaceSegments(const Lattice& lattice, const MaterialGraph& graph, int face, const std::array<int, 3>& v,
                 const std::array<int, 3>& links, std::array<Segment, 3>& segments) {
  const std::array<bool, 3> cut = {graph.IsCut(links[0]), graph.IsCut(links[1]), graph.IsCut(links[2])};
  const int count = cut[0] + cut[1] + cut[2];
  const std::array<int, 3>& stored = lattice.face_links[face];
  if (count == 2) {
    const int whole = !cut[0] ? 0 : !cut[1] ? 1 : 2;  // joins b and c; a is alone
    const int b = v[whole], c = v[(whole + 1) % 3], a = v[(whole + 2) % 3];
    const CutPoint ab{Kind::kLink, links[(whole + 2) % 3]}, ca{Kind::kLink, links[(whole + 1) % 3]};
    segments[0] = {{ab, a}, {ca, a}, {ab, b}, {ca, c}, IndexOf(stored, links[whole]), a, b};
    return 1;
  }
  if (count == 3) {
    const CutPoint centre{Kind::kFace, face};
    for (int i = 0; i < 3; ++i) {
      const int a = v[i], b = v[(i + 1) % 3];
      const CutPoint ab{Kind::kLink, links[i]};
      segments[i] = {{ab, a}, {centre, a}, {ab, b}, {centre, b}, IndexOf(stored, links[i]), a, b};
    }
    return 3;
  }
  return 0;
}

void FaceTriangles(const Lattice& lattice, const MaterialGraph& graph, int face, const std::array<int, 3>& v,
                   const std::array<int, 3>& links, const std::array<bool, 3>& middles,
                   std::vector<CornerTriangle>& triangles) {
  const std::array<bool, 3> cut = {graph.IsCut(links[0]), graph.IsCut(links[1]), graph.IsCut(links[2])};
  const int count = cut[0] + cut[1] + cut[2];
  auto vertex = [](int a) { return Corner{{Kind::kVertex, a}, a}; };
  if (count == 0) {
    triangles.push_back({vertex(v[0]), vertex(v[1]), vertex(v[2])});
    return;
  }
  if (count == 1) {
    const int i = cut[0] ? 0 : cut[1] ? 1 : 2;
    const int a = v[i], b = v[(i + 1) % 3], c = v[(i + 2) % 3];
    const Corner ab{{Kind::kLink, links[i]}, a};
    triangles.push_back({vertex(a), ab, vertex(c)});
    triangles.push_back({ab, vertex(b), vertex(c)});
    return;
  }
  std::array<Segment, 3> segments;
  FaceSegments(lattice, graph, face, v, links, segments);
  if (count == 2) {
    const Segment& s = segments[0];
    const int b = s.from_right.side, c = s.to_right.side;
    if (middles[s.key]) {
      const CutPoint middle{Kind::kMiddle, face, s.key};
      triangles.push_back({vertex(s.left), s.from, Corner{middle, s.left}});
      triangles.push_back({vertex(s.left), Corner{middle, s.left}, s.to});
      triangles.push_back({Corner{middle, b}, s.from_right, vertex(b)});
      triangles.push_back({Corner{middle, b}, vertex(b), vertex(c)});
      triangles.push_back({Corner{middle, b}, vertex(c), s.to_right});
    } else {
      triangles.push_back({vertex(s.left), s.from, s.to});
      triangles.push_back({s.from_right, vertex(b), s.to_right});
      triangles.push_back({vertex(b), vertex(c), s.to_right});
    }
    return;
  }
  for (int i = 0; i < 3; ++i) {  // the region of v[i]: v, p(i, i+1), face point, p(i-1, i)
    const Segment &next = segments[i], &last = segments[(i + 2) % 3];
    const Corner a = vertex(v[i]);
    if (middles[next.key]) {
      const Corner middle{{Kind::kMiddle, face, next.key}, v[i]};
      triangles.push_back({a, next.from, middle});
      triangles.push_back({a, middle, next.to});
    } else {
      triangles.push_back({a, next.from, next.to});
    }
    if (middles[last.key]) {
      const Corner middle{{Kind::kMiddle, face, last.key}, v[i]};
      triangles.push_back({a, last.to_right, middle});
      triangles.push_back({a, middle, last.from_right});
    } else {
      triangles.push_back({a, last.to_right, last.from_right});
    }
  }
}

CapShape CapTriangles(const Lattice& lattice, const MaterialGraph& graph, int tetrahedron, const CapContext& context,
                      std::vector<CornerTriangle>& triangles) {
  const TetrahedronPieces& pieces = PiecesOf(graph.CutMask(tetrahedron));
  if (pieces.count == 1) return CapShape::kNone;
  const std::array<int, 4>& t = lattice.tetrahedra[tetrahedron];
  auto piece_of = [&](int vertex) { return pieces.piece[LocalIndex(t, vertex)]; };

  // Each segment that parts two pieces bounds a cap on either side; a cap runs against the region of the face it meets.
  std::array<CapEdge, 12> edges;  // from the left piece's point of view
  int edge_count = 0;
  bool middles = false;
  for (int f = 0; f < 4; ++f) {
    std::array<int, 3> v, links;
    TetrahedronFace(lattice, tetrahedron, f, v, links);
    const int face = lattice.tetrahedron_faces[tetrahedron][f];
    std::array<Segment, 3> segments;
    const int count = FaceSegments(lattice, graph, face, v, links, segments);
    for (int i = 0; i < count; ++i) {
      const Segment& s = segments[i];
      if (piece_of(s.left) == piece_of(s.right)) continue;
      CapEdge& edge = edges[edge_count++];
      edge = {s.to, s.from, s.to_right, s.from_right, false, {}, {}};
      if (context.middles[f][s.key]) {
        const CutPoint middle{Kind::kMiddle, face, s.key};
        edge.has_middle = middles = true;
        edge.middle = {middle, s.left};
        edge.middle_other = {middle, s.right};
      }
    }
  }

  auto has_own = [&](const Corner& here, const Corner& across) {  // do the two sides have points of their own?
    if (here.point.kind == Kind::kLink) {
      const auto& ids = lattice.tetrahedron_links[tetrahedron];
      return static_cast<bool>(context.link_split[std::find(ids.begin(), ids.end(), here.point.id) - ids.begin()]);
    }
    const auto& groups = context.face_groups[LocalIndex(lattice.tetrahedron_faces[tetrahedron], here.point.id)];
    const std::array<int, 3>& v = lattice.faces[here.point.id];
    return groups[IndexOf(v, here.side)] != groups[IndexOf(v, across.side)];
  };

  if (pieces.count == 2 && !middles && edge_count <= 4) {
    // One closed loop: turn all edges to the point of view of the first one's left piece and chain them.
    const int piece = piece_of(edges[0].from.side);
    for (int i = 0; i < edge_count; ++i)
      if (piece_of(edges[i].from.side) != piece) {
        std::swap(edges[i].from, edges[i].to_other);
        std::swap(edges[i].to, edges[i].from_other);
      }
    for (int i = 0; i + 1 < edge_count; ++i)
      for (int j = i + 1; j < edge_count; ++j)
        if (edges[j].from.point == edges[i].to.point) std::swap(edges[i + 1], edges[j]);
    auto emit = [&](int a, int b, int c) {
      triangles.push_back({edges[a].from, edges[b].from, edges[c].from});
      triangles.push_back({edges[c].from_other, edges[b].from_other, edges[a].from_other});
    };
    if (edge_count == 3) {
      emit(0, 1, 2);
      return CapShape::kTriangle;
    }
    std::array<Eigen::Vector3d, 4> x;
    std::array<bool, 4> own;
    bool has_face_point = false;
    for (int i = 0; i < 4; ++i) {
      x[i] = RestPosition(lattice, graph, edges[i].from.point);
      own[i] = has_own(edges[i].from, edges[i].from_other);
      has_face_point = has_face_point || edges[i].from.point.kind == Kind::kFace;
    }
    // No diagonal may carry more than its own two triangles on each lip: not one whose two ends are shared by both
    // lips, nor one along a face, where the next tetrahedron could draw the same.
    auto diagonal = [&](int i) {
      const bool face_point = edges[i].from.point.kind == Kind::kFace || edges[i + 2].from.point.kind == Kind::kFace;
      const bool along_face = has_face_point && !face_point;
      return along_face || !(own[i] || own[i + 2]) ? -1 : SmallestArea(x[i], x[i + 1], x[i + 2], x[(i + 3) % 4]);
    };
    const double area02 = diagonal(0), area13 = diagonal(1);
    if (area02 >= area13 && area02 >= 0) {
      emit(0, 1, 2);
      emit(0, 2, 3);
      return CapShape::kDiagonal02;
    }
    if (area13 >= 0) {
      emit(1, 2, 3);
      emit(1, 3, 0);
      return CapShape::kDiagonal13;
    }
  }

  const CutPoint centre{Kind::kCentre, tetrahedron};
  for (int i = 0; i < edge_count; ++i) {
    const CapEdge& e = edges[i];
    auto emit = [&](const Corner& from, const Corner& to, const Corner& from_other, const Corner& to_other) {
      triangles.push_back({Corner{centre, from.side}, from, to});
      triangles.push_back({Corner{centre, from_other.side}, to_other, from_other});
    };
    if (e.has_middle) {
      emit(e.from, e.middle, e.from_other, e.middle_other);
      emit(e.middle, e.to, e.middle_other, e.to_other);
    } else {
      emit(e.from, e.to, e.from_other, e.to_other);
    }
  }
  return CapShape::kFan;
}

Eigen::Vector3d RestPosition(const Lattice& lattice, const MaterialGraph& graph, const CutPoint& point) {
  switch (point.kind) {
    case Kind::kVertex:
      return lattice.vertices[point.id];
    case Kind::kLink:
      return graph.CutPoint(point.id);
    case Kind::kFace: {
      const std::array<int, 3>& l = lattice.face_links[point.id];
      return (graph.CutPoint(l[0]) + graph.CutPoint(l[1]) + graph.CutPoint(l[2])) / 3;
    }
    case Kind::kMiddle: {
      std::array<Segment, 3> segments;
      const int count =
          FaceSegments(lattice, graph, point.id, lattice.faces[point.id], lattice.face_links[point.id], segments);
      for (int i = 0; i < count; ++i)
        if (segments[i].key == point.segment)
          return (RestPosition(lattice, graph, segments[i].from.point) +
                  RestPosition(lattice, graph, segments[i].to.point)) /
                 2;
      return Eigen::Vector3d::Zero();  // unreachable: a middle point exists only on a segment
    }
    case Kind::kCentre:
      break;
  }
  const TetrahedronPieces& pieces = PiecesOf(graph.CutMask(point.id));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (int l = 0; l < 6; ++l)
    if (pieces.piece[kTetrahedronLinks[l][0]] != pieces.piece[kTetrahedronLinks[l][1]]) {
      sum += graph.CutPoint(lattice.tetrahedron_links[point.id][l]);
      ++count;
    }
  return sum / count;
}

}  // namespace meshless_cutting
