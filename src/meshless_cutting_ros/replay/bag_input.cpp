#include "replay/bag_input.h"

#include <geometry_msgs/PolygonStamped.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <optional>
#include <stdexcept>

#include "receipt_stamps.h"
#include "replay/damaged_bag.h"
#include "replay/tool_topics.h"
#include "tf_poses.h"
#include "tool_policy.h"
#include "topics.h"

namespace meshless_cutting {
namespace {

// A stamp that runs ahead of the bag's own time by more, from one sample to the next, is not believed.
constexpr std::int64_t kLargestLead_ns = 10000000000;

bool IsTf(const std::string& topic) { return topic == "/tf" || topic == "tf"; }
bool IsStaticTf(const std::string& topic) { return topic == "/tf_static" || topic == "tf_static"; }

// A name of the scene as the node would resolve it.
std::string Resolved(const std::string& simulator, const std::string& topic) {
  if (topic.front() == '/') return topic;
  return simulator + "/" + (topic.front() == '~' ? topic.substr(1) : topic);
}

class Reader {
 public:
  Reader(const Scene& scene, std::vector<std::string> topics, const std::string& simulator, const InputReports& reports)
      : scene_(scene),
        topics_(std::move(topics)),
        reports_(reports),
        tools_(scene.tools.size()),
        last_(scene.tools.size()) {
    for (std::size_t tool = 0; tool < scene.tools.size(); ++tool) {
      edge_topics_.push_back(simulator + "/" + scene.tools[tool].name + "/" + kEdgeTopic);
      const auto& button = scene.tools[tool].blade_button;
      button_topics_.push_back(button ? Resolved(simulator, button->topic) : "");
    }
  }

  void Read(const rosbag::MessageInstance& message) {
    const std::string& topic = message.getTopic();
    if (IsTf(topic) || IsStaticTf(topic)) ReadTf(message, IsStaticTf(topic));
    for (int tool = 0; tool < static_cast<int>(tools_.size()); ++tool) {
      if (topic == topics_[tool]) {
        if (auto sample = PoseFromAny(message)) {
          ApplyPolicy(scene_.tools[tool], &*sample);
          AddSample(tool, *sample, message.getTime());
        }
      } else if (topic == edge_topics_[tool]) {
        if (const auto edge = message.instantiate<geometry_msgs::PolygonStamped>()) {
          const ros::Time stamp = edge->header.stamp.isZero() ? message.getTime() : edge->header.stamp;
          tools_[tool].edges.push_back({static_cast<std::int64_t>(stamp.toNSec()), ToPoints(edge->polygon)});
        }
      } else if (topic == button_topics_[tool]) {
        if (const auto joy = message.instantiate<sensor_msgs::Joy>()) AddButton(tool, *joy, message.getTime());
      }
    }
  }

  std::vector<ToolRecording> Take() {
    for (std::size_t tool = 0; tool < tools_.size(); ++tool) Settle(tool, std::numeric_limits<std::int64_t>::max());
    return std::move(tools_);
  }

 private:
  struct Last {
    std::int64_t stamp_ns = 0;
    std::int64_t received_ns = 0;
    std::int64_t tf_ns = -1;
    std::deque<PoseSample> unstamped;  // their stamp is that of their receipt as yet
    ReceiptStamps receipt_stamps;
  };

  void Settle(std::size_t tool, std::int64_t now_ns) {
    Last& last = last_[tool];
    for (std::size_t left = last.receipt_stamps.Settle(now_ns, &last.unstamped); left > 0; --left) {
      tools_[tool].poses.push_back(last.unstamped.front());
      last.unstamped.pop_front();
    }
  }

  void AddSample(int tool, PoseSample sample, ros::Time received) {
    const auto received_ns = static_cast<std::int64_t>(received.toNSec());
    Last& last = last_[tool];
    const bool stamped = sample.stamp_ns != 0;
    if (!stamped) sample.stamp_ns = received_ns;
    const bool has_last = last.stamp_ns != 0;
    if (has_last && sample.stamp_ns - last.stamp_ns > received_ns - last.received_ns + kLargestLead_ns) {
      return reports_[tool]->Count(InputFault::kInFuture,
                                   "stamp " + std::to_string(1e-9 * static_cast<double>(sample.stamp_ns)));
    }
    if (!ExpressIn(scene_.frame, tf_, &sample)) {
      return reports_[tool]->Count(InputFault::kUnknownFrame,
                                   "frame `" + sample.frame + "`, scene frame `" + scene_.frame + "`");
    }
    ReportOddities(sample, reports_[tool].get());
    last.stamp_ns = sample.stamp_ns;
    last.received_ns = received_ns;
    if (stamped) {
      tools_[tool].poses.push_back(sample);
    } else {
      last.unstamped.push_back(sample);
      Settle(static_cast<std::size_t>(tool), received_ns);
    }
  }

