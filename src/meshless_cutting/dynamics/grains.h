// Free pieces smaller than a cell of the background grid, kept from shaking.
#pragma once

#include <vector>

#include "dynamics/field.h"
#include "dynamics/fragments.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

/// A grain has no more than an integration point or two: how it deforms is not resolved, its elastic waves pass it many
/// times a step, and one that turns by about a radian a step is where second order schemes gain energy without bound,
/// and Newton's iterations never end. Grains are rigid: after each step they get their shape at rest back, where it
/// fits best (Mueller et al. 2005, Meshless deformations based on shape matching), keep their momentum, and turn by
/// kMostTurn a step at most.
class Grains {
 public:
  static constexpr double kMostTurn =
      0.25;  // rad a step; stretches a radius by 3 % at most before the elastic forces act

  /// Finds the grains. Allocates only to grow.
  void Build(const Tissue& tissue, const Fragments& fragments);

  /// Makes them rigid after a step of `time_step` s.
  void Restore(const Tissue& tissue, double time_step, Field& position, Field& velocity, Field& acceleration) const;

  int count() const { return static_cast<int>(end_.size()); }
  bool IsGrain(int fragment) const { return place_[fragment] >= 0; }

 private:
  std::vector<int> particles_;  // of all grains, grain after grain
  std::vector<int> end_;        // per grain, in particles_
  std::vector<double> volume_;  // per fragment
  std::vector<int> place_;      // per fragment: where its next particle goes; -1: not a grain
};

}  // namespace meshless_cutting
