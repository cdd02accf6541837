// Poses through tf2: of a tool that is a frame, and of samples that come in another frame than the scene's.
#pragma once

#include <tf2/buffer_core.h>

#include <optional>
#include <string>

#include "pose_sample.h"

namespace meshless_cutting {

/// Expresses the sample in `scene_frame`, at its stamp where tf knows it then, else with the latest transform. A sample
/// without a frame is in the scene frame. False, sample unchanged: tf does not join the two frames.
bool ExpressIn(const std::string& scene_frame, const tf2::BufferCore& tf, PoseSample* sample);

/// The newest pose of `tool_frame` in `scene_frame`; nothing when tf does not join them. Stamp 0 when all of it is
/// static.
std::optional<PoseSample> NewestPose(const std::string& scene_frame, const std::string& tool_frame,
                                     const tf2::BufferCore& tf);

}  // namespace meshless_cutting
