#include "input_report.h"

#include <sstream>
#include <stdexcept>
#include <utility>

namespace meshless_cutting {

std::string Name(InputFault fault) {
  switch (fault) {
    case InputFault::kNotFinite:
      return "not finite";
    case InputFault::kZeroQuaternion:
      return "zero quaternion";
    case InputFault::kBackInTime:
      return "back in time";
    case InputFault::kDuplicate:
      return "duplicate";
    case InputFault::kJump:
      return "jump";
    case InputFault::kTooOld:
      return "too old";
    case InputFault::kInFuture:
      return "in the future";
    case InputFault::kUnknownFrame:
      return "unknown frame";
    case InputFault::kWrongType:
      return "wrong type";
    case InputFault::kBadEdge:
      return "bad edge";
    case InputFault::kOverflow:
      return "queue full";
    case InputFault::kFarAway:
      return "far away";
    case InputFault::kNotUnit:
      return "not a unit quaternion";
    case InputFault::kNoButton:
      return "no such button";
    case InputFault::kStale:
      return "silent";
  }
  return "unknown";
}

InputFault FaultOf(SampleVerdict verdict) {
  switch (verdict) {
    case SampleVerdict::kNotFinite:
      return InputFault::kNotFinite;
    case SampleVerdict::kZeroQuaternion:
      return InputFault::kZeroQuaternion;
    case SampleVerdict::kBackInTime:
      return InputFault::kBackInTime;
    case SampleVerdict::kDuplicate:
      return InputFault::kDuplicate;
    case SampleVerdict::kJump:
      return InputFault::kJump;
    case SampleVerdict::kAccepted:
      break;
  }
  throw std::logic_error("FaultOf: an accepted sample has no fault");
}

InputReport::InputReport(std::string tool, std::string topic, double max_speed_m_s)
    : tool_(std::move(tool)), topic_(std::move(topic)), max_speed_m_s_(max_speed_m_s) {}

void InputReport::Count(InputFault fault, const std::string& value) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++counts_[static_cast<int>(fault)];
  last_value_[static_cast<int>(fault)] = value;
}

std::array<std::uint64_t, kInputFaults> InputReport::counts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counts_;
}

std::string InputReport::Expectation(InputFault fault) const {
  switch (fault) {
    case InputFault::kNotFinite:
      return "expected finite numbers; dropped: look for a division by zero or an uncalibrated joint in the driver";
    case InputFault::kZeroQuaternion:
      return "expected a unit quaternion; dropped: let the driver fill orientation, (0, 0, 0, 1) for none";
    case InputFault::kBackInTime:
      return "expected stamps that rise; dropped: is there a second publisher on the topic?";
    case InputFault::kDuplicate:
      return "expected each stamp once; dropped: stamp each sample with its own time of measurement";
    case InputFault::kJump: {
      std::ostringstream words;
      words << "expected at most " << max_speed_m_s_
            << " m/s; the blade starts anew there and cut nothing on the way: raise max_speed_m_s, or set "
               "position_scale if the driver does not send metres";
      return words.str();
    }
    case InputFault::kTooOld:
      return "expected a stamp within 1 s of now; dropped: synchronise the clocks, or leave the stamp 0 to take the "
             "time of receipt";
    case InputFault::kInFuture:
      return "expected a stamp within 1 s of now; dropped: synchronise the clocks, or leave the stamp 0 to take the "
             "time of receipt";
    case InputFault::kUnknownFrame:
      return "expected the scene frame or a frame that tf joins to it; dropped: publish that transform or change "
             "`frame` in the scene";
    case InputFault::kWrongType:
      return "expected geometry_msgs/PoseStamped or geometry_msgs/TransformStamped; dropped: convert or remap the "
             "topic";
    case InputFault::kBadEdge:
      return "expected finite points, as many as cutting_edge_m has; the edge stays as it was";
    case InputFault::kOverflow:
      return "expected fewer samples between two frames; the oldest was dropped: is the simulation paused?";
    case InputFault::kFarAway:
      return "expected at most 10 m from the origin of the scene frame; used as it is";
    case InputFault::kNotUnit:
      return "expected a unit quaternion; normalised: let the driver do so, its order is x, y, z, w";
    case InputFault::kNoButton:
      return "expected a sensor_msgs/Joy with that button; the blade stays as it was: change blade_button.index";
    case InputFault::kStale:
      return "expected samples all the time; the blade is inactive until they come again: does the driver live?";
  }
  return {};
}

std::vector<std::string> InputReport::TakeLines() {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::string> lines;
  for (int i = 0; i < kInputFaults; ++i) {
    const std::uint64_t fresh = counts_[i] - told_[i];
    if (fresh == 0) continue;
    told_[i] = counts_[i];
    const auto fault = static_cast<InputFault>(i);
    lines.push_back("tool " + tool_ + ", " + topic_ + ": " + Name(fault) + ", " + std::to_string(fresh) +
                    " samples, last: " + last_value_[i] + "; " + Expectation(fault));
  }
  return lines;
}

}  // namespace meshless_cutting
