// The one source of truth about cuts: lattice vertices are nodes, lattice edges are links, and a blade cuts links.
#pragma once

#include <cstdint>
#include <vector>

#include "lattice/lattice.h"

namespace meshless_cutting {

/// Where on which link the blade passed.
struct LinkCut {
  int link;
  double u;  // proportion along the link from its first vertex, [0, 1]
};

/// State of the links of a lattice. A link is cut at most once and keeps its proportion.
class MaterialGraph {
 public:
  explicit MaterialGraph(const Lattice& lattice);

  /// Cuts a link; false when it was cut before (its proportion stays).
  bool Cut(const LinkCut& cut);

  bool IsCut(int link) const { return proportion_[link] >= 0; }
  /// Bit l: link l of the tetrahedron (kTetrahedronLinks) is cut.
  unsigned CutMask(int tetrahedron) const { return mask_[tetrahedron]; }
  int cut_count() const { return cut_count_; }

  /// Rest position of the cut, m. Kept off the ends of the link so that no sliver is drawn; which vertex lies on which
  /// side does not depend on it.
  Eigen::Vector3d CutPoint(int link) const;

 private:
  const Lattice* lattice_;
  std::vector<double> proportion_;  // per link, as found; -1: not cut
  std::vector<std::uint8_t> mask_;  // per tetrahedron
  int cut_count_ = 0;
};

}  // namespace meshless_cutting
