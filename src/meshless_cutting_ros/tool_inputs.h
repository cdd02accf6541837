// Where the poses of the tools come from while the simulation runs: topics and tf. Callbacks only file samples in a
// mailbox.
#pragma once

#include <geometry_msgs/PolygonStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/Joy.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <topic_tools/shape_shifter.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "input_report.h"
#include "pose_sample.h"
#include "receipt_stamps.h"
#include "session.h"

namespace meshless_cutting {

/// What the tools of a scene name, subscribed to by Listen(). Lives as long as its session.
class ToolInputs {
 public:
  /// `nh` is the private handle of the simulator; its callback queue runs the callbacks.
  ToolInputs(const ros::NodeHandle& nh, const Scene& scene, InputReports reports);
  ~ToolInputs();

  /// Subscribes. Once; not while another thread is in Refresh().
  void Listen();

  /// Moves what came in since the last call into the session. Any thread.
  void HandOver(Session* session);
  /// Whether a stamp far from now is a fault: yes while frames follow the clock, no while they are stepped by hand.
  void set_check_age(bool check) { check_age_ = check; }
  /// Call once a second. A subscription takes the type of its first publisher; when that is gone any type is welcome
  /// again. A tool that fell silent is reported.
  void Refresh();
  /// Seconds since the last sample of the tool was received; nothing before the first.
  std::optional<double> Age(int tool) const;

 private:
  struct Box;  // samples of one tool
  struct PoseTopic {
    int tool;
    std::string name;
    ros::Subscriber subscriber;
    bool had_publisher;
  };

  void Subscribe(int tool, const ToolConfig& config);
  ros::Subscriber SubscribeToPoses(int tool, const std::string& topic);
  void Receive(int tool, PoseSample sample);
  void ReceiveEdge(int tool, const geometry_msgs::PolygonStamped& edge);
  void ReceiveButton(int tool, const sensor_msgs::Joy& joy);
  void ReportSilence();
  void TfChanged();
  const tf2::BufferCore& Tf();

  ros::NodeHandle nh_;
  const std::string scene_frame_;
  const std::vector<ToolConfig> tools_;
  const InputReports reports_;
  std::atomic<bool> check_age_{true};

  mutable std::mutex mutex_;  // of boxes_
  std::vector<Box> boxes_;

  std::vector<std::string> tf_frames_;  // per tool; empty: not from tf
  std::once_flag tf_once_;
  std::unique_ptr<tf2_ros::Buffer> tf_;
  std::unique_ptr<tf2_ros::TransformListener> tf_listener_;
  boost::signals2::connection tf_changed_;

  // Last: gone before what their callbacks use.
  std::vector<PoseTopic> pose_topics_;
  std::vector<ros::Subscriber> edge_subscribers_, button_subscribers_;
};

/// The name of a tool's source for messages: its topic resolved, "tf frame x" or "fixed".
std::string SourceName(const ros::NodeHandle& nh, const ToolConfig& config);

}  // namespace meshless_cutting
