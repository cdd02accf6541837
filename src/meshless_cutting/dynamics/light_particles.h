// Particles that carry next to no mass, kept from flying about.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "dynamics/field.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

/// Where a cut leaves a flake in the corner of a cell, the particles on the far side of that cell hold a ten-thousandth
/// of the mass of others, and the forces that place them are as small: they drown in the residual at which a solver
/// stops (the small cut cells of unfitted methods; Burman 2010, Ghost penalty). What is left of their place is noise;
/// divided by the time step it makes velocities of metres per second, which carry them farther off in the next step,
/// until a flake is stretched beyond what Newton's method finds back from. So they keep no velocity of their own: after
/// each step they take that of the affine motion of the next larger point, and stay within kReach cells of the place
/// where it would have them.
class LightParticles {
 public:
  /// Share of the mass of a particle amid full cells below which a particle is light.
  static constexpr double kShare = 0.05;
  static constexpr double kReach = 0.5;

  /// Finds them and their anchors: those of the last call, but near points that changed since and where an anchor is far.
  /// Allocates only to grow.
  void Build(const Tissue& tissue, double cell_m);

  /// After a step. Changes momentum by what light particles carry, nothing else.
  void Follow(Field& position, Field& velocity, Field& acceleration) const;

  int count() const { return static_cast<int>(particles_.size()); }

 private:
  /// What a particle follows; holds until a point at the particles of `own` changes, a far one until any does.
  struct Follower {
    int own = -1;         // the largest of its points; -1: not looked for
    int anchor = -1;      // point; -1: none
    bool is_far = false;  // not next to `own`, or none
  };
  /// Forgets whom particles near points that changed since the last call follow.
  void ForgetChanged(const Tissue& tissue);
  void ListPoints(const Tissue& tissue);
  void FindAnchor(const Tissue& tissue, int particle);
  /// Adds to reached_ what shares a face with a point, each once.
  void ReachNeighbours(const Tissue& tissue, int point);
  /// The weights by which the affine fit to the particles of its anchor says where a particle is; false: no fit.
  bool Fit(const Tissue& tissue, int particle);

  int support_ = 0;
  double reach_ = 0;                 // m
  std::vector<int> particles_;       // heavy ones first: what a light one follows has settled before
  std::vector<Follower> followers_;  // per particle of the tissue
  std::vector<double> weights_;      // K each
  // Of the tissue in the last call.
  std::vector<int> point_particles_;
  std::vector<double> point_volume_;
  // Scratch.
  std::vector<std::uint8_t> touched_;  // per particle: at a point that changed
  std::vector<std::pair<double, int>> by_mass_;
  std::vector<int> point_begin_, points_, shared_;  // the points of each particle; per point, particles with another
  std::vector<int> reached_;                        // of FindAnchor
};

}  // namespace meshless_cutting
