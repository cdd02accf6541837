// Which vertices of a tetrahedron still hang together: its 4 vertices grouped by its uncut links.
#pragma once

#include <array>
#include <cstdint>

namespace meshless_cutting {

/// One of the 15 partitions of the four local vertices. Pieces are numbered in the order of their smallest vertex.
struct TetrahedronPieces {
  int count = 1;
  std::array<std::int8_t, 4> piece{};  // piece of each local vertex
};

/// The pieces for a pattern of cut links: bit l is set when link l of kTetrahedronLinks is cut (64 patterns, one
/// table).
const TetrahedronPieces& PiecesOf(unsigned cut_mask);

}  // namespace meshless_cutting
