// Scenes of the shipped meshes for tests, and a blade that moves through them.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "simulation.h"

namespace meshless_cutting {

/// The 0.1 x 0.04 x 0.04 m block, held at x <= 0.01 m, 50 kPa, no gravity, with a straight blade of 0.08 m along y, the
/// middle of its edge at the tool's origin.
inline Scene BlockScene() {
  Scene scene;
  scene.object.name = "block";
  scene.object.mesh = MESHLESS_CUTTING_SOURCE_DIR "/meshes/block.obj";
  scene.object.cell_size_m = 0.01;
  scene.object.lattice_size_m = 0.005;
  scene.object.material = {MaterialModel::kStableNeoHookean, 50000, 0.45, 1050};
  scene.object.fixed = {{{-1, -1, -1}, {0.01, 1, 1}}};
  ToolConfig tool;
  tool.name = "blade";
  tool.cutting_edge = {{0, -0.04, 0}, {0, 0.04, 0}};
  tool.pose_source = TopicPoseSource{"blade/measured_cp"};
  scene.tools = {tool};
  return scene;
}

/// Feeds 500 Hz samples of a tool that moves on a straight line from `from` to `to` (m, scene frame) between two times.
struct LineMotion {
  Eigen::Vector3d from, to;
  double start_s, end_s;

  void FeedUntil(Simulation& simulation, int tool, double time_s) {
    for (; next * 0.002 <= time_s; ++next) {
      ToolSample sample;
      sample.time_s = next * 0.002;
      const double share = std::min(1.0, std::max(0.0, (sample.time_s - start_s) / (end_s - start_s)));
      sample.position_m = (1 - share) * from + share * to;
      simulation.AddToolSample(tool, sample);
    }
  }

  int next = 1;  // sample to feed
};

}  // namespace meshless_cutting
