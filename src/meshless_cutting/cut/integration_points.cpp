#include "cut/integration_points.h"

#include <algorithm>
#include <map>

namespace meshless_cutting {
namespace {

void SortUnique(std::vector<int>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

void InsertSorted(std::vector<int>& values, int value) {
  const auto at = std::lower_bound(values.begin(), values.end(), value);
  if (at == values.end() || *at != value) values.insert(at, value);
}

void EraseSorted(std::vector<int>& values, int value) {
  const auto at = std::lower_bound(values.begin(), values.end(), value);
  if (at != values.end() && *at == value) values.erase(at);
}

}  // namespace

IntegrationPoints::IntegrationPoints(const Lattice& lattice, const MaterialGraph& graph, const BackgroundGrid& grid)
    : lattice_(&lattice),
      graph_(&graph),
      grid_(&grid),
      cells_(grid.cell_count()),
      vertex_points_(lattice.vertices.size()),
      root_(lattice.vertices.size(), -1) {
  std::vector<CellVolume> parts;
  for (size_t t = 0; t < lattice.tetrahedra.size(); ++t) {
    parts.clear();
    const std::array<int, 4>& v = lattice.tetrahedra[t];
    AddCellVolumes(grid, {lattice.vertices[v[0]], lattice.vertices[v[1]], lattice.vertices[v[2]], lattice.vertices[v[3]]},
                   parts);
    MergeSlivers(grid, parts);
    AddChips(static_cast<int>(t), v[0], parts);
  }
  for (int cell = 0; cell < grid.cell_count(); ++cell) Regroup(cell);
  for (IntegrationPoint& point : points_) point.parent = -1;
  neighbours_.resize(points_.size());
  std::vector<int> all(points_.size());
  for (size_t p = 0; p < all.size(); ++p) all[p] = static_cast<int>(p);
  Relink(all);
}

void IntegrationPoints::AddChips(int tetrahedron, int anchor, const std::vector<CellVolume>& parts) {
  for (const CellVolume& part : parts) cells_[part.cell].chips.push_back({tetrahedron, anchor, part.volume, part.moment});
}

void IntegrationPoints::Regroup(int cell_index) {
  Cell& cell = cells_[cell_index];
  if (cell.chips.empty()) return;
  // Union of the lattice vertices of each piece that has material here.
  std::vector<int> vertices;
  auto find = [&](int v) {
    while (root_[v] != v) v = root_[v] = root_[root_[v]];
    return v;
  };
  auto add = [&](int v) {
    if (root_[v] >= 0) return;
    root_[v] = v;
    vertices.push_back(v);
  };
  for (const Chip& chip : cell.chips) {
    const std::array<int, 4>& t = lattice_->tetrahedra[chip.tetrahedron];
    const TetrahedronPieces& pieces = PiecesOf(graph_->CutMask(chip.tetrahedron));
    const int piece = pieces.piece[std::find(t.begin(), t.end(), chip.anchor) - t.begin()];
    add(chip.anchor);
    for (int i = 0; i < 4; ++i) {
      if (pieces.piece[i] != piece) continue;
      add(t[i]);
      const int a = find(chip.anchor), b = find(t[i]);
      root_[std::max(a, b)] = std::min(a, b);
    }
  }
  std::sort(vertices.begin(), vertices.end());

  std::map<int, IntegrationPoint> groups;  // by root, so in the order of their lowest vertex
  for (int v : vertices) groups[find(v)].vertices.push_back(v);
  for (const Chip& chip : cell.chips) {
    IntegrationPoint& group = groups[find(chip.anchor)];
    group.volume += chip.volume;
    group.centroid += chip.moment;
  }
  for (auto& [root, group] : groups) {
    group.cell = cell_index;
    group.centroid /= group.volume;
    for (int p : cell.points)
      if (std::binary_search(points_[p].vertices.begin(), points_[p].vertices.end(), root)) group.parent = p;
  }
  for (int v : vertices) root_[v] = -1;

  // Largest parts inherit the indices.
  std::map<int, IntegrationPoint*> heirs;
  for (auto& [root, group] : groups)
    if (group.parent >= 0) {
      IntegrationPoint*& heir = heirs[group.parent];
      if (!heir || group.volume > heir->volume) heir = &group;
    }
  for (int p : cell.points) {
    for (int v : points_[p].vertices) EraseSorted(vertex_points_[v], p);
    changed_.push_back(p);
  }
  for (auto& [root, group] : groups) {
    int index = static_cast<int>(points_.size());
    if (group.parent >= 0 && heirs[group.parent] == &group) {
      index = group.parent;
      points_[index] = group;
    } else {
      points_.push_back(group);
      cell.points.push_back(index);
      changed_.push_back(index);
    }
    for (int v : points_[index].vertices) InsertSorted(vertex_points_[v], index);
  }
}

void IntegrationPoints::Relink(const std::vector<int>& points) {
  for (int p : points) {
    for (int q : neighbours_[p]) EraseSorted(neighbours_[q], p);
    neighbours_[p].clear();
  }
  for (int p : points) {
    std::vector<int> neighbours;
    for (int v : points_[p].vertices)
      neighbours.insert(neighbours.end(), vertex_points_[v].begin(), vertex_points_[v].end());
    SortUnique(neighbours);
    EraseSorted(neighbours, p);
    for (int q : neighbours) InsertSorted(neighbours_[q], p);
    neighbours_[p] = std::move(neighbours);
  }
}

const std::vector<int>& IntegrationPoints::Update(const CutSurface& surface, const std::vector<int>& tetrahedra) {
  changed_.clear();
  // Cells that the tetrahedra have chips in: within their bounding boxes.
  std::vector<int> cells;
  for (int t : tetrahedra) {
    Eigen::Vector3d low = lattice_->vertices[lattice_->tetrahedra[t][0]], high = low;
    for (int v : lattice_->tetrahedra[t]) {
      low = low.cwiseMin(lattice_->vertices[v]);
      high = high.cwiseMax(lattice_->vertices[v]);
    }
    const Eigen::Vector3d slack = 1e-6 * grid_->spacing();
    const Eigen::Vector3i from = grid_->CellCoordinates(grid_->CellAt(low - slack));
    const Eigen::Vector3i to = grid_->CellCoordinates(grid_->CellAt(high + slack));
    for (int k = from[2]; k <= to[2]; ++k)
      for (int j = from[1]; j <= to[1]; ++j)
        for (int i = from[0]; i <= to[0]; ++i) cells.push_back(grid_->CellIndex({i, j, k}));
  }
  SortUnique(cells);
  auto is_changed = [&](const Chip& chip) { return std::binary_search(tetrahedra.begin(), tetrahedra.end(), chip.tetrahedron); };
  cells.erase(std::remove_if(cells.begin(), cells.end(),
                             [&](int cell) {
                               std::vector<Chip>& chips = cells_[cell].chips;
                               const auto end = std::remove_if(chips.begin(), chips.end(), is_changed);
                               const bool untouched = end == chips.end();
                               chips.erase(end, chips.end());
                               return untouched;
                             }),
              cells.end());

  std::vector<CornerTriangle> triangles;
  std::vector<CellVolume> parts;
  for (int t : tetrahedra) {
    const std::array<int, 4>& v = lattice_->tetrahedra[t];
    const TetrahedronPieces& pieces = PiecesOf(graph_->CutMask(t));
    if (pieces.count > 1) surface.PieceTriangles(t, triangles);
    for (int piece = 0; piece < pieces.count; ++piece) {
      const auto first = std::find(pieces.piece.begin(), pieces.piece.end(), piece) - pieces.piece.begin();
      const Eigen::Vector3d& apex = lattice_->vertices[v[first]];
      parts.clear();
      if (pieces.count == 1) {
        AddCellVolumes(*grid_, {apex, lattice_->vertices[v[1]], lattice_->vertices[v[2]], lattice_->vertices[v[3]]}, parts);
      } else {
        for (const CornerTriangle& c : triangles) {
          if (pieces.piece[std::find(v.begin(), v.end(), c[0].side) - v.begin()] != piece) continue;
          const Eigen::Vector3d a = RestPosition(*lattice_, *graph_, c[0].point);
          const Eigen::Vector3d b = RestPosition(*lattice_, *graph_, c[1].point);
          const Eigen::Vector3d d = RestPosition(*lattice_, *graph_, c[2].point);
          if (a == apex || b == apex || d == apex) continue;
          AddCellVolumes(*grid_, {apex, a, b, d}, parts);
        }
      }
      MergeSlivers(*grid_, parts);
      AddChips(t, v[first], parts);
    }
  }
  for (int cell : cells) Regroup(cell);
  SortUnique(changed_);
  neighbours_.resize(points_.size());
  Relink(changed_);
  return changed_;
}

}  // namespace meshless_cutting
