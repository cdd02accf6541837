#include "cut/tetrahedron_pieces.h"

#include "lattice/lattice.h"

namespace meshless_cutting {
namespace {

std::array<TetrahedronPieces, 64> MakeTable() {
  std::array<TetrahedronPieces, 64> table;
  for (unsigned mask = 0; mask < 64; ++mask) {
    std::array<int, 4> root = {0, 1, 2, 3};  // smallest vertex reached so far; three rounds reach all of four vertices
    for (int round = 0; round < 3; ++round)
      for (unsigned l = 0; l < 6; ++l)
        if (!(mask >> l & 1u)) {
          int& a = root[kTetrahedronLinks[l][0]];
          int& b = root[kTetrahedronLinks[l][1]];
          a = b = a < b ? a : b;
        }
    TetrahedronPieces& pieces = table[mask];
    pieces.count = 0;
    for (int v = 0; v < 4; ++v)
      pieces.piece[v] = root[v] == v ? static_cast<std::int8_t>(pieces.count++) : pieces.piece[root[v]];
  }
  return table;
}

}  // namespace

const TetrahedronPieces& PiecesOf(unsigned cut_mask) {
  static const std::array<TetrahedronPieces, 64> table = MakeTable();
  return table[cut_mask];
}

}  // namespace meshless_cutting
