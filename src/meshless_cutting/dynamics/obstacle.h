// The surface of an obstacle as one vertex sees it during one step: a half-space.
#pragma once

#include <Eigen/Geometry>

#include "scene/scene.h"

namespace meshless_cutting {

/// Points x with normal . x >= offset are outside.
struct HalfSpace {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, outwards
  double offset = 0;                                  // m

  double Gap(const Eigen::Vector3d& x) const { return normal.dot(x) - offset; }
};

/// A plane (one face) or a box (six) in the scene frame. A vertex is held by the face on whose side it was before the step, so
/// that a fast vertex does not pass through a thin tray; one that touched keeps its face until it leaves it, and one that is
/// inside and never had a face takes the closest.
class Obstacle {
 public:
  static constexpr int kNoFace = -1;

  explicit Obstacle(const ObstacleConfig& config);

  double friction() const { return friction_; }

  /// Lower bound of the distance from x, m; negative inside.
  double Distance(const Eigen::Vector3d& x) const;

  /// Whether anything in the box can be closer than `margin`, m. Conservative.
  bool Near(const Eigen::AlignedBox3d& box, double margin) const;

  /// The face for a vertex at x that `previous` held at the end of the last step, or kNoFace.
  int ChooseFace(const Eigen::Vector3d& x, int previous) const;

  const HalfSpace& face(int index) const { return faces_[index]; }

 private:
  double friction_;
  int face_count_ = 1;
  HalfSpace faces_[6];
  Eigen::AlignedBox3d bounds_;  // of a box
};

}  // namespace meshless_cutting
