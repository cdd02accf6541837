#include "tf_poses.h"

#include <tf2/exceptions.h>

#include <Eigen/Geometry>

namespace meshless_cutting {
namespace {

Eigen::Isometry3d ToIsometry(const geometry_msgs::Transform& transform) {
  const auto& p = transform.translation;
  const auto& q = transform.rotation;
  return Eigen::Translation3d(p.x, p.y, p.z) * Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
}

// The time for which tf can be asked: at the stamp if it covers it, else the newest.
std::optional<geometry_msgs::TransformStamped> Lookup(const std::string& target, const std::string& source,
                                                      ros::Time stamp, const tf2::BufferCore& tf) {
  try {
    if (!stamp.isZero() && tf.canTransform(target, source, stamp)) return tf.lookupTransform(target, source, stamp);
    return tf.lookupTransform(target, source, ros::Time(0));
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

}  // namespace

bool ExpressIn(const std::string& scene_frame, const tf2::BufferCore& tf, PoseSample* sample) {
  if (sample->frame.empty() || sample->frame == scene_frame) return true;
  ros::Time stamp;
  stamp.fromNSec(static_cast<std::uint64_t>(sample->stamp_ns));
  const auto transform = Lookup(scene_frame, sample->frame, stamp, tf);
  if (!transform) return false;
  const Eigen::Isometry3d T_WF = ToIsometry(transform->transform);
  const Eigen::Vector4d& q = sample->orientation_xyzw;
  const Eigen::Quaterniond rotated = Eigen::Quaterniond(T_WF.linear()) * Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  sample->position_m = T_WF * sample->position_m;
  sample->orientation_xyzw = rotated.coeffs();
  sample->frame = scene_frame;
  return true;
}

std::optional<PoseSample> NewestPose(const std::string& scene_frame, const std::string& tool_frame,
                                     const tf2::BufferCore& tf) {
  const auto transform = Lookup(scene_frame, tool_frame, ros::Time(0), tf);
  if (!transform) return std::nullopt;
  PoseSample sample = FromMessage(*transform);
  sample.frame = scene_frame;
  return sample;
}

}  // namespace meshless_cutting
