// The program `tool_marker`: a tool in the hand of an rviz user. A 6-DOF interactive marker whose pose is published as
// that of a device; its menu switches the blade off and resets the simulator.
#include <geometry_msgs/PoseStamped.h>
#include <interactive_markers/interactive_marker_server.h>
#include <interactive_markers/menu_handler.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <cstdio>
#include <exception>
#include <string>

#include "topics.h"

namespace meshless_cutting {
namespace {

using visualization_msgs::InteractiveMarker;
using visualization_msgs::InteractiveMarkerControl;
using visualization_msgs::InteractiveMarkerFeedbackConstPtr;
using visualization_msgs::Marker;

constexpr char kMarkerName[] = "tool";

class ToolMarker {
 public:
  ToolMarker()
      : nh_("~"),
        frame_(nh_.param<std::string>("frame", "world")),
        simulator_(nh_.param<std::string>("simulator", kDefaultSimulatorName)),
        server_(ros::this_node::getName()) {
    const std::string topic = nh_.param<std::string>("topic", simulator_ + "/scalpel/measured_cp");
    publisher_ = nh_.advertise<geometry_msgs::PoseStamped>(topic, 100);
    reset_ = nh_.serviceClient<std_srvs::Trigger>(simulator_ + "/" + kResetService);
    pose_.orientation.w = 1;
    pose_.position.x = nh_.param("x", 0.0);
    pose_.position.y = nh_.param("y", 0.0);
    pose_.position.z = nh_.param("z", 0.08);
    BuildMenu();
    Show();
    timer_ =
        nh_.createTimer(ros::Duration(1 / nh_.param("rate", 200.0)), [this](const ros::TimerEvent&) { Publish(); });
  }

 private:
  void BuildMenu() {
    using interactive_markers::MenuHandler;
    blade_entry_ = menu_.insert("blade on", [this](const InteractiveMarkerFeedbackConstPtr&) { SetBlade(!blade_on_); });
    menu_.setCheckState(blade_entry_, MenuHandler::CHECKED);
    menu_.insert("reset", [this](const InteractiveMarkerFeedbackConstPtr&) { Reset(); });
  }

  void Show() {
    InteractiveMarker marker;
    marker.header.frame_id = frame_;
    marker.name = kMarkerName;
    marker.description = "tool";
    marker.scale = 0.08;
    marker.pose = pose_;
    InteractiveMarkerControl body;
    body.name = "body";
    body.always_visible = true;
    body.interaction_mode = InteractiveMarkerControl::MOVE_ROTATE_3D;
    Marker mesh;
    mesh.type = Marker::MESH_RESOURCE;
    mesh.mesh_resource = "package://meshless_cutting/meshes/scalpel.stl";
    mesh.scale.x = mesh.scale.y = mesh.scale.z = 1;
    mesh.pose.orientation.w = 1;
    mesh.color.r = 0.75f;
    mesh.color.g = 0.77f;
    mesh.color.b = 0.80f;
    mesh.color.a = 1;
    body.markers.push_back(mesh);
    marker.controls.push_back(body);
    AddAxis(&marker, "x", 1, 0, 0);
    AddAxis(&marker, "y", 0, 0, 1);
    AddAxis(&marker, "z", 0, 1, 0);
    server_.insert(marker, [this](const InteractiveMarkerFeedbackConstPtr& feedback) { pose_ = feedback->pose; });
    menu_.apply(server_, kMarkerName);
    server_.applyChanges();
  }

  // rviz turns and moves along the x axis of a control's orientation.
  static void AddAxis(InteractiveMarker* marker, const std::string& name, double x, double y, double z) {
    InteractiveMarkerControl control;
    const double half_root = 0.70710678118654752;
    control.orientation.w = half_root;
    control.orientation.x = half_root * x;
    control.orientation.y = half_root * y;
    control.orientation.z = half_root * z;
    control.name = "move_" + name;
    control.interaction_mode = InteractiveMarkerControl::MOVE_AXIS;
    marker->controls.push_back(control);
    control.name = "rotate_" + name;
    control.interaction_mode = InteractiveMarkerControl::ROTATE_AXIS;
    marker->controls.push_back(control);
  }

  void SetBlade(bool on) {
    using interactive_markers::MenuHandler;
    blade_on_ = on;
    menu_.setCheckState(blade_entry_, on ? MenuHandler::CHECKED : MenuHandler::UNCHECKED);
    menu_.reApply(server_);
    server_.applyChanges();
  }

  void Reset() {
    std_srvs::Trigger reset;
    if (!reset_.call(reset)) {
      ROS_WARN("%s: no answer; expected a running simulator: set ~simulator to its name", reset_.getService().c_str());
    }
  }

  // A blade without samples becomes inactive by itself, after the timeout of its tool.
  void Publish() {
    if (!blade_on_) return;
    geometry_msgs::PoseStamped message;
    message.header.stamp = ros::Time::now();
    message.header.frame_id = frame_;
    message.pose = pose_;
    publisher_.publish(message);
  }

  ros::NodeHandle nh_;
  std::string frame_, simulator_;
  interactive_markers::InteractiveMarkerServer server_;
  interactive_markers::MenuHandler menu_;
  interactive_markers::MenuHandler::EntryHandle blade_entry_ = 0;
  ros::Publisher publisher_;
  ros::ServiceClient reset_;
  ros::Timer timer_;
  geometry_msgs::Pose pose_;
  bool blade_on_ = true;
};

}  // namespace
}  // namespace meshless_cutting

int main(int argc, char** argv) {
  ros::init(argc, argv, "tool_marker");
  try {
    const meshless_cutting::ToolMarker marker;
    ros::spin();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tool_marker: %s\n", error.what());
    return 1;
  }
  return 0;
}
