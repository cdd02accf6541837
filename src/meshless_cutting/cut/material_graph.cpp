#include "cut/material_graph.h"

#include <algorithm>

namespace meshless_cutting {

// Share of a link that a drawn cut keeps from its ends. Larger: rounder triangles, but cuts drawn further from where
// the blade went (at most this share of a lattice edge).
constexpr double kEndMargin = 0.05;

MaterialGraph::MaterialGraph(const Lattice& lattice)
    : lattice_(&lattice), proportion_(lattice.links.size(), -1.0), mask_(lattice.tetrahedra.size(), 0) {}

bool MaterialGraph::Cut(const LinkCut& cut) {
  if (IsCut(cut.link)) return false;
  proportion_[cut.link] = std::clamp(cut.u, 0.0, 1.0);
  ++cut_count_;
  for (const int* t = lattice_->link_tetrahedra.begin(cut.link); t != lattice_->link_tetrahedra.end(cut.link); ++t)
    for (unsigned l = 0; l < 6; ++l)
      if (lattice_->tetrahedron_links[*t][l] == cut.link) mask_[*t] = static_cast<std::uint8_t>(mask_[*t] | 1u << l);
  return true;
}

Eigen::Vector3d MaterialGraph::CutPoint(int link) const {
  const double u = std::clamp(proportion_[link], kEndMargin, 1 - kEndMargin);
  const auto& [a, b] = lattice_->links[link];
  return (1 - u) * lattice_->vertices[a] + u * lattice_->vertices[b];
}

}  // namespace meshless_cutting
