// Blade poses for the tests of the ROS layer.
#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>

#include <string>
#include <vector>

namespace meshless_cutting {

/// The scene that these strokes cut.
inline std::string BlockScene() { return MESHLESS_CUTTING_TEST_DIR "/data/block.yaml"; }

inline geometry_msgs::PoseStamped BladePose(ros::Time stamp, double x, double z) {
  geometry_msgs::PoseStamped pose;
  pose.header.stamp = stamp;
  pose.header.frame_id = "world";
  pose.pose.position.x = x;
  pose.pose.position.z = z;
  pose.pose.orientation.w = 1;
  return pose;
}

/// A blade that comes down through the block in the plane at `x`, 0.5 s at 200 Hz from `start` on.
inline std::vector<geometry_msgs::PoseStamped> Stroke(ros::Time start, double x) {
  std::vector<geometry_msgs::PoseStamped> poses;
  for (int i = 0; i <= 100; ++i) poses.push_back(BladePose(start + ros::Duration(i / 200.0), x, 0.06 - 0.0009 * i));
  return poses;
}

inline geometry_msgs::TransformStamped ToTransform(const geometry_msgs::PoseStamped& pose,
                                                   const std::string& child = "tool") {
  geometry_msgs::TransformStamped transform;
  transform.header = pose.header;
  transform.child_frame_id = child;
  transform.transform.translation.x = pose.pose.position.x;
  transform.transform.translation.y = pose.pose.position.y;
  transform.transform.translation.z = pose.pose.position.z;
  transform.transform.rotation = pose.pose.orientation;
  return transform;
}

}  // namespace meshless_cutting
