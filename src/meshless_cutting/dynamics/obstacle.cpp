#include "dynamics/obstacle.h"

namespace meshless_cutting {

Obstacle::Obstacle(const ObstacleConfig& config) : friction_(config.friction) {
  if (const auto* plane = std::get_if<PlaneObstacle>(&config.shape)) {
    faces_[0].normal = plane->normal.normalized();
    faces_[0].offset = faces_[0].normal.dot(plane->point);
    return;
  }
  const BoxObstacle& box = std::get<BoxObstacle>(config.shape);
  face_count_ = 6;
  for (int f = 0; f < 6; ++f) {
    const int axis = f / 2;
    faces_[f].normal = (f % 2 == 0 ? 1.0 : -1.0) * box.T_WB.linear().col(axis);
    faces_[f].offset = faces_[f].normal.dot(box.T_WB.translation()) + box.half_extents[axis];
  }
  const Eigen::Vector3d half = box.T_WB.linear().cwiseAbs() * box.half_extents;
  bounds_ = Eigen::AlignedBox3d(box.T_WB.translation() - half, box.T_WB.translation() + half);
}

double Obstacle::Distance(const Eigen::Vector3d& x) const {
  double distance = faces_[0].Gap(x);
  for (int f = 1; f < face_count_; ++f) distance = std::max(distance, faces_[f].Gap(x));
  return distance;
}

bool Obstacle::Near(const Eigen::AlignedBox3d& box, double margin) const {
  if (face_count_ == 1) {
    const Eigen::Vector3d half = 0.5 * box.sizes();
    return faces_[0].Gap(box.center()) - faces_[0].normal.cwiseAbs().dot(half) <= margin;
  }
  return bounds_.exteriorDistance(box) <= margin;
}

int Obstacle::ChooseFace(const Eigen::Vector3d& x, int previous) const {
  if (face_count_ == 1) return 0;
  int closest = 0;
  double largest = faces_[0].Gap(x);
  for (int f = 1; f < 6; ++f) {
    const double gap = faces_[f].Gap(x);
    if (gap > largest) {
      largest = gap;
      closest = f;
    }
  }
  if (previous == kNoFace || faces_[previous].Gap(x) >= 0) return closest;
  // Held by `previous`, unless the vertex has gone round an edge: out at the opposite face means it went through.
  for (int f = 0; f < 6; ++f) {
    if (f / 2 != previous / 2 && faces_[f].Gap(x) >= 0) return closest;
  }
  return previous;
}

}  // namespace meshless_cutting
