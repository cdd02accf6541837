#include "publishers.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "markers.h"
#include "topics.h"

namespace meshless_cutting {
namespace {

// A paused simulation is still drawn for an rviz that starts late.
constexpr double kIdleMarkerPeriod = 1;  // s

// Frames that a slow receiver, or a burst of frames stepped by hand, may be behind before any is dropped.
constexpr int kQueue = 200;

}  // namespace

Publishers::Publishers(ros::NodeHandle nh, std::function<void()> every_second)
    : topology_(nh.advertise<SurfaceTopology>(kTopologyTopic, kQueue, true)),
      positions_(nh.advertise<SurfacePositions>(kPositionsTopic, kQueue)),
      cut_events_(nh.advertise<CutEvent>(kCutEventsTopic, 1000)),
      statistics_(nh.advertise<StepStatistics>(kStatisticsTopic, kQueue)),
      inputs_(nh.advertise<FrameInput>(kInputsTopic, kQueue)),
      session_(nh.advertise<SessionInfo>(kSessionTopic, 1, true)),
      marker_(nh.advertise<visualization_msgs::Marker>(kMarkerTopic, 50)),
      surroundings_(nh.advertise<visualization_msgs::Marker>(kSurroundingsTopic, 50)),
      mapping_marker_(nh.advertise<visualization_msgs::MarkerArray>(kMappingMarkerTopic, 2)),
      every_second_(std::move(every_second)),
      thread_([this] { Run(); }) {}

Publishers::~Publishers() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

bool Publishers::HaveListeners(const std::vector<std::string>& topics) const {
  const std::pair<const char*, const ros::Publisher*> publishers[] = {
      {kTopologyTopic, &topology_},     {kPositionsTopic, &positions_}, {kCutEventsTopic, &cut_events_},
      {kStatisticsTopic, &statistics_}, {kInputsTopic, &inputs_},       {kSessionTopic, &session_}};
  bool all = true;
  for (const std::string& topic : topics) {
    const auto found = std::find_if(std::begin(publishers), std::end(publishers),
                                    [&](const auto& publisher) { return topic == publisher.first; });
    if (found == std::end(publishers)) {
      std::string names;
      for (const auto& publisher : publishers) names += std::string(" ") + publisher.first;
      throw std::runtime_error("`" + topic + "`: expected topics of the simulator, of" + names);
    }
    all = all && found->second->getNumSubscribers() > 0;
  }
  return all;
}

void Publishers::Push(FrameView view) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    queue_.push_back(std::move(view));
  }
  wake_.notify_all();
}

void Publishers::Run() {
  ros::SteadyTime last_second = ros::SteadyTime::now();
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    wake_.wait_for(lock, std::chrono::milliseconds(100), [this] { return stop_ || !queue_.empty(); });
    if (stop_ && queue_.empty()) return;
    std::deque<FrameView> views;
    views.swap(queue_);
    lock.unlock();
    for (const FrameView& view : views) Publish(view);
    if (!views.empty()) last_view_ = std::move(views.back());
    PublishMarkers(!views.empty());
    mapping_wanted_ = mapping_marker_.getNumSubscribers() > 0;
    if ((ros::SteadyTime::now() - last_second).toSec() >= 1) {
      last_second = ros::SteadyTime::now();
      every_second_();
    }
    lock.lock();
  }
}

void Publishers::Publish(const FrameView& view) {
  const FrameMessages& messages = view.messages;
  if (messages.session) {
    session_.publish(messages.session);
    clear_markers_ = true;
  }
  if (messages.topology) {
    last_topology_ = messages.topology;
    topology_.publish(messages.topology);
  }
  positions_.publish(messages.positions);
  for (const CutEventConstPtr& event : messages.events) cut_events_.publish(event);
  if (messages.statistics) statistics_.publish(messages.statistics);
  if (messages.input) inputs_.publish(messages.input);
}

void Publishers::PublishMarkers(bool new_frame) {
  if (!last_view_ || !last_topology_) return;
  const bool surface = marker_.getNumSubscribers() > 0;
  const bool surroundings = surroundings_.getNumSubscribers() > 0;
  const bool mapping = mapping_marker_.getNumSubscribers() > 0 && last_view_->mapping;
  if (!surface && !surroundings && !mapping) return;
  const ros::SteadyTime now = ros::SteadyTime::now();
  const double period = new_frame ? 1 / kMarkerRateHz : kIdleMarkerPeriod;
  if ((now - last_marker_).toSec() < period) return;
  last_marker_ = now;
  const SurfacePositionsConstPtr positions = AsFloat32(last_view_->messages.positions);
  if (mapping) mapping_marker_.publish(MappingMarkers(*last_view_->mapping, *positions));
  if (!surface && !surroundings) return;
  if (clear_markers_) PublishMarker(ClearMarker(*last_view_->scene, positions->header.stamp));
  if (surface) marker_.publish(SurfaceMarker(*last_topology_, *positions));
  PublishSurroundings(*positions);
  clear_markers_ = false;
}

void Publishers::PublishSurroundings(const SurfacePositions& positions) {
  const Scene& scene = *last_view_->scene;
  const ros::Time stamp = positions.header.stamp;
  if (!scene.object.fixed.empty()) {
    const auto held = FixedMarker(scene, *last_topology_, positions);
    if (!held.points.empty()) PublishMarker(held);
  }
  for (const auto& tool : ToolMarkers(scene, last_view_->tools, stamp)) PublishMarker(tool);
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (!clear_markers_ && (now - last_surroundings_).toSec() < 1) return;
  for (const auto& obstacle : ObstacleMarkers(scene, stamp)) PublishMarker(obstacle);
  last_surroundings_ = now;
}

void Publishers::PublishMarker(const visualization_msgs::Marker& marker) {
  if (marker_.getNumSubscribers() > 0) marker_.publish(marker);
  if (surroundings_.getNumSubscribers() > 0) surroundings_.publish(marker);
}

}  // namespace meshless_cutting
