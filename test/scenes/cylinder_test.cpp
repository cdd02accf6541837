// Paper Fig. 7 and 8: a cylinder that falls onto a blade at rest and a blade that rises through a cylinder at rest make
// the same cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "simulation_checks.h"
#include "support/scenes.h"

namespace meshless_cutting {
namespace {

Scene CylinderScene() {
  Scene scene;
  scene.object.name = "cylinder";
  scene.object.mesh =
      MESHLESS_CUTTING_SOURCE_DIR "/meshes/cylinder.obj";  // radius 0.03, axis along y from -0.05 to 0.05
  scene.object.cell_size_m = 0.01;
  scene.object.lattice_size_m = 0.006;
  scene.object.material = {MaterialModel::kStableNeoHookean, 20000, 0.45, 1050};
  ToolConfig tool;
  tool.name = "blade";
  tool.cutting_edge = {{-0.05, 0.003, 0}, {0.05, -0.004, 0.002}};
  tool.pose_source = TopicPoseSource{"blade/measured_cp"};
  scene.tools = {tool};
  return scene;
}

/// Rest positions of the vertices of cut faces after the blade is through; two fragments, all invariants in every
/// frame.
std::vector<Eigen::Vector3d> CutFace(Simulation& simulation, LineMotion* blade) {
  for (int step = 1; step <= 60 && simulation.surface().fragment_volume_m3.size() == 1; ++step) {
    if (blade) blade->FeedUntil(simulation, 0, step * simulation.scene().time_step_s);
    simulation.Step();
    EXPECT_EQ(simulation.CheckInvariants(), "") << "step " << step;
  }
  const Surface& surface = simulation.surface();
  EXPECT_EQ(surface.fragment_volume_m3.size(), 2u);
  std::vector<Eigen::Vector3d> points;
  for (size_t t = 0; t < surface.triangles.size(); ++t)
    if (surface.region[t] == SurfaceRegion::kCutFace)
      for (std::uint32_t v : surface.triangles[t]) points.push_back(surface.rest_positions[v]);
  return points;
}

double FarthestFrom(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3d>& others) {
  double farthest = 0;
  for (const Eigen::Vector3d& p : points) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& q : others) nearest = std::min(nearest, (p - q).squaredNorm());
    farthest = std::max(farthest, nearest);
  }
  return std::sqrt(farthest);
}

TEST(Cylinder, FallingOntoABladeIsCutAsByARisingBlade) {
  Scene falling = CylinderScene();
  falling.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  Eigen::Isometry3d below = Eigen::Isometry3d::Identity();
  below.translation() = Eigen::Vector3d(0, 0, -0.06);
  falling.tools[0].pose_source = FixedPoseSource{below};
  Simulation first(falling);
  const auto falling_face = CutFace(first, nullptr);

  Simulation second(CylinderScene());
  LineMotion rising{{0, 0, -0.06}, {0, 0, 0.06}, 0.0, 0.15};
  const auto rising_face = CutFace(second, &rising);

  ASSERT_FALSE(falling_face.empty());
  ASSERT_FALSE(rising_face.empty());
  EXPECT_LT(FarthestFrom(falling_face, rising_face), falling.object.lattice_size_m);
  EXPECT_LT(FarthestFrom(rising_face, falling_face), falling.object.lattice_size_m);
}

}  // namespace
}  // namespace meshless_cutting
