// How the samples of a driver are read, for the node and for `replay` alike.
#pragma once

#include <sensor_msgs/Joy.h>

#include <optional>

#include "input_report.h"
#include "pose_sample.h"

namespace meshless_cutting {

/// Applies what the scene says of the tool's driver: units, frame, orientation, whether the stamp counts (a stamp that
/// does not becomes 0: the time of receipt is put there).
void ApplyPolicy(const ToolConfig& config, PoseSample* sample);

/// Counts what is odd about a sample (scene frame) that is used all the same: far away, a quaternion that is not of
/// unit length.
void ReportOddities(const PoseSample& sample, InputReport* report);

/// "|p| = 143 m: looks like millimetres; set position_scale: 0.001"; empty when the distance is plausible.
std::string UnitHint(double distance_m);

/// Whether the blade's button is pressed; nothing, and counted, when the message has no such button.
std::optional<bool> ReadButton(const BladeButton& button, const sensor_msgs::Joy& joy, InputReport* report);

}  // namespace meshless_cutting
