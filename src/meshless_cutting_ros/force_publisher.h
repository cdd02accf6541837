// ~<tool>/measured_cf of the tools whose scene has `force`.
#pragma once

#include <ros/ros.h>

#include <string>
#include <vector>

#include "force_estimate.h"
#include "simulation.h"

namespace meshless_cutting {

/// Of one scene. Used by the thread that makes the frames.
class ForcePublisher {
 public:
  ForcePublisher(ros::NodeHandle nh, const Scene& scene);

  /// The wrenches of the frame that `simulation` has just made, scene frame, about the tool's origin.
  void Publish(const Simulation& simulation, ros::Time stamp);
  /// No force, at once: pause, reset, end.
  void Zero(ros::Time stamp);

 private:
  struct Channel {
    int tool;
    ForceEstimate estimate;
    ros::Publisher publisher;
  };
  void Send(const Channel& channel, const ToolWrench& wrench, ros::Time stamp) const;

  std::string frame_;
  double time_step_s_;
  std::vector<Channel> channels_;
};

}  // namespace meshless_cutting
