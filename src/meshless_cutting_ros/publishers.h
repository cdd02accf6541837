// Publishes finished frames in a thread of its own, so that serialising and drawing cost the simulation nothing.
#pragma once

#include <ros/ros.h>
#include <visualization_msgs/Marker.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "scene_view.h"

namespace meshless_cutting {

class Publishers {
 public:
  /// `nh` is the private handle of the simulator. `every_second` is called once a second of wall time from the thread.
  Publishers(ros::NodeHandle nh, std::function<void()> every_second);
  ~Publishers();

  /// Whether each of `topics`, names of topics.h, has a listener. Throws std::runtime_error: not a topic of the frames.
  bool HaveListeners(const std::vector<std::string>& topics) const;

  /// Queues a frame. Frames are published whole and in order.
  void Push(FrameView view);

  /// Whether somebody looks at the mapping; computing it is the simulation's work.
  bool mapping_wanted() const { return mapping_wanted_; }

 private:
  void Run();
  void Publish(const FrameView& view);
  void PublishMarkers(bool new_frame);
  void PublishSurroundings(const SurfacePositions& positions);
  /// On both topics, where somebody looks.
  void PublishMarker(const visualization_msgs::Marker& marker);

  ros::Publisher topology_, positions_, cut_events_, statistics_, inputs_, session_, marker_, surroundings_,
      mapping_marker_;
  std::function<void()> every_second_;

  std::atomic<bool> mapping_wanted_{false};
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<FrameView> queue_;
  bool stop_ = false;

  // Of the thread: what is drawn.
  SurfaceTopologyConstPtr last_topology_;
  std::optional<FrameView> last_view_;
  bool clear_markers_ = true;
  ros::SteadyTime last_marker_;
  ros::SteadyTime last_surroundings_;

  std::thread thread_;  // last: all else is there when it starts
};

}  // namespace meshless_cutting
