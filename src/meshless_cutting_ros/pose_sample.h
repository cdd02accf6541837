// A tool pose as a driver sent it, whatever message it came in.
#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "tool/tool.h"

namespace meshless_cutting {

/// Nothing is assumed of the values.
struct PoseSample {
  std::int64_t stamp_ns = 0;  // ROS time; 0: the driver does not stamp
  std::string frame;          // of the pose; empty: the scene frame
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector4d orientation_xyzw = Eigen::Vector4d::UnitW();
};

PoseSample FromMessage(const geometry_msgs::PoseStamped& message);
PoseSample FromMessage(const geometry_msgs::TransformStamped& message);

/// The pose in a message of a type known at run time only (topic_tools::ShapeShifter, rosbag::MessageInstance):
/// PoseStamped or TransformStamped, else nothing.
template <class AnyMessage>
std::optional<PoseSample> PoseFromAny(const AnyMessage& message) {
  if (message.getDataType() == "geometry_msgs/PoseStamped") {
    if (const auto pose = message.template instantiate<geometry_msgs::PoseStamped>()) return FromMessage(*pose);
  } else if (message.getDataType() == "geometry_msgs/TransformStamped") {
    if (const auto transform = message.template instantiate<geometry_msgs::TransformStamped>())
      return FromMessage(*transform);
  }
  return std::nullopt;
}

/// "position (1, 2, 3) m, orientation (0, 0, 0, 1)", for messages.
std::string Words(const PoseSample& sample);

}  // namespace meshless_cutting
