#include "replay/replay.h"

#include <rosbag/bag.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "replay/bag_input.h"
#include "replay/recorded_frames.h"
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
    if (messages.input) bag_->write(prefix_ + kInputsTopic, time, *messages.input);
  }

 private:
  rosbag::Bag* bag_;
  std::string prefix_;
};

// Hands the samples over as they would have come in, frame by frame.
class Feed {
 public:
  explicit Feed(const BagInput& input)
      : input_(input), poses_(input.tools.size(), 0), edges_(input.tools.size(), 0), buttons_(input.tools.size(), 0) {}

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
      std::size_t& button = buttons_[tool];
      for (; button < recording.buttons.size() && recording.buttons[button].stamp_ns <= until_ns; ++button) {
        session->Add(static_cast<int>(tool), recording.buttons[button]);
      }
    }
  }

 private:
  const BagInput& input_;
  std::vector<std::size_t> poses_, edges_, buttons_;
};

// What a replay has in hand, whatever its frames are made of.
class Run {
 public:
  Run(const ReplayOptions& options, const ReplayProgress& progress)
      : options_(options), progress_(progress), scene_(LoadSceneFile(options.scene, ReadUrdf(options.urdf))) {
    for (const ToolConfig& tool : scene_.tools) {
      reports_.push_back(std::make_shared<InputReport>(tool.name, options.input, tool.max_speed_m_s));
    }
  }

  const Scene& scene() const { return scene_; }
  const InputReports& reports() const { return reports_; }
  Session& session() { return *session_; }

  /// Builds the session and opens the output.
  void Open(std::uint32_t number) {
    std::error_code error;
    if (std::filesystem::equivalent(options_.input, options_.output, error)) {
      throw std::runtime_error(options_.output + ": is the input; expected another file");
    }
    part_.emplace(options_.output + ".part");
    bag_ = OpenOutput(part_->path(), options_.output);
    writer_.emplace(bag_.get(), options_.name);
    session_.emplace(scene_, number, reports_, Session::WallTimes::kLeftOut,
                     [this](const std::string& stage, double share) { Show(share, stage); });
    session_->set_encoding(options_.encoding);
  }

  void Write(const FrameMessages& messages) { writer_->Write(messages); }

  void WriteFrame(const FrameMessages& messages, std::int64_t frame, std::int64_t frames) {
    Write(messages);
    summary_.Add(session_->simulation());
    Show(static_cast<double>(frame) / static_cast<double>(frames),
         "frame " + std::to_string(frame) + " of " + std::to_string(frames));
  }

  ReplayResult Close(const std::string& loss, const std::vector<std::string>& notes) {
    bag_->close();
    part_->RenameTo(options_.output);
    ReplayResult result;
    result.loss = loss;
    result.summary = options_.output + ": " + summary_.Words(session_->simulation());
    for (const std::string& note : notes) result.summary += "\n" + note;
    for (const auto& report : reports_) {
      for (const std::string& line : report->TakeLines()) result.summary += "\n" + line;
    }
    return result;
  }

 private:
  void Show(double share, const std::string& what) const {
    if (!progress_(share, what)) throw std::runtime_error("interrupted; no output was written");
  }

  const ReplayOptions& options_;
  const ReplayProgress& progress_;
  const Scene scene_;
  InputReports reports_;
  std::optional<TemporaryFile> part_;
  std::unique_ptr<rosbag::Bag> bag_;
  std::optional<Writer> writer_;
  std::optional<Session> session_;
  ReplaySummary summary_;
};

// Frames on time, from the first sample to the last.
ReplayResult ReplaySamples(const ReplayOptions& options, Run* run) {
  const Scene& scene = run->scene();
  const BagInput input = ReadBag(options.input, scene, {options.topics, options.name}, run->reports());
  const double duration_s = 1e-9 * static_cast<double>(input.last_ns - input.first_ns);
  if (duration_s > kLongestReplay) {
    throw std::runtime_error(options.input + ": samples over " + std::to_string(duration_s) +
                             " s; expected at most a day");
  }
  run->Open(1);
  Session& session = run->session();
  run->Write(session.Begin(input.first_ns));
  session.Start(input.first_ns);
  const auto frames =
      std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(duration_s / scene.time_step_s - 1e-9)));
  Feed feed(input);
  for (std::int64_t frame = 1; frame <= frames; ++frame) {
    feed.HandOver(session.NextInputEnd(), &session);
    run->WriteFrame(session.Step(session.NextInputEnd()), frame, frames);
  }
  std::vector<std::string> notes;
  for (std::size_t tool = 0; tool < scene.tools.size(); ++tool) {
    if (input.tools[tool].topic.empty()) continue;
    notes.push_back("tool " + scene.tools[tool].name + ": " + std::to_string(input.tools[tool].poses.size()) +
                    " samples of " + input.tools[tool].topic);
  }
  notes.insert(notes.end(), input.notes.begin(), input.notes.end());
  return run->Close(input.loss, notes);
}

// The frames of a node as it made them.
ReplayResult ReplayFrames(const ReplayOptions& options, Run* run) {
  const RecordedFrames recorded = ReadRecordedFrames(options.input, options.name);
  const auto& frames = recorded.frames;
  run->Open(frames.front()->session);
  Session& session = run->session();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i]->step == 1) {
      if (i > 0) session.Reset(frames[i]->session);
      run->Write(session.Begin(static_cast<std::int64_t>(frames[i]->start.toNSec())));
    }
    run->WriteFrame(session.StepAgain(*frames[i]), static_cast<std::int64_t>(i) + 1,
                    static_cast<std::int64_t>(frames.size()));
  }
  return run->Close(recorded.loss, recorded.notes);
}

}  // namespace

ReplayResult RunReplay(const ReplayOptions& options, const ReplayProgress& progress) {
  Run run(options, progress);
  return options.as_recorded ? ReplayFrames(options, &run) : ReplaySamples(options, &run);
}

}  // namespace meshless_cutting