  void AddButton(int tool, const sensor_msgs::Joy& joy, ros::Time received) {
    const ToolConfig& config = scene_.tools[tool];
    const auto pressed = ReadButton(*config.blade_button, joy, reports_[tool].get());
    if (!pressed) return;
    const bool receipt = joy.header.stamp.isZero() || config.stamp_policy == StampPolicy::kReceipt;
    const ros::Time stamp = receipt ? received : joy.header.stamp;
    tools_[tool].buttons.push_back({static_cast<std::int64_t>(stamp.toNSec()), *pressed});
  }

  void ReadTf(const rosbag::MessageInstance& message, bool is_static) {
    const auto transforms = message.instantiate<tf2_msgs::TFMessage>();
    if (!transforms) return;
    for (const auto& transform : transforms->transforms) tf_.setTransform(transform, "bag", is_static);
    for (int tool = 0; tool < static_cast<int>(tools_.size()); ++tool) {
      const auto* source = std::get_if<TfPoseSource>(&scene_.tools[tool].pose_source);
      if (!source) continue;
      const auto sample = NewestPose(scene_.frame, source->frame, tf_);
      if (!sample || (sample->stamp_ns != 0 && sample->stamp_ns == last_[tool].tf_ns)) continue;
      last_[tool].tf_ns = sample->stamp_ns;
      AddSample(tool, *sample, message.getTime());
    }
  }

  const Scene& scene_;
  const std::vector<std::string> topics_;
  std::vector<std::string> edge_topics_, button_topics_;
  const InputReports& reports_;
  tf2::BufferCore tf_;
  std::vector<ToolRecording> tools_;
  std::vector<Last> last_;
};

BagInput ReadWholeBag(const std::string& file, const std::string& name, const Scene& scene, const TopicChoice& choice,
                      const InputReports& reports) {
  const rosbag::Bag bag(file, rosbag::bagmode::Read);
  rosbag::View view(bag);
  const std::vector<std::string> topics = FindToolTopics(view.getConnections(), scene, choice, name);
  Reader reader(scene, topics, choice.simulator, reports);
  for (const rosbag::MessageInstance& message : view) reader.Read(message);

  BagInput input;
  input.tools = reader.Take();
  input.first_ns = std::numeric_limits<std::int64_t>::max();
  bool has_source = false;
  for (std::size_t tool = 0; tool < input.tools.size(); ++tool) {
    ToolRecording& recording = input.tools[tool];
    const auto& source = scene.tools[tool].pose_source;
    const auto* tf = std::get_if<TfPoseSource>(&source);
    recording.topic = tf ? "tf frame " + tf->frame : topics[tool];
    if (std::holds_alternative<FixedPoseSource>(source)) continue;
    has_source = true;
    if (recording.poses.empty()) input.notes.push_back("tool " + scene.tools[tool].name + ": no samples in " + name);
    for (const PoseSample& sample : recording.poses) {
      input.first_ns = std::min(input.first_ns, sample.stamp_ns);
      input.last_ns = std::max(input.last_ns, sample.stamp_ns);
    }
  }
  if (!has_source && view.size() > 0) {
    input.first_ns = static_cast<std::int64_t>(view.getBeginTime().toNSec());
    input.last_ns = static_cast<std::int64_t>(view.getEndTime().toNSec());
  }
  if (input.last_ns == 0) throw std::runtime_error(name + ": no tool pose that can be used; expected at least one");
  return input;
}

}  // namespace

BagInput ReadBag(const std::filesystem::path& bag, const Scene& scene, const TopicChoice& choice,
                 const InputReports& reports) {
  BagInput input;
  const std::string loss = ReadDamagedToo(
      bag, [&](const std::string& file) { input = ReadWholeBag(file, bag.string(), scene, choice, reports); });
  input.loss = loss;
  return input;
}

}  // namespace meshless_cutting
