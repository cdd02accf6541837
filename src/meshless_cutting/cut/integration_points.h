// Integration points: in each cell of the background grid, one per connected group of tetrahedron pieces.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cut/cell_volumes.h"
#include "cut/cut_surface.h"
#include "cut/material_graph.h"
#include "tissue/background_grid.h"

namespace meshless_cutting {

/// The material of one point. A cut shares volume among its parts in proportion to what is drawn of them, so mass,
/// momentum and angular momentum are kept to rounding.
struct IntegrationPoint {
  int cell = -1;
  double volume = 0;                                   // m^3, at rest
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // m, object frame
  std::vector<int> vertices;  // lattice vertices of its pieces, sorted; some may lie outside the cell
  int parent = -1;            // the point it was split from in the last Update(), or itself
};

/// Groups are read from the graph. They only ever split: the largest part keeps the index, others get new ones at the
/// end.
class IntegrationPoints {
 public:
  IntegrationPoints(const Lattice& lattice, const MaterialGraph& graph, const BackgroundGrid& grid);

  /// Call after a cut with the tetrahedra whose pieces changed. Returns the points that changed or are new, sorted.
  const std::vector<int>& Update(const CutSurface& surface, const std::vector<int>& tetrahedra);

  const std::vector<IntegrationPoint>& points() const { return points_; }
  /// Points in a cell.
  const std::vector<int>& InCell(int cell) const { return cells_[cell].points; }
  /// Points that a lattice vertex belongs to: those in the cells that its pieces reach into. Sorted.
  const std::vector<int>& OfVertex(int vertex) const { return vertex_points_[vertex]; }
  /// Points joined to p by common material: they share a lattice vertex. Sorted, without p.
  const std::vector<int>& Neighbours(int p) const { return neighbours_[p]; }

 private:
  /// What a piece of a tetrahedron has in a cell. A chip is made at load and only ever split, as its piece is: what a
  /// later cut redraws between pieces that were apart before moves no mass between them.
  struct Chip {
    int tetrahedron;
    std::uint8_t piece;      // bit i: vertex i of the tetrahedron belongs to the piece
    double volume;           // m^3
    Eigen::Vector3d moment;  // volume times centroid, m^4
  };
  struct Cell {
    std::vector<Chip> chips;
    std::vector<int> points;
  };
  int AnchorOf(const Chip& chip) const;  // its first lattice vertex
  /// What is drawn of each piece of a tetrahedron, by cell.
  void ClipPieces(const CutSurface& surface, int tetrahedron, std::array<std::vector<CellVolume>, 4>& parts) const;
  /// Shares a chip among the pieces that its piece fell into, in proportion to what is drawn of them.
  void SplitChip(int cell, const Chip& chip, const std::array<std::vector<CellVolume>, 4>& parts);
  void Regroup(int cell);
  void Relink(const std::vector<int>& points);

  const Lattice* lattice_;
  const MaterialGraph* graph_;
  const BackgroundGrid* grid_;
  std::vector<Cell> cells_;
  Incidence
      tetrahedron_cells_;  // cells that each tetrahedron has material in; fixed at load, so groups only ever split
  std::vector<IntegrationPoint> points_;
  std::vector<std::vector<int>> vertex_points_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<int> changed_;
  // Scratch, the same between calls where a value is named.
  std::vector<int> root_;                 // of Regroup: per lattice vertex, -1
  std::vector<int> vertices_;             // of Regroup
  std::vector<int> group_;                // of Regroup: per lattice vertex that is a root
  std::vector<int> seen_by_;              // of Relink: per point, -1
  std::vector<std::uint8_t> is_clipped_;  // of Update: per tetrahedron, 0
};

}  // namespace meshless_cutting
