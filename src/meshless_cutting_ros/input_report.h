// Counts what was wrong with the samples of a tool, and says so without flooding the log.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "tool/tool.h"

namespace meshless_cutting {

/// What was wrong with a sample. kJump is used, but as the start of a new path; kFarAway and kNotUnit are used and only
/// reported; kStale is a sample that did not come.
enum class InputFault {
  kNotFinite,
  kZeroQuaternion,
  kBackInTime,
  kDuplicate,
  kJump,
  kTooOld,
  kInFuture,
  kUnknownFrame,
  kWrongType,
  kBadEdge,
  kOverflow,
  kFarAway,
  kNotUnit,
  kNoButton,
  kStale,
};
inline constexpr int kInputFaults = 15;

/// Short name of a fault, as in diagnostics: "back in time".
std::string Name(InputFault fault);

/// The fault behind a verdict; only for verdicts other than kAccepted.
InputFault FaultOf(SampleVerdict verdict);

/// Faults of one tool. Safe to use from several threads.
class InputReport {
 public:
  /// `topic` and `limits` (e.g. "at most 2 m/s") are for the text only.
  InputReport(std::string tool, std::string topic, double max_speed_m_s);

  void Count(InputFault fault, const std::string& value);
  /// One line per fault that occurred since the last call: topic, how often, value, expectation, remedy.
  std::vector<std::string> TakeLines();

  std::array<std::uint64_t, kInputFaults> counts() const;
  const std::string& tool() const { return tool_; }
  const std::string& topic() const { return topic_; }

 private:
  std::string Expectation(InputFault fault) const;

  const std::string tool_, topic_;
  const double max_speed_m_s_;
  mutable std::mutex mutex_;
  std::array<std::uint64_t, kInputFaults> counts_ = {};
  std::array<std::uint64_t, kInputFaults> told_ = {};
  std::array<std::string, kInputFaults> last_value_;
};

}  // namespace meshless_cutting
