// The skin, arranged for contact: which vertices hang on which particle, and how much of the surface each stands for.
#pragma once

#include <vector>

#include "tissue/tissue.h"

namespace meshless_cutting {

struct ContactSkin {
  // The vertices whose largest weight is at particle j: vertices[begin[j], begin[j + 1]).
  std::vector<int> begin, vertices;

  /// Share of the surface per vertex, in units of the square of a cell: the vertices that use a particle divide the
  /// particle among them, so that the sum does not depend on how fine the skin is.
  std::vector<double> share;

  void Build(const SurfacePoints& skin, int particles);

 private:
  std::vector<double> use_;
  std::vector<int> owner_;
};

}  // namespace meshless_cutting
