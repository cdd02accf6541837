// Which material is where in an object of several.
#pragma once

#include <functional>
#include <vector>

#include "scene/scene.h"

namespace meshless_cutting {

/// Material 0 is the object's own, 1 + i that of its i-th region. An integration point has one material, that of its
/// centroid at load; what is cut off it keeps it.
class MaterialRegions {
 public:
  /// Throws std::runtime_error when the mesh of a region cannot be read.
  explicit MaterialRegions(const ObjectConfig& config);

  /// Whether there is more than one material.
  bool several() const { return !regions_.empty(); }
  /// X: m, object frame.
  int At(const Eigen::Vector3d& X) const;
  double density_kg_m3(int material) const { return density_[static_cast<std::size_t>(material)]; }

 private:
  std::vector<std::function<bool(const Eigen::Vector3d&)>> regions_;
  std::vector<double> density_;
};

}  // namespace meshless_cutting
