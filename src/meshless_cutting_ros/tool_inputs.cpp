#include "tool_inputs.h"

#include <cmath>
#include <deque>
#include <sstream>
#include <utility>

#include "tf_poses.h"
#include "tool_policy.h"
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
  std::deque<PoseSample> unstamped;  // their stamp is that of their receipt as yet
  std::deque<EdgeSample> edges;
  std::deque<ButtonSample> buttons;
  std::int64_t newest_tf_ns = -1;
  ReceiptStamps receipt_stamps;
  std::optional<ros::SteadyTime> received;
  bool silence_told = false;
  bool typed = false;  // a message has fixed the type of the subscription
};

std::string SourceName(const ros::NodeHandle& nh, const ToolConfig& config) {
  if (const auto* topic = std::get_if<TopicPoseSource>(&config.pose_source)) return nh.resolveName(topic->topic);
  if (const auto* tf = std::get_if<TfPoseSource>(&config.pose_source)) return "tf frame " + tf->frame;
  return "fixed";
}

ToolInputs::ToolInputs(const ros::NodeHandle& nh, const Scene& scene, InputReports reports)
    : nh_(nh),
      scene_frame_(scene.frame),
      tools_(scene.tools),
      reports_(std::move(reports)),
      boxes_(scene.tools.size()),
      tf_frames_(scene.tools.size()) {}

void ToolInputs::Listen() {
  for (int tool = 0; tool < static_cast<int>(tools_.size()); ++tool) Subscribe(tool, tools_[tool]);
}

ToolInputs::~ToolInputs() {
  pose_topics_.clear();
  edge_subscribers_.clear();
  button_subscribers_.clear();
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
        config.name + "/" + kEdgeTopic, 1000,
        [this, tool](const geometry_msgs::PolygonStamped::ConstPtr& edge) { ReceiveEdge(tool, *edge); },
        ros::VoidConstPtr(), kTransport));
  }
  if (config.blade_button) {
    button_subscribers_.push_back(nh_.subscribe<sensor_msgs::Joy>(
        config.blade_button->topic, 1000,
        [this, tool](const sensor_msgs::Joy::ConstPtr& joy) { ReceiveButton(tool, *joy); }, ros::VoidConstPtr(),
        kTransport));
  }
}

ros::Subscriber ToolInputs::SubscribeToPoses(int tool, const std::string& topic) {
  return nh_.subscribe<topic_tools::ShapeShifter>(
      topic, kInputQueue,
      [this, tool](const topic_tools::ShapeShifter::ConstPtr& message) {
        {
          const std::lock_guard<std::mutex> lock(mutex_);
          boxes_[tool].typed = true;
        }
        if (const auto sample = PoseFromAny(*message)) return Receive(tool, *sample);
        reports_[tool]->Count(InputFault::kWrongType, message->getDataType());
      },
      ros::VoidConstPtr(), kTransport);
}

void ToolInputs::Refresh() {
  for (PoseTopic& topic : pose_topics_) {
    const bool has_publisher = topic.subscriber.getNumPublishers() > 0;
    bool typed = false;  // also by a publisher that came and went between two calls
    if (!has_publisher) {
      const std::lock_guard<std::mutex> lock(mutex_);
      typed = std::exchange(boxes_[topic.tool].typed, false);
    }
    if (!has_publisher && (typed || topic.had_publisher)) {
      topic.subscriber.shutdown();
      topic.subscriber = SubscribeToPoses(topic.tool, topic.name);
    }
    topic.had_publisher = has_publisher;
  }
  if (check_age_) ReportSilence();
}

void ToolInputs::ReportSilence() {
  for (int tool = 0; tool < static_cast<int>(tools_.size()); ++tool) {
    const auto age = Age(tool);
    if (!age || *age <= tools_[tool].timeout_s) continue;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (std::exchange(boxes_[tool].silence_told, true)) continue;
    }
    std::ostringstream value;
    value.precision(3);
    value << *age << " s ago, timeout_s " << tools_[tool].timeout_s;
    reports_[tool]->Count(InputFault::kStale, value.str());
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
  ApplyPolicy(tools_[tool], &sample);
  const bool stamped = sample.stamp_ns != 0;
  if (!stamped) sample.stamp_ns = now;
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
  ReportOddities(sample, &report);
  const std::lock_guard<std::mutex> lock(mutex_);
  Box& box = boxes_[tool];
  box.received = ros::SteadyTime::now();
  box.silence_told = false;
  std::deque<PoseSample>& queue = stamped ? box.poses : box.unstamped;
  if (queue.size() >= static_cast<std::size_t>(kInputQueue)) {
    queue.pop_front();
    report.Count(InputFault::kOverflow, std::to_string(kInputQueue) + " samples wait");
  }
  queue.push_back(std::move(sample));
}

void ToolInputs::ReceiveEdge(int tool, const geometry_msgs::PolygonStamped& edge) {
  const auto stamp = static_cast<std::int64_t>(edge.header.stamp.toNSec());
  EdgeSample sample{stamp == 0 ? Now() : stamp, ToPoints(edge.polygon)};
  const std::lock_guard<std::mutex> lock(mutex_);
  Box& box = boxes_[tool];
  if (box.edges.size() >= static_cast<std::size_t>(kInputQueue)) box.edges.pop_front();
  box.edges.push_back(std::move(sample));
}

void ToolInputs::ReceiveButton(int tool, const sensor_msgs::Joy& joy) {
  const ToolConfig& config = tools_[tool];
  const auto pressed = ReadButton(*config.blade_button, joy, reports_[tool].get());
  if (!pressed) return;
  const bool receipt = joy.header.stamp.isZero() || config.stamp_policy == StampPolicy::kReceipt;
  const ButtonSample sample{receipt ? Now() : static_cast<std::int64_t>(joy.header.stamp.toNSec()), *pressed};
  const std::lock_guard<std::mutex> lock(mutex_);
  Box& box = boxes_[tool];
  if (box.buttons.size() >= static_cast<std::size_t>(kInputQueue)) box.buttons.pop_front();
  box.buttons.push_back(sample);
}

void ToolInputs::HandOver(Session* session) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::int64_t now = Now();
  for (int tool = 0; tool < static_cast<int>(boxes_.size()); ++tool) {
    Box& box = boxes_[tool];
    for (const PoseSample& sample : box.poses) session->Add(tool, sample);
    for (std::size_t left = box.receipt_stamps.Settle(now, &box.unstamped); left > 0; --left) {
      session->Add(tool, box.unstamped.front());
      box.unstamped.pop_front();
    }
    for (EdgeSample& edge : box.edges) session->Add(tool, std::move(edge));
    for (const ButtonSample& button : box.buttons) session->Add(tool, button);
    box.buttons.clear();
    box.poses.clear();
    box.edges.clear();
  }
}

std::optional<double> ToolInputs::Age(int tool) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!boxes_[tool].received) return std::nullopt;
  return (ros::SteadyTime::now() - *boxes_[tool].received).toSec();
}

}  // namespace meshless_cutting
