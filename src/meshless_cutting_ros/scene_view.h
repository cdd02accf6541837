// What is drawn of a frame besides its messages.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "session.h"

namespace meshless_cutting {

struct ToolView {
  std::optional<Eigen::Isometry3d> T_WT;  // nothing before the first sample
  std::vector<Eigen::Vector3d> blade;     // scene frame, m; empty while inactive
};

/// The paper's Fig. 12.
struct MappingView {
  std::vector<Eigen::Vector3d> points;  // integration points, scene frame, m
  std::vector<int> mapped;              // per surface vertex: the integration point that it follows
};

/// A finished frame, handed from the thread of the simulation to that of the publishers.
struct FrameView {
  FrameMessages messages;
  std::shared_ptr<const Scene> scene;
  std::vector<ToolView> tools;
  std::optional<MappingView> mapping;  // only while somebody looks
};

}  // namespace meshless_cutting
