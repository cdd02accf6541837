// The pieces that the object is in: particles that integration points join.
#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/field.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

struct Fragments {
  std::vector<int> of_particle;
  std::vector<std::uint8_t> held;  // per fragment: 1 if any of its particles is fixed
  int count() const { return static_cast<int>(held.size()); }

  /// Allocates only to grow.
  void Build(const Tissue& tissue);

  /// Takes the net force out of what the solver left: moves every fragment that is not held, as a whole, so that the sum of
  /// `residual`, N, over its particles vanishes. `inertia` is dresidual/dy of a translation, kg/s^2 per particle. Elastic forces do not
  /// change, and momentum is conserved to rounding however early the iterations stopped.
  void Balance(const Field& residual, const std::vector<double>& inertia, Field& y);

  /// Energy of the flight of all fragments that are not held, J: what their centres of mass have by their velocity, and by
  /// their way from `start` in a field of gravity. `mass` kg per particle.
  double EnergyOfFlight(const std::vector<double>& mass, const Vector4& gravity, const Field& start, const Field& x,
                        const Field& v);

 private:
  std::vector<int> parent_;
  Field force_;
  std::vector<double> weight_;
};

}  // namespace meshless_cutting
