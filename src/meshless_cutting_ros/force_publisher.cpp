#include "force_publisher.h"

#include <geometry_msgs/WrenchStamped.h>

#include "topics.h"

namespace meshless_cutting {

ForcePublisher::ForcePublisher(ros::NodeHandle nh, const Scene& scene)
    : frame_(scene.frame), time_step_s_(scene.time_step_s) {
  for (int tool = 0; tool < static_cast<int>(scene.tools.size()); ++tool) {
    const ToolConfig& config = scene.tools[tool];
    if (!config.force) continue;
    const std::string topic = config.name + "/" + kForceTopic;
    channels_.push_back({tool, ForceEstimate(*config.force), nh.advertise<geometry_msgs::WrenchStamped>(topic, 10)});
  }
}

void ForcePublisher::Publish(const Simulation& simulation, ros::Time stamp) {
  for (Channel& channel : channels_) {
    const auto& pose = simulation.tool(channel.tool).pose();
    ForceEstimate::Frame frame;
    frame.trusted = pose && (simulation.statistics().status & kStepFrozen) == 0;
    if (pose) frame.T_WT = *pose;
    frame.blade = simulation.blade(channel.tool);
    for (const StrokeEvent& event : simulation.events()) {
      if (event.tool == channel.tool) frame.events.push_back(event);
    }
    frame.time_step_s = time_step_s_;
    Send(channel, channel.estimate.Update(frame), stamp);
  }
}

void ForcePublisher::Zero(ros::Time stamp) {
  for (Channel& channel : channels_) {
    channel.estimate.Reset();
    Send(channel, ToolWrench(), stamp);
  }
}

void ForcePublisher::Send(const Channel& channel, const ToolWrench& wrench, ros::Time stamp) const {
  geometry_msgs::WrenchStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = frame_;
  message.wrench.force.x = wrench.force_n.x();
  message.wrench.force.y = wrench.force_n.y();
  message.wrench.force.z = wrench.force_n.z();
  message.wrench.torque.x = wrench.torque_nm.x();
  message.wrench.torque.y = wrench.torque_nm.y();
  message.wrench.torque.z = wrench.torque_nm.z();
  channel.publisher.publish(message);
}

}  // namespace meshless_cutting
