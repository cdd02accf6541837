#include "cut/integration_points.h"

#include <algorithm>
#include <utility>

namespace meshless_cutting {
namespace {

constexpr std::uint8_t kAllVertices = 0xf;

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
      root_(lattice.vertices.size(), -1),
      group_(lattice.vertices.size()),
      is_clipped_(lattice.tetrahedra.size(), 0) {
  const double sliver = kSliverShare * grid.spacing().prod();
  std::vector<CellVolume> parts;
  tetrahedron_cells_.offsets.push_back(0);
  for (size_t t = 0; t < lattice.tetrahedra.size(); ++t) {
    parts.clear();
    const std::array<int, 4>& v = lattice.tetrahedra[t];
    AddCellVolumes(
        grid, {lattice.vertices[v[0]], lattice.vertices[v[1]], lattice.vertices[v[2]], lattice.vertices[v[3]]}, parts);
    MergeParts(parts, [&](const CellVolume& part) { return part.volume < sliver; });
    for (const CellVolume& part : parts) {
      cells_[part.cell].chips.push_back({static_cast<int>(t), kAllVertices, part.volume, part.moment});
      tetrahedron_cells_.items.push_back(part.cell);
    }
    tetrahedron_cells_.offsets.push_back(static_cast<int>(tetrahedron_cells_.items.size()));
  }
  for (int cell = 0; cell < grid.cell_count(); ++cell) Regroup(cell);
  for (IntegrationPoint& point : points_) point.parent = -1;
  neighbours_.resize(points_.size());
  std::vector<int> all(points_.size());
  for (size_t p = 0; p < all.size(); ++p) all[p] = static_cast<int>(p);
  Relink(all);
}

int IntegrationPoints::AnchorOf(const Chip& chip) const {
  int i = 0;
  while (!(chip.piece >> i & 1u)) ++i;
  return lattice_->tetrahedra[chip.tetrahedron][i];
}

void IntegrationPoints::Regroup(int cell_index) {
  Cell& cell = cells_[cell_index];
  if (cell.chips.empty()) return;
  // Union of the lattice vertices of each piece that has material here.
  std::vector<int>& vertices = vertices_;
  vertices.clear();
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
    const int anchor = AnchorOf(chip);
    add(anchor);
    for (int i = 0; i < 4; ++i) {
      if (!(chip.piece >> i & 1u)) continue;
      const int v = lattice_->tetrahedra[chip.tetrahedron][i];
      add(v);
      const int a = find(anchor), b = find(v);
      root_[std::max(a, b)] = std::min(a, b);
    }
  }
  std::sort(vertices.begin(), vertices.end());

  std::vector<IntegrationPoint> groups;  // in the order of their lowest vertex, which is the root
  for (int v : vertices) {
    const int root = find(v);
    if (root == v) {
      group_[v] = static_cast<int>(groups.size());
      groups.emplace_back();
    }
    groups[group_[root]].vertices.push_back(v);
  }
  for (const Chip& chip : cell.chips) {
    IntegrationPoint& group = groups[group_[find(AnchorOf(chip))]];
    group.volume += chip.volume;
    group.centroid += chip.moment;
  }
  for (int v : vertices) root_[v] = -1;
  for (IntegrationPoint& group : groups) {
    group.cell = cell_index;
    group.centroid /= group.volume;
    for (int p : cell.points) {
      const std::vector<int>& whole = points_[p].vertices;
      if (std::binary_search(whole.begin(), whole.end(), group.vertices.front())) group.parent = p;
    }
  }

