#include "pose_sample.h"

#include <sstream>

namespace meshless_cutting {
namespace {

// ROS 1 frame ids once began with a slash; tf2 refuses those.
std::string WithoutSlash(const std::string& frame) {
  return frame.empty() || frame[0] != '/' ? frame : frame.substr(1);
}

std::int64_t Nanoseconds(const ros::Time& time) { return static_cast<std::int64_t>(time.toNSec()); }

}  // namespace

PoseSample FromMessage(const geometry_msgs::PoseStamped& message) {
  const auto& p = message.pose.position;
  const auto& q = message.pose.orientation;
  return {
      Nanoseconds(message.header.stamp), WithoutSlash(message.header.frame_id), {p.x, p.y, p.z}, {q.x, q.y, q.z, q.w}};
}

PoseSample FromMessage(const geometry_msgs::TransformStamped& message) {
  const auto& p = message.transform.translation;
  const auto& q = message.transform.rotation;
  return {
      Nanoseconds(message.header.stamp), WithoutSlash(message.header.frame_id), {p.x, p.y, p.z}, {q.x, q.y, q.z, q.w}};
}

std::string Words(const PoseSample& sample) {
  const Eigen::IOFormat list(4, Eigen::DontAlignCols, ", ", ", ");
  std::ostringstream words;
  words << "position (" << sample.position_m.transpose().format(list) << ") m, orientation ("
        << sample.orientation_xyzw.transpose().format(list) << ")";
  return words.str();
}

}  // namespace meshless_cutting
