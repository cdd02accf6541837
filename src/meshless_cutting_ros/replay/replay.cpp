#include "replay/replay.h"

#include <rosbag/bag.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "replay/bag_input.h"
#include "replay/replay_summary.h"
#include "replay/temporary_file.h"
#include "scene_loading.h"
#include "topics.h"

namespace meshless_cutting {
namespace {

constexpr double kLongestReplay = 24 * 3600;  // s

std::string ReadUrdf(const std::string& file) {
  if (file.empty()) return {};
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file + ": cannot be read; expected a URDF");
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::unique_ptr<rosbag::Bag> OpenOutput(const std::filesystem::path& part, const std::string& output) {
  try {
    auto bag = std::make_unique<rosbag::Bag>(part.string(), rosbag::bagmode::Write);
    bag->setCompression(rosbag::compression::LZ4);
    return bag;
  } catch (const rosbag::BagException&) {
    throw std::runtime_error(output + ": cannot be written; expected a path in a folder that exists and is writable");
  }
}

class Writer {
 public:
  Writer(rosbag::Bag* bag, std::string simulator) : bag_(bag), prefix_(std::move(simulator) + "/") {}

  void Write(const FrameMessages& messages) {
    const ros::Time time = std::max(messages.positions->header.stamp, ros::TIME_MIN);
    if (messages.session) bag_->write(prefix_ + kSessionTopic, time, *messages.session);
    if (messages.topology) bag_->write(prefix_ + kTopologyTopic, time, *messages.topology);
    bag_->write(prefix_ + kPositionsTopic, time, *messages.positions);
    for (const CutEventConstPtr& event : messages.events) bag_->write(prefix_ + kCutEventsTopic, time, *event);
    if (messages.statistics) bag_->write(prefix_ + kStatisticsTopic, time, *messages.statistics);
  }

 private:
  rosbag::Bag* bag_;
  std::string prefix_;
};

// Hands the samples over as they would have come in, frame by frame.
class Feed {
 public:
  explicit Feed(const BagInput& input) : input_(input), poses_(input.tools.size(), 0), edges_(input.tools.size(), 0) {}

  void HandOver(std::int64_t until_ns, Session* session) {
    for (std::size_t tool = 0; tool < input_.tools.size(); ++tool) {
      const ToolRecording& recording = input_.tools[tool];
      for (; poses_[tool] < recording.poses.size() && recording.poses[poses_[tool]].stamp_ns <= until_ns;
           ++poses_[tool]) {
        session->Add(static_cast<int>(tool), recording.poses[poses_[tool]]);
      }
      for (; edges_[tool] < recording.edges.size() && recording.edges[edges_[tool]].stamp_ns <= until_ns;
           ++edges_[tool]) {
        session->Add(static_cast<int>(tool), recording.edges[edges_[tool]]);
      }
    }
  }

 private:
  const BagInput& input_;
  std::vector<std::size_t> poses_, edges_;
};

}  // namespace

ReplayResult RunReplay(const ReplayOptions& options, const ReplayProgress& progress) {
  const Scene scene = LoadSceneFile(options.scene, ReadUrdf(options.urdf));
  InputReports reports;
  for (const ToolConfig& tool : scene.tools) {
    reports.push_back(std::make_shared<InputReport>(tool.name, options.input, tool.max_speed_m_s));
  }
  const BagInput input = ReadBag(options.input, scene, {options.topics, options.name}, reports);
  const double duration_s = 1e-9 * static_cast<double>(input.last_ns - input.first_ns);
  if (duration_s > kLongestReplay) {
    throw std::runtime_error(options.input + ": samples over " + std::to_string(duration_s) +
                             " s; expected at most a day");
  }
  std::error_code error;
  if (std::filesystem::equivalent(options.input, options.output, error)) {
    throw std::runtime_error(options.output + ": is the input; expected another file");
  }

  TemporaryFile part(options.output + ".part");
  const std::unique_ptr<rosbag::Bag> bag = OpenOutput(part.path(), options.output);
  auto give_up = [] { throw std::runtime_error("interrupted; no output was written"); };
  Session session(scene, 1, reports, Session::WallTimes::kLeftOut, [&](const std::string& stage, double share) {
    if (!progress(share, stage)) give_up();
  });
  session.set_encoding(options.encoding);
  Writer writer(bag.get(), options.name);
  writer.Write(session.Begin(input.first_ns));
  session.Start(input.first_ns);
  const auto frames =
      std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(duration_s / scene.time_step_s - 1e-9)));
  Feed feed(input);
  ReplaySummary summary;
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    feed.HandOver(session.NextInputEnd(), &session);
    writer.Write(session.Step(session.NextInputEnd()));
    summary.Add(session.simulation());
    const std::string what = "frame " + std::to_string(frame + 1) + " of " + std::to_string(frames);
    if (!progress(static_cast<double>(frame + 1) / static_cast<double>(frames), what)) give_up();
  }
  bag->close();
  part.RenameTo(options.output);

  ReplayResult result;
  result.loss = input.loss;
  result.summary = options.output + ": " + summary.Words(session.simulation());
  for (std::size_t tool = 0; tool < scene.tools.size(); ++tool) {
    if (input.tools[tool].topic.empty()) continue;
    result.summary += "\ntool " + scene.tools[tool].name + ": " + std::to_string(input.tools[tool].poses.size()) +
                      " samples of " + input.tools[tool].topic;
  }
  for (const std::string& note : input.notes) result.summary += "\n" + note;
  for (const auto& report : reports) {
    for (const std::string& line : report->TakeLines()) result.summary += "\n" + line;
  }
  return result;
}

}  // namespace meshless_cutting
