// Dead loads on the skin, as forces on particles.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "surface/surface.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

/// A load acts on the triangles of the uncut skin whose three vertices lie in its box, in proportion to their area at rest: a
/// third to each vertex, and through the vertex's mapping to the particles. Linear fields do the right work.
class DeadLoads {
 public:
  explicit DeadLoads(const Scene& scene) : scene_(scene) {}

  /// After the tissue changed. Returns the index of a load whose box holds no skin, or -1.
  int TissueChanged(const Tissue& tissue, const Surface& surface, const SurfacePoints& mapping);

  /// Forces on the particles at time_s, N, scene frame. Valid until the next call.
  const std::vector<Eigen::Vector3d>& At(double time_s);
  const std::vector<Eigen::Vector3d>& forces() const { return forces_; }

 private:
  const Scene& scene_;
  struct Share {
    int particle;
    double area;  // m^2
  };
  std::vector<std::vector<Share>> shares_;  // per load
  std::vector<double> area_;                // per load
  std::vector<Eigen::Vector3d> forces_;
};

}  // namespace meshless_cutting
