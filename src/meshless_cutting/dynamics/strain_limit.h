// The last resort when no step is found: what is strained beyond all use goes back towards its shape.
#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/field.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

/// A flake turned inside out, or a strand drawn out a hundredfold, can leave a state from which neither a second nor a
/// first order step of any length is found. Kept as it is, such a state would be kept for ever. So before the next frame
/// tries again, points whose principal stretches lie outside [1 / kMost, kMost] draw their particles to where the
/// stretches would be within (Mueller et al. 2005, Meshless deformations based on shape matching; limits of strain as
/// Provot 1995), against the particles' other points, which hold them where they are, in proportion to volume.
class StrainLimit {
 public:
  static constexpr double kMost = 2;
  static constexpr int kSweeps = 20;

  /// Returns the number of points that were beyond the limit at first. `free`: 1 for particles that may move.
  int Apply(const Tissue& tissue, const std::vector<double>& free, Field& position);

 private:
  std::vector<double> weight_;  // scratch, per particle: volume of its points
  Field pull_;                  // scratch
};

}  // namespace meshless_cutting
