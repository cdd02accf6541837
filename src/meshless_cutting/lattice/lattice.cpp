#include "lattice/lattice.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace meshless_cutting {
namespace {

/// Link of a tetrahedron between two of its local vertices; the inverse of kTetrahedronLinks.
constexpr int kLinkOfPair[4][4] = {{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}};

/// A link or face of one tetrahedron, waiting in the bucket of its lowest vertex for its equals.
struct Entry {
  std::uint64_t others;  // the remaining vertices, ascending, 32 bits each
  int slot;              // tetrahedron * (entries per tetrahedron) + local index
  bool operator<(const Entry& q) const { return others != q.others ? others < q.others : slot < q.slot; }
};

/// Counting sort into one bucket per lowest vertex: linear, and the small buckets sort in cache.
/// `entry_of(tetrahedron, i)` gives lowest vertex and others.
template <int kPerTetrahedron, typename EntryOf>
std::vector<Entry> SortedEntries(int vertex_count, const std::vector<std::array<int, 4>>& tetrahedra,
                                 std::vector<int>* offsets, const EntryOf& entry_of) {
  offsets->assign(vertex_count + 1, 0);
  for (const auto& tetrahedron : tetrahedra) {
    for (int i = 0; i < kPerTetrahedron; ++i) ++(*offsets)[entry_of(tetrahedron, i).first + 1];
  }
  for (int v = 0; v < vertex_count; ++v) (*offsets)[v + 1] += (*offsets)[v];
  std::vector<int> next(offsets->begin(), offsets->end() - 1);
  std::vector<Entry> entries(tetrahedra.size() * kPerTetrahedron);
  int slot = 0;
  for (const auto& tetrahedron : tetrahedra) {
    for (int i = 0; i < kPerTetrahedron; ++i, ++slot) {
      const auto [lowest, others] = entry_of(tetrahedron, i);
      entries[next[lowest]++] = {others, slot};
    }
  }
  for (int v = 0; v < vertex_count; ++v) {
    std::sort(entries.begin() + (*offsets)[v], entries.begin() + (*offsets)[v + 1]);
  }
  return entries;
}

void BuildLinks(Lattice* lattice) {
  const int vertex_count = static_cast<int>(lattice->vertices.size());
  std::vector<int> offsets;
  const auto entries = SortedEntries<6>(vertex_count, lattice->tetrahedra, &offsets, [](const auto& t, int l) {
    const auto [first, second] = std::minmax(t[kTetrahedronLinks[l][0]], t[kTetrahedronLinks[l][1]]);
    return std::make_pair(first, static_cast<std::uint64_t>(second));
  });
  lattice->tetrahedron_links.resize(lattice->tetrahedra.size());
  lattice->link_tetrahedra.items.reserve(entries.size());
  for (int v = 0; v < vertex_count; ++v) {
    for (int e = offsets[v]; e < offsets[v + 1]; ++e) {
      if (e == offsets[v] || entries[e].others != entries[e - 1].others) {
        lattice->links.push_back({v, static_cast<int>(entries[e].others)});
        lattice->link_tetrahedra.offsets.push_back(e);
      }
      const int tetrahedron = entries[e].slot / 6;
      lattice->tetrahedron_links[tetrahedron][entries[e].slot % 6] = static_cast<int>(lattice->links.size()) - 1;
      lattice->link_tetrahedra.items.push_back(tetrahedron);
    }
  }
  lattice->link_tetrahedra.offsets.push_back(static_cast<int>(entries.size()));

  Incidence& vertex_links = lattice->vertex_links;
  vertex_links.offsets.assign(vertex_count + 1, 0);
  for (const auto& link : lattice->links) {
    for (const int v : link) ++vertex_links.offsets[v + 1];
  }
  for (int v = 0; v < vertex_count; ++v) vertex_links.offsets[v + 1] += vertex_links.offsets[v];
  std::vector<int> next(vertex_links.offsets.begin(), vertex_links.offsets.end() - 1);
  vertex_links.items.resize(2 * lattice->links.size());
  for (int l = 0; l < static_cast<int>(lattice->links.size()); ++l) {
    for (const int v : lattice->links[l]) vertex_links.items[next[v]++] = l;
  }
}

void BuildFaces(Lattice* lattice) {
  const int vertex_count = static_cast<int>(lattice->vertices.size());
  std::vector<int> offsets;
  const auto entries = SortedEntries<4>(vertex_count, lattice->tetrahedra, &offsets, [](const auto& t, int f) {
    const auto& local = kTetrahedronFaces[f];
    int a = t[local[0]];
    int b = t[local[1]];
    int c = t[local[2]];
    if (a > b) std::swap(a, b);
    if (b > c) std::swap(b, c);
    if (a > b) std::swap(a, b);
    return std::make_pair(a, static_cast<std::uint64_t>(b) << 32 | static_cast<std::uint64_t>(c));
  });
  // The slot of the same face in the other tetrahedron, -1 on the skin.
  std::vector<int> twin(entries.size(), -1);
  for (int v = 0; v < vertex_count; ++v) {
    for (int e = offsets[v]; e + 1 < offsets[v + 1]; ++e) {
      if (entries[e].others != entries[e + 1].others) continue;
      if (e + 2 < offsets[v + 1] && entries[e].others == entries[e + 2].others) {
        throw std::invalid_argument("BuildLattice: a face at vertex " + std::to_string(v) +
                                    " has more than two tetrahedra; the mesh must be conforming");
      }
      twin[entries[e].slot] = entries[e + 1].slot;
      twin[entries[e + 1].slot] = entries[e].slot;
      ++e;
    }
  }
  lattice->tetrahedron_faces.resize(lattice->tetrahedra.size());
  for (int slot = 0; slot < static_cast<int>(twin.size()); ++slot) {
    const int tetrahedron = slot / 4;
    if (twin[slot] >= 0 && twin[slot] < slot) continue;  // numbered from its first tetrahedron
    const int face = static_cast<int>(lattice->faces.size());
    const auto& local = kTetrahedronFaces[slot % 4];
    std::array<int, 3> vertices;
    std::array<int, 3> links;
    for (int i = 0; i < 3; ++i) {
      vertices[i] = lattice->tetrahedra[tetrahedron][local[i]];
      links[i] = lattice->tetrahedron_links[tetrahedron][kLinkOfPair[local[i]][local[(i + 1) % 3]]];
    }
    lattice->faces.push_back(vertices);
    lattice->face_links.push_back(links);
    lattice->face_tetrahedra.push_back({tetrahedron, twin[slot] < 0 ? -1 : twin[slot] / 4});
    lattice->tetrahedron_faces[tetrahedron][slot % 4] = face;
    if (twin[slot] >= 0) lattice->tetrahedron_faces[twin[slot] / 4][twin[slot] % 4] = face;
  }
}

}  // namespace

Lattice BuildLattice(std::vector<Eigen::Vector3d> vertices, std::vector<std::array<int, 4>> tetrahedra) {
  Lattice lattice;
  lattice.vertices = std::move(vertices);
  lattice.tetrahedra = std::move(tetrahedra);
  BuildLinks(&lattice);
  BuildFaces(&lattice);
  return lattice;
}

}  // namespace meshless_cutting