  for (int p : cell.points) {
    for (int v : points_[p].vertices) EraseSorted(vertex_points_[v], p);
    changed_.push_back(p);
  }
  // The largest part of a point inherits its index.
  std::vector<int> index(groups.size(), -1);
  for (int p : cell.points) {
    int heir = -1;
    for (int g = 0; g < static_cast<int>(groups.size()); ++g)
      if (groups[g].parent == p && (heir < 0 || groups[g].volume > groups[heir].volume)) heir = g;
    if (heir >= 0) index[heir] = p;
  }
  for (size_t g = 0; g < groups.size(); ++g) {
    int& p = index[g];
    if (p < 0) {
      p = static_cast<int>(points_.size());
      points_.emplace_back();
      cell.points.push_back(p);
      changed_.push_back(p);
    }
    points_[p] = std::move(groups[g]);
    for (int v : points_[p].vertices) InsertSorted(vertex_points_[v], p);
  }
}

void IntegrationPoints::Relink(const std::vector<int>& points) {
  for (int p : points) {
    for (int q : neighbours_[p]) EraseSorted(neighbours_[q], p);
    neighbours_[p].clear();
  }
  seen_by_.resize(points_.size(), -1);
  for (int p : points) {
    std::vector<int> neighbours;
    seen_by_[p] = p;
    for (int v : points_[p].vertices)
      for (int q : vertex_points_[v])
        if (std::exchange(seen_by_[q], p) != p) neighbours.push_back(q);
    std::sort(neighbours.begin(), neighbours.end());
    for (int q : neighbours) InsertSorted(neighbours_[q], p);
    neighbours_[p] = std::move(neighbours);
  }
  for (int p : points) {
    seen_by_[p] = -1;
    for (int q : neighbours_[p]) seen_by_[q] = -1;
  }
}

void IntegrationPoints::ClipPieces(const CutSurface& surface, int tetrahedron,
                                   std::array<std::vector<CellVolume>, 4>& parts) const {
  const std::array<int, 4>& v = lattice_->tetrahedra[tetrahedron];
  const TetrahedronPieces& pieces = PiecesOf(graph_->CutMask(tetrahedron));
  for (auto& p : parts) p.clear();
  auto apex = [&](int piece) -> const Eigen::Vector3d& {
    return lattice_->vertices[v[std::find(pieces.piece.begin(), pieces.piece.end(), piece) - pieces.piece.begin()]];
  };
  if (pieces.count == 1) {
    AddCellVolumes(*grid_, {apex(0), lattice_->vertices[v[1]], lattice_->vertices[v[2]], lattice_->vertices[v[3]]},
                   parts[0]);
  } else {
    // Each piece as signed tetrahedra between one of its vertices and its closed boundary.
    std::vector<CornerTriangle> triangles;
    surface.PieceTriangles(tetrahedron, triangles);
    for (const CornerTriangle& c : triangles) {
      const int piece = pieces.piece[std::find(v.begin(), v.end(), c[0].side) - v.begin()];
      std::array<Eigen::Vector3d, 4> x = {apex(piece)};
      for (int i = 0; i < 3; ++i) x[i + 1] = RestPosition(*lattice_, *graph_, c[i].point);
      if (x[1] != x[0] && x[2] != x[0] && x[3] != x[0]) AddCellVolumes(*grid_, x, parts[piece]);
    }
  }
}

void IntegrationPoints::SplitChip(int cell, const Chip& chip, const std::array<std::vector<CellVolume>, 4>& parts) {
  const TetrahedronPieces& pieces = PiecesOf(graph_->CutMask(chip.tetrahedron));
  // What is drawn in this cell of each piece that the chip's piece fell into.
  struct Child {
    std::uint8_t piece = 0;
    double volume = 0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  };
  std::array<Child, 4> children;
  for (int i = 0; i < 4; ++i)
    if (chip.piece >> i & 1u) children[pieces.piece[i]].piece |= static_cast<std::uint8_t>(1u << i);
  int largest = -1;
  for (int k = 0; k < 4; ++k) {
    if (children[k].piece == 0) continue;
    for (const CellVolume& part : parts[k])
      if (part.cell == cell) {
        children[k].volume = part.volume;
        children[k].moment = part.moment;
      }
    if (largest < 0 || children[k].volume > children[largest].volume) largest = k;
  }
  // The largest always keeps some; slivers go to it.
  const double sliver = kSliverShare * grid_->spacing().prod();
  double drawn = 0;
  for (Child& child : children) {
    if (&child != &children[largest] && child.volume < sliver) child.piece = 0;
    if (child.piece != 0) drawn += child.volume;
  }
  for (const Child& child : children) {
    if (child.piece == 0) continue;
    Chip part = chip;
    part.piece = child.piece;
    if (drawn >= sliver) {
      part.volume = chip.volume * (child.volume / drawn);
      part.moment = child.moment * (part.volume / child.volume);
    }
    cells_[cell].chips.push_back(part);
  }
}

const std::vector<int>& IntegrationPoints::Update(const CutSurface& surface, const std::vector<int>& tetrahedra) {
  changed_.clear();
  std::vector<int> cells;
  for (int t : tetrahedra) {
    cells.insert(cells.end(), tetrahedron_cells_.begin(t), tetrahedron_cells_.end(t));
    is_clipped_[t] = 1;
  }
  SortUnique(cells);
  std::vector<std::pair<int, Chip>> clipped;  // with their cells
  for (int cell : cells) {
    std::vector<Chip>& chips = cells_[cell].chips;
    const auto kept = std::stable_partition(chips.begin(), chips.end(),
                                            [&](const Chip& chip) { return !is_clipped_[chip.tetrahedron]; });
    for (auto chip = kept; chip != chips.end(); ++chip) clipped.emplace_back(cell, *chip);
    chips.erase(kept, chips.end());
  }
  std::stable_sort(clipped.begin(), clipped.end(),
                   [](const auto& a, const auto& b) { return a.second.tetrahedron < b.second.tetrahedron; });
  std::array<std::vector<CellVolume>, 4> parts;
  int drawn = -1;  // tetrahedron that `parts` are of
  for (const auto& [cell, chip] : clipped) {
    if (std::exchange(drawn, chip.tetrahedron) != chip.tetrahedron) ClipPieces(surface, chip.tetrahedron, parts);
    SplitChip(cell, chip, parts);
  }
  for (int t : tetrahedra) is_clipped_[t] = 0;
  for (int cell : cells) Regroup(cell);
  SortUnique(changed_);
  neighbours_.resize(points_.size());
  Relink(changed_);
  return changed_;
}

}  // namespace meshless_cutting
