#include "tool_policy.h"

#include <cmath>
#include <sstream>

namespace meshless_cutting {
namespace {

constexpr double kFarAway_m = 10;        // no cell is larger
constexpr double kUnitTolerance = 0.01;  // a driver that sends float32 stays far below

}  // namespace

void ApplyPolicy(const ToolConfig& config, PoseSample* sample) {
  if (config.stamp_policy == StampPolicy::kReceipt) sample->stamp_ns = 0;
  if (!config.frame_id.empty()) sample->frame = config.frame_id;
  sample->position_m *= config.position_scale;
  if (config.position_only) sample->orientation_xyzw = config.orientation.coeffs();
}

std::string UnitHint(double distance_m) {
  if (!(distance_m > kFarAway_m)) return {};
  std::ostringstream hint;
  hint.precision(3);
  hint << "|p| = " << distance_m << " m: ";
  if (distance_m < 1e4) {
    hint << "looks like millimetres; set position_scale: 0.001";
  } else {
    hint << "not a place in a cell; set position_scale to metres per unit of the driver";
  }
  return hint.str();
}

void ReportOddities(const PoseSample& sample, InputReport* report) {
  if (!sample.position_m.allFinite() || !sample.orientation_xyzw.allFinite()) return;  // refused later
  const std::string hint = UnitHint(sample.position_m.norm());
  if (!hint.empty()) report->Count(InputFault::kFarAway, hint);
  const double length = sample.orientation_xyzw.norm();
  if (length > 1e-6 && std::abs(length - 1) > kUnitTolerance) {
    std::ostringstream value;
    value << "a quaternion of length " << length;
    report->Count(InputFault::kNotUnit, value.str());
  }
}

std::optional<bool> ReadButton(const BladeButton& button, const sensor_msgs::Joy& joy, InputReport* report) {
  if (button.index < static_cast<int>(joy.buttons.size())) return joy.buttons[button.index] != 0;
  report->Count(InputFault::kNoButton,
                "button " + std::to_string(button.index) + " of " + std::to_string(joy.buttons.size()));
  return std::nullopt;
}

}  // namespace meshless_cutting
