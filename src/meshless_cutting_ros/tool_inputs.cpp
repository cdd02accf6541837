#include "tool_inputs.h"

#include <cmath>
#include <deque>
#include <sstream>
#include <utility>

#include "tf_poses.h"
#include "topics.h"

namespace meshless_cutting {
namespace {

// A stamp further from now is of another clock.
constexpr double kLargestAge = 1;  // s

const ros::TransportHints kTransport = ros::TransportHints().tcpNoDelay();

std::int64_t Now() { return static_cast<std::int64_t>(ros::Time::now().toNSec()); }

}  // namespace

struct ToolInputs::Box {
  std::deque<PoseSample> poses;
  std::deque<EdgeSample> edges;
  std::int64_t newest_tf_ns = -1;
  ReceiptStamps receipt_stamps;
  std::optional<ros::SteadyTime> received;
};

std::string SourceName(const ros::NodeHandle& nh, const ToolConfig& config) {
  if (const auto* topic = std::get_if<TopicPoseSource>(&config.pose_source)) return nh.resolveName(topic->topic);
  if (const auto* tf = std::get_if<TfPoseSource>(&config.pose_source)) return "tf frame " + tf->frame;
  return "fixed";
}

ToolInputs::ToolInputs(const ros::NodeHandle& nh, const Scene& scene, InputReports reports)
    : nh_(nh),
      scene_frame_(scene.frame),
      reports_(std::move(reports)),
      boxes_(scene.tools.size()),
      tf_frames_(scene.tools.size()) {
  for (int tool = 0; tool < static_cast<int>(scene.tools.size()); ++tool) Subscribe(tool, scene.tools[tool]);
}

ToolInputs::~ToolInputs() {
  pose_topics_.clear();
  edge_subscribers_.clear();
  tf_changed_.disconnect();
}

void ToolInputs::Subscribe(int tool, const ToolConfig& config) {
  if (const auto* topic = std::get_if<TopicPoseSource>(&config.pose_source)) {
    pose_topics_.push_back({tool, topic->topic, SubscribeToPoses(tool, topic->topic), false});
  } else if (const auto* tf = std::get_if<TfPoseSource>(&config.pose_source)) {
    tf_frames_[tool] = tf->frame;
    Tf();
  }
  if (!std::holds_alternative<FixedPoseSource>(config.pose_source)) {
    edge_subscribers_.push_back(nh_.subscribe<geometry_msgs::PolygonStamped>(
        config.name + "/" + kEdgeTopic, 100,
        [this, tool](const geometry_msgs::PolygonStamped::ConstPtr& edge) { ReceiveEdge(tool, *edge); },
        ros::VoidConstPtr(), kTransport));
  }
}

ros::Subscriber ToolInputs::SubscribeToPoses(int tool, const std::string& topic) {
  return nh_.subscribe<topic_tools::ShapeShifter>(
      topic, 1000,
      [this, tool](const topic_tools::ShapeShifter::ConstPtr& message) {
        if (const auto sample = PoseFromAny(*message)) return Receive(tool, *sample);
        reports_[tool]->Count(InputFault::kWrongType, message->getDataType());
      },
      ros::VoidConstPtr(), kTransport);
}

void ToolInputs::Refresh() {
  for (PoseTopic& topic : pose_topics_) {
    const bool has_publisher = topic.subscriber.getNumPublishers() > 0;
    if (topic.had_publisher && !has_publisher) {
      topic.subscriber.shutdown();
      topic.subscriber = SubscribeToPoses(topic.tool, topic.name);
    }
    topic.had_publisher = has_publisher;
  }
}

const tf2::BufferCore& ToolInputs::Tf() {
  std::call_once(tf_once_, [this] {
    tf_ = std::make_unique<tf2_ros::Buffer>();
    tf_changed_ = tf_->_addTransformsChangedListener([this] { TfChanged(); });
    tf_listener_ = std::make_unique<tf2_ros::TransformListener>(*tf_, nh_, true);
  });
  return *tf_;
}

void ToolInputs::TfChanged() {
  for (int tool = 0; tool < static_cast<int>(tf_frames_.size()); ++tool) {
    if (tf_frames_[tool].empty()) continue;
    const auto sample = NewestPose(scene_frame_, tf_frames_[tool], *tf_);
    if (!sample) continue;
    {
      // tf tells of any change in the tree; the tool may have stayed.
      const std::lock_guard<std::mutex> lock(mutex_);
      if (sample->stamp_ns != 0 && sample->stamp_ns == boxes_[tool].newest_tf_ns) continue;
      boxes_[tool].newest_tf_ns = sample->stamp_ns;
    }
    Receive(tool, *sample);
  }
}

void ToolInputs::Receive(int tool, PoseSample sample) {
  const std::int64_t now = Now();
  if (sample.stamp_ns == 0) {
    const std::lock_guard<std::mutex> lock(mutex_);
    sample.stamp_ns = boxes_[tool].receipt_stamps.Next(now);
  }
  InputReport& report = *reports_[tool];
  if (check_age_) {
    const double age = 1e-9 * static_cast<double>(now - sample.stamp_ns);
    if (std::abs(age) > kLargestAge) {
      std::ostringstream value;
      value << "stamp " << std::abs(age) << " s " << (age > 0 ? "before" : "after") << " now";
      return report.Count(age > 0 ? InputFault::kTooOld : InputFault::kInFuture, value.str());
    }
  }
  const bool foreign = !sample.frame.empty() && sample.frame != scene_frame_;
  if (foreign && !ExpressIn(scene_frame_, Tf(), &sample)) {
    return report.Count(InputFault::kUnknownFrame, "frame `" + sample.frame + "`, scene frame `" + scene_frame_ + "`");
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  Box& box = boxes_[tool];
  box.received = ros::SteadyTime::now();
  if (box.poses.size() >= static_cast<std::size_t>(kInputQueue)) {
    box.poses.pop_front();
    report.Count(InputFault::kOverflow, std::to_string(kInputQueue) + " samples wait");
  }
  box.poses.push_back(std::move(sample));
}

void ToolInputs::ReceiveEdge(int tool, const geometry_msgs::PolygonStamped& edge) {
  const auto stamp = static_cast<std::int64_t>(edge.header.stamp.toNSec());
  EdgeSample sample{stamp == 0 ? Now() : stamp, ToPoints(edge.polygon)};
  const std::lock_guard<std::mutex> lock(mutex_);
  Box& box = boxes_[tool];
  if (box.edges.size() >= static_cast<std::size_t>(kInputQueue)) box.edges.pop_front();
  box.edges.push_back(std::move(sample));
}

void ToolInputs::HandOver(Session* session) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (int tool = 0; tool < static_cast<int>(boxes_.size()); ++tool) {
    for (const PoseSample& sample : boxes_[tool].poses) session->Add(tool, sample);
    for (EdgeSample& edge : boxes_[tool].edges) session->Add(tool, std::move(edge));
    boxes_[tool].poses.clear();
    boxes_[tool].edges.clear();
  }
}

std::optional<double> ToolInputs::Age(int tool) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!boxes_[tool].received) return std::nullopt;
  return (ros::SteadyTime::now() - *boxes_[tool].received).toSec();
}

}  // namespace meshless_cutting
