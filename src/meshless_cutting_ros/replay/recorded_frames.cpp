#include "replay/recorded_frames.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <stdexcept>

#include "replay/damaged_bag.h"
#include "topics.h"

namespace meshless_cutting {
namespace {

// Sorts out the frames that follow each other from the first of a session on.
class Sorter {
 public:
  void Add(const FrameInputConstPtr& frame) {
    if (frame->step == 1) {
      session_ = frame->session;
      next_ = 1;
    }
    if (frame->session == session_ && frame->step == next_) {
      frames_.frames.push_back(frame);
      ++next_;
      return;
    }
    const std::string label = "session " + std::to_string(frame->session);
    if (label != told_) {
      frames_.notes.push_back(label + ": left out from frame " + std::to_string(frame->step) +
                              " on, since those before it are not in the bag");
    }
    told_ = label;
  }

  RecordedFrames Take() { return std::move(frames_); }

 private:
  RecordedFrames frames_;
  std::uint32_t session_ = 0;
  std::uint64_t next_ = 0;  // no session yet
  std::string told_;
};

}  // namespace

RecordedFrames ReadRecordedFrames(const std::filesystem::path& bag, const std::string& name) {
  const std::string topic = name + "/" + kInputsTopic;
  RecordedFrames frames;
  const std::string loss = ReadDamagedToo(bag, [&](const std::string& file) {
    Sorter sorter;
    const rosbag::Bag open(file, rosbag::bagmode::Read);
    for (const rosbag::MessageInstance& message : rosbag::View(open, rosbag::TopicQuery(topic))) {
      if (const auto frame = message.instantiate<FrameInput>()) sorter.Add(frame);
    }
    frames = sorter.Take();
  });
  frames.loss = loss;
  if (frames.frames.empty()) {
    const std::string why = frames.notes.empty() ? "no message on " + topic : frames.notes.front();
    throw std::runtime_error(bag.string() + ": " + why +
                             "; expected a recording from the start of a session on: call ~reset once the recorder "
                             "runs, or replay without --as-recorded");
  }
  return frames;
}

}  // namespace meshless_cutting
