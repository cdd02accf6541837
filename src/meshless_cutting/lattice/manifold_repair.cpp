#include "lattice/manifold_repair.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "lattice/lattice.h"

namespace meshless_cutting {
namespace {

using Tetrahedron = std::array<int, 4>;

bool Has(const Tetrahedron& t, int vertex) { return std::find(t.begin(), t.end(), vertex) != t.end(); }

/// Groups a few tetrahedra that share `common` vertices by the faces that contain all of these. Groups come in the
/// order of their first tetrahedron.
std::vector<std::vector<int>> FaceConnectedGroups(const std::vector<Tetrahedron>& tetrahedra,
                                                  const std::vector<int>& star, const std::vector<int>& common) {
  std::map<std::array<int, 3>, std::vector<int>> at_face;  // face -> positions in star
  for (int i = 0; i < static_cast<int>(star.size()); ++i) {
    for (const auto& local : kTetrahedronFaces) {
      std::array<int, 3> face;
      for (int k = 0; k < 3; ++k) face[k] = tetrahedra[star[i]][local[k]];
      std::sort(face.begin(), face.end());
      const bool contains = std::all_of(common.begin(), common.end(),
                                        [&](int v) { return std::find(face.begin(), face.end(), v) != face.end(); });
      if (contains) at_face[face].push_back(i);
    }
  }
  std::vector<int> root(star.size());
  for (int i = 0; i < static_cast<int>(star.size()); ++i) root[i] = i;
  const auto find = [&](int i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const auto& [face, sharing] : at_face) {
    if (sharing.size() != 2) continue;
    const int a = find(sharing[0]);
    const int b = find(sharing[1]);
    root[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::vector<int>> groups;
  std::vector<int> group_of(star.size(), -1);
  for (int i = 0; i < static_cast<int>(star.size()); ++i) {
    int& group = group_of[find(i)];
    if (group < 0) {
      group = static_cast<int>(groups.size());
      groups.emplace_back();
    }
    groups[group].push_back(star[i]);
  }
  return groups;
}

class Repairer {
 public:
  explicit Repairer(TetrahedronSoup* soup) : vertices_(soup->vertices), tetrahedra_(soup->tetrahedra) {}

  int Run() {
    const size_t before = tetrahedra_.size();
    size_t added = 0;
    // Each pass removes the defects that it finds; new ones can appear next to removed tetrahedra. Far more passes than
    // ever seen (7): beyond them, whatever touches a defect goes, which must end.
    constexpr int kPasses = 50;
    for (int pass = 0;; ++pass) {
      FindDefects();
      if (defects_.empty()) break;
      FindStars();
      if (pass >= kPasses) {
        Remove(AllStars());
      } else if (!SplitVertices()) {
        const size_t count = tetrahedra_.size();
        if (SplitEdges()) {
          added += tetrahedra_.size() - count;
        } else {
          Remove(PathsBetweenCavities());
        }
      }
    }
    DropUnusedVertices();
    return static_cast<int>(before + added - tetrahedra_.size());
  }

 private:
  /// Vertices at which the boundary is not one closed fan, and edges with more than two boundary triangles.
  void FindDefects() {
    const Lattice lattice = BuildLattice(vertices_, tetrahedra_);
    boundary_.clear();
    std::vector<std::vector<std::pair<int, int>>> spokes(vertices_.size());  // vertex -> (from, to) of its triangles
    for (size_t f = 0; f < lattice.faces.size(); ++f) {
      if (lattice.face_tetrahedra[f][1] >= 0) continue;
      const auto& face = lattice.faces[f];
      for (int k = 0; k < 3; ++k) spokes[face[k]].push_back({face[(k + 1) % 3], face[(k + 2) % 3]});
    }
    defects_.clear();
    defect_edges_.clear();
    for (int v = 0; v < static_cast<int>(vertices_.size()); ++v) {
      auto& fan = spokes[v];
      if (fan.empty()) continue;
      std::sort(fan.begin(), fan.end());
      bool shared_edge = false;
      for (size_t i = 1; i < fan.size(); ++i) {
        if (fan[i].first != fan[i - 1].first) continue;
        shared_edge = true;
        if (v < fan[i].first) defect_edges_.insert({v, fan[i].first});
      }
      size_t walked = 0;
      if (!shared_edge) {
        int at = fan[0].first;
        do {
          const auto next = std::lower_bound(fan.begin(), fan.end(), std::make_pair(at, -1));
          at = next->second;
          ++walked;
        } while (at != fan[0].first);
      }
      if (walked == fan.size()) continue;
      defects_.insert(v);
      boundary_[v] = fan;
    }
  }

  void FindStars() {
    stars_.clear();
    for (const int v : defects_) stars_[v];
    for (int i = 0; i < static_cast<int>(tetrahedra_.size()); ++i) {
      for (const int v : tetrahedra_[i]) {
        const auto star = stars_.find(v);
        if (star != stars_.end()) star->second.push_back(i);
      }
    }
  }

  bool SplitVertices() {
    bool changed = false;
    // Stars overlap, but a copy of one vertex does not change which faces another vertex' star shares ... except
    // through renaming: groups are found on current names, so each vertex sees what the earlier ones left.
    for (const auto& [v, star] : stars_) {
      const auto groups = FaceConnectedGroups(tetrahedra_, star, {v});
      for (size_t g = 1; g < groups.size(); ++g) {
        const int copy = static_cast<int>(vertices_.size());
        vertices_.push_back(Eigen::Vector3d(vertices_[v]));
        for (const int t : groups[g]) std::replace(tetrahedra_[t].begin(), tetrahedra_[t].end(), v, copy);
        changed = true;
      }
    }
    return changed;
  }

  bool SplitEdges() {
    std::set<int> touched;
    bool changed = false;
    for (const auto& [v, w] : defect_edges_) {
      std::vector<int> ring;
      for (const int t : stars_[v]) {
        if (Has(tetrahedra_[t], w)) ring.push_back(t);
      }
      const bool is_touched = std::any_of(ring.begin(), ring.end(), [&](int t) { return touched.count(t) > 0; });
      if (is_touched) continue;  // in the next pass
      const auto fans = FaceConnectedGroups(tetrahedra_, ring, {v, w});
      for (size_t g = 1; g < fans.size(); ++g) {
        const int middle = static_cast<int>(vertices_.size());
        vertices_.push_back(Eigen::Vector3d(0.5 * (vertices_[v] + vertices_[w])));
        for (const int t : fans[g]) {
          Tetrahedron half = tetrahedra_[t];
          std::replace(half.begin(), half.end(), v, middle);
          std::replace(tetrahedra_[t].begin(), tetrahedra_[t].end(), w, middle);
          tetrahedra_.push_back(half);
        }
        changed = true;
      }
      touched.insert(ring.begin(), ring.end());
    }
    return changed;
  }

  /// At each remaining defect the star is one group and its boundary several fans: the shortest face-connected path of
  /// tetrahedra from one fan to another.
  std::set<int> PathsBetweenCavities() {
    std::set<int> path;
    std::set<int> touched;
    for (const auto& [v, star] : stars_) {
      const bool is_touched = std::any_of(star.begin(), star.end(), [&](int t) { return touched.count(t) > 0; });
      if (is_touched) continue;
      touched.insert(star.begin(), star.end());
      for (const int t : PathAt(v, star)) path.insert(t);
    }
    return path;
  }

  /// Closed fans of boundary triangles about a defect, each as its rim in order; the vertex is on the left.
  std::vector<std::vector<int>> FansAt(int v) {
    const auto& spokes = boundary_[v];
    std::set<int> seen;
    std::vector<std::vector<int>> fans;
    for (const auto& start : spokes) {
      if (seen.count(start.first) > 0) continue;
      fans.emplace_back();
      for (int at = start.first; seen.insert(at).second;) {
        fans.back().push_back(at);
        at = std::lower_bound(spokes.begin(), spokes.end(), std::make_pair(at, -1))->second;
      }
    }
    return fans;
  }

  std::vector<int> PathAt(int v, const std::vector<int>& star) {
    std::map<std::pair<int, int>, int> label;  // boundary triangle of v -> its fan
    const auto fans = FansAt(v);
    for (size_t f = 0; f < fans.size(); ++f) {
      for (size_t k = 0; k < fans[f].size(); ++k) {
        label[{fans[f][k], fans[f][(k + 1) % fans[f].size()]}] = static_cast<int>(f);
      }
    }
    // Breadth first over tetrahedra, from those at fan 0 to the first at another fan.
    std::map<std::array<int, 3>, std::vector<int>> at_face;
    std::map<int, std::set<int>> fans_of;
    for (const int t : star) {
      for (const auto& local : kTetrahedronFaces) {
        std::array<int, 3> face;
        for (int k = 0; k < 3; ++k) face[k] = tetrahedra_[t][local[k]];
        for (int k = 0; k < 3; ++k) {
          if (face[k] != v) continue;
          const auto found = label.find({face[(k + 1) % 3], face[(k + 2) % 3]});
          if (found != label.end()) fans_of[t].insert(found->second);
        }
        std::sort(face.begin(), face.end());
        if (std::find(face.begin(), face.end(), v) != face.end()) at_face[face].push_back(t);
      }
    }
    std::map<int, int> previous;
    std::vector<int> queue;
    for (const int t : star) {
      if (fans_of[t].count(0) == 0) continue;
      previous[t] = -1;
      queue.push_back(t);
    }
    for (size_t i = 0; i < queue.size(); ++i) {
      const int t = queue[i];
      if (fans_of[t].size() > fans_of[t].count(0)) {
        std::vector<int> path;
        for (int at = t; at >= 0; at = previous[at]) path.push_back(at);
        return path;
      }
      for (const auto& [face, sharing] : at_face) {
        if (std::find(sharing.begin(), sharing.end(), t) == sharing.end()) continue;
        for (const int next : sharing) {
          if (previous.emplace(next, t).second) queue.push_back(next);
        }
      }
    }
    return star;
  }

  std::set<int> AllStars() const {
    std::set<int> all;
    for (const auto& entry : stars_) all.insert(entry.second.begin(), entry.second.end());
    return all;
  }

  void Remove(const std::set<int>& removed) {
    size_t kept = 0;
    for (size_t i = 0; i < tetrahedra_.size(); ++i) {
      if (removed.count(static_cast<int>(i)) == 0) tetrahedra_[kept++] = tetrahedra_[i];
    }
    tetrahedra_.resize(kept);
  }

  void DropUnusedVertices() {
    std::vector<int> index(vertices_.size(), -1);
    for (const Tetrahedron& t : tetrahedra_) {
      for (const int v : t) index[v] = 0;
    }
    int kept = 0;
    for (size_t v = 0; v < vertices_.size(); ++v) {
      if (index[v] < 0) continue;
      vertices_[kept] = vertices_[v];
      index[v] = kept++;
    }
    vertices_.resize(kept);
    for (Tetrahedron& t : tetrahedra_) {
      for (int& v : t) v = index[v];
    }
  }

  std::vector<Eigen::Vector3d>& vertices_;
  std::vector<Tetrahedron>& tetrahedra_;
  std::set<int> defects_;
  std::set<std::pair<int, int>> defect_edges_;
  std::map<int, std::vector<std::pair<int, int>>> boundary_;  // defect -> its boundary triangles, sorted
  std::map<int, std::vector<int>> stars_;                     // defect -> its tetrahedra
};

}  // namespace

int RepairManifold(TetrahedronSoup* soup) { return Repairer(soup).Run(); }

}  // namespace meshless_cutting
