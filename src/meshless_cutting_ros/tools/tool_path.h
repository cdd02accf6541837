// A path of a tool through space and time, from way-points in a file.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

namespace meshless_cutting {

struct WayPoint {
  double time_s = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// Passes through every way-point at its time. Coordinates are monotone between way-points (Fritsch & Carlson 1980): no
/// overshoot at a turn, rest where a way-point is repeated; velocity is continuous.
class ToolPath {
 public:
  /// At least two way-points, times rising. `frame` is that of the poses.
  ToolPath(std::string frame, std::vector<WayPoint> way_points);

  /// Pose at `time_s`; before the first and behind the last way-point theirs.
  Eigen::Isometry3d At(double time_s) const;
  double start_s() const { return way_points_.front().time_s; }
  double end_s() const { return way_points_.back().time_s; }
  const std::string& frame() const { return frame_; }

 private:
  using Coordinates = Eigen::Matrix<double, 7, 1>;  // position, then quaternion x y z w

  std::string frame_;
  std::vector<WayPoint> way_points_;
  std::vector<Coordinates> values_, slopes_;  // per way-point
};

/// Reads
///     tool_path_version: 1
///     frame: world
///     waypoints:
///       - {time_s: 0, position_m: [x, y, z], orientation_xyzw: [x, y, z, w]}
///       - {time_s: 1, position_m: [x, y, z], z_axis: [x, y, z], x_axis: [x, y, z]}   # x_axis is made orthogonal to
///       z_axis
/// Strict as a scene file; throws std::runtime_error with one line of the same form.
ToolPath ReadToolPath(const std::filesystem::path& file);

}  // namespace meshless_cutting
