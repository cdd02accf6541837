// The record of what went into a frame: written by Session, read again by it.
#pragma once

#include <string>
#include <vector>

#include "messages.h"
#include "pose_sample.h"
#include "simulation.h"

namespace meshless_cutting {

void AddSample(int tool, const PoseSample& sample, bool blade_on, FrameInput* input);
PoseSample SampleOf(const FrameInput& input, std::size_t index);

void AddEdge(int tool, const std::vector<Eigen::Vector3d>& points, FrameInput* input);
/// The points of edge `index`; `point` counts on from edge to edge, from 0.
std::vector<Eigen::Vector3d> EdgeOf(const FrameInput& input, std::size_t index, std::size_t* point);

void SetTuning(const Tuning& tuning, FrameInput* input);
Tuning TuningOf(const FrameInput& input);

/// What is wrong with a record, in words: sizes that do not fit each other, tools that the scene does not have; empty:
/// nothing.
std::string CheckFrameInput(const FrameInput& input, const Scene& scene);

std::int64_t ToNanoseconds(const ros::Time& time);

}  // namespace meshless_cutting
