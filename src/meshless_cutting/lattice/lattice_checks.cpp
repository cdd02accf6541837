#include "lattice/lattice_checks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace meshless_cutting {
namespace {

std::string At(const std::string& what, size_t index) { return what + " " + std::to_string(index); }

std::string CheckTetrahedra(const Lattice& lattice) {
  std::vector<char> used(lattice.vertices.size(), 0);
  for (size_t i = 0; i < lattice.tetrahedra.size(); ++i) {
    const auto& t = lattice.tetrahedra[i];
    for (const int v : t) {
      if (v < 0 || v >= static_cast<int>(lattice.vertices.size())) return At("vertex out of range in tetrahedron", i);
      used[v] = 1;
    }
    const Eigen::Vector3d& a = lattice.vertices[t[0]];
    const double six_volumes =
        (lattice.vertices[t[1]] - a).cross(lattice.vertices[t[2]] - a).dot(lattice.vertices[t[3]] - a);
    if (!(six_volumes > 0)) return At("volume not positive in tetrahedron", i);
  }
  const auto unused = std::find(used.begin(), used.end(), 0);
  return unused == used.end() ? "" : At("no tetrahedron at vertex", unused - used.begin());
}

std::string CheckLinks(const Lattice& lattice) {
  if (!std::is_sorted(lattice.links.begin(), lattice.links.end())) return "links are not sorted";
  if (std::adjacent_find(lattice.links.begin(), lattice.links.end()) != lattice.links.end()) return "a link is doubled";
  std::vector<std::vector<int>> around(lattice.links.size());
  if (lattice.tetrahedron_links.size() != lattice.tetrahedra.size()) return "tetrahedron_links has the wrong size";
  for (size_t i = 0; i < lattice.tetrahedra.size(); ++i) {
    for (int l = 0; l < 6; ++l) {
      const int link = lattice.tetrahedron_links[i][l];
      if (link < 0 || link >= static_cast<int>(lattice.links.size())) return At("link out of range in tetrahedron", i);
      std::array<int, 2> ends = {lattice.tetrahedra[i][kTetrahedronLinks[l][0]],
                                 lattice.tetrahedra[i][kTetrahedronLinks[l][1]]};
      std::sort(ends.begin(), ends.end());
      if (lattice.links[link] != ends) return At("wrong link in tetrahedron", i);
      around[link].push_back(static_cast<int>(i));
    }
  }
  if (lattice.link_tetrahedra.offsets.size() != lattice.links.size() + 1) return "link_tetrahedra has the wrong size";
  for (int l = 0; l < static_cast<int>(lattice.links.size()); ++l) {
    std::vector<int> row(lattice.link_tetrahedra.begin(l), lattice.link_tetrahedra.end(l));
    std::sort(row.begin(), row.end());
    if (row.empty() || row != around[l]) return At("wrong tetrahedra around link", l);
  }
  std::vector<std::vector<int>> at_vertex(lattice.vertices.size());
  for (int l = 0; l < static_cast<int>(lattice.links.size()); ++l) {
    if (lattice.links[l][0] >= lattice.links[l][1]) return At("first >= second in link", l);
    for (const int v : lattice.links[l]) at_vertex[v].push_back(l);
  }
  if (lattice.vertex_links.offsets.size() != lattice.vertices.size() + 1) return "vertex_links has the wrong size";
  for (int v = 0; v < static_cast<int>(lattice.vertices.size()); ++v) {
    std::vector<int> row(lattice.vertex_links.begin(v), lattice.vertex_links.end(v));
    std::sort(row.begin(), row.end());
    if (row != at_vertex[v]) return At("wrong links at vertex", v);
  }
  return "";
}

std::string CheckFaces(const Lattice& lattice) {
  const size_t count = lattice.faces.size();
  if (lattice.face_links.size() != count || lattice.face_tetrahedra.size() != count)
    return "face arrays differ in size";
  if (lattice.tetrahedron_faces.size() != lattice.tetrahedra.size()) return "tetrahedron_faces has the wrong size";
  std::set<std::array<int, 3>> seen;
  std::vector<int> uses(count, 0);
  for (size_t f = 0; f < count; ++f) {
    std::array<int, 3> sorted = lattice.faces[f];
    std::sort(sorted.begin(), sorted.end());
    if (!seen.insert(sorted).second) return At("doubled face", f);
    for (int k = 0; k < 3; ++k) {
      const auto ends = std::minmax(lattice.faces[f][k], lattice.faces[f][(k + 1) % 3]);
      const auto& link = lattice.links[lattice.face_links[f][k]];
      if (link[0] != ends.first || link[1] != ends.second) return At("wrong link of face", f);
    }
  }
  for (size_t i = 0; i < lattice.tetrahedra.size(); ++i) {
    for (int k = 0; k < 4; ++k) {
      const int f = lattice.tetrahedron_faces[i][k];
      if (f < 0 || f >= static_cast<int>(count)) return At("face out of range in tetrahedron", i);
      ++uses[f];
      std::array<int, 3> outward;
      for (int c = 0; c < 3; ++c) outward[c] = lattice.tetrahedra[i][kTetrahedronFaces[k][c]];
      const bool is_first = lattice.face_tetrahedra[f][0] == static_cast<int>(i);
      if (!is_first) {
        if (lattice.face_tetrahedra[f][1] != static_cast<int>(i)) return At("face does not know tetrahedron", i);
        std::swap(outward[1], outward[2]);  // seen from the other side
      }
      const auto& face = lattice.faces[f];
      std::rotate(outward.begin(), std::find(outward.begin(), outward.end(), face[0]), outward.end());
      if (outward != face) return At("wrong vertices or orientation of face", f);
    }
  }
  for (size_t f = 0; f < count; ++f) {
    if (uses[f] != (lattice.face_tetrahedra[f][1] < 0 ? 1 : 2)) return At("wrong number of tetrahedra at face", f);
  }
  return "";
}

std::string CheckSkin(const Lattice& lattice) {
  std::map<std::pair<int, int>, int> next;  // (vertex, from) -> to, about each skin vertex
  std::map<int, std::pair<int, int>> fan;   // vertex -> some neighbour, number of skin triangles
  for (size_t f = 0; f < lattice.faces.size(); ++f) {
    if (lattice.face_tetrahedra[f][1] >= 0) continue;
    for (int k = 0; k < 3; ++k) {
      const auto& face = lattice.faces[f];
      if (!next.insert({{face[k], face[(k + 1) % 3]}, face[(k + 2) % 3]}).second) {
        return "the skin is not edge-manifold at link " + std::to_string(face[k]) + " " +
               std::to_string(face[(k + 1) % 3]);
      }
      auto& [some, triangles] = fan[face[k]];
      some = face[(k + 1) % 3];
      ++triangles;
    }
  }
  if (fan.empty()) return "there is no skin";
  for (const auto& [v, entry] : fan) {
    int walked = 0;
    int at = entry.first;
    do {
      const auto step = next.find({v, at});
      if (step == next.end()) return At("the skin is open at vertex", v);
      at = step->second;
      ++walked;
    } while (at != entry.first && walked <= entry.second);
    if (walked != entry.second) return At("the skin is not vertex-manifold at vertex", v);
  }
  return "";
}

}  // namespace

std::string CheckLattice(const Lattice& lattice) {
  if (lattice.tetrahedra.empty()) return "there is no tetrahedron";
  for (const auto check : {CheckTetrahedra, CheckLinks, CheckFaces, CheckSkin}) {
    std::string problem = check(lattice);
    if (!problem.empty()) return problem;
  }
  return "";
}

}  // namespace meshless_cutting
