// A blade through a block, from tool samples to fragments.
#include <gtest/gtest.h>

#include "simulation_checks.h"
#include "support/scenes.h"

namespace meshless_cutting {
namespace {

constexpr double kVolume = 0.1 * 0.04 * 0.04;

/// Centroid of the volume that the surface of one fragment encloses now, m.
Eigen::Vector3d Centroid(const Surface& surface, std::uint32_t fragment) {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double volume = 0;
  for (size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.fragment[t] != fragment) continue;
    const Eigen::Vector3d &a = surface.positions[surface.triangles[t][0]],
                          &b = surface.positions[surface.triangles[t][1]],
                          &c = surface.positions[surface.triangles[t][2]];
    const double v = a.cross(b).dot(c) / 6;
    volume += v;
    moment += v * (a + b + c) / 4;
  }
  return moment / volume;
}

TEST(Block, FallsInTwoWhenTheBladePasses) {
  Scene scene = BlockScene();
  scene.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  Simulation simulation(scene);
  LineMotion blade{{0.062, 0.02, -0.02}, {0.062, 0.02, 0.14}, 0.05, 0.2};
  const double volume = RestVolume(simulation.surface());
  EXPECT_NEAR(volume, kVolume, 1e-12);
  int separated_step = -1, started = 0, ended = 0;
  std::vector<double> height;
  for (int step = 1; step <= 40; ++step) {
    blade.FeedUntil(simulation, 0, step * scene.time_step_s);
    simulation.Step();
    ASSERT_EQ(simulation.CheckInvariants(), "") << "step " << step;
    ASSERT_NEAR(RestVolume(simulation.surface()), volume, 1e-6 * volume);
    for (const Eigen::Vector3d& x : simulation.surface().positions) ASSERT_TRUE(x.allFinite());
    for (const StrokeEvent& event : simulation.events()) {
      started += event.type == StrokeEventType::kStarted;
      ended += event.type == StrokeEventType::kEnded;
      if (event.type == StrokeEventType::kSeparated) {
        EXPECT_EQ(separated_step, -1);
        separated_step = step;
        EXPECT_EQ(event.fragment_volume_m3.size(), 2u);
      }
    }
    if (separated_step >= 0) height.push_back(Centroid(simulation.surface(), 1)[2]);
  }
  ASSERT_GT(separated_step, 0);
  EXPECT_EQ(started, 1);
  EXPECT_EQ(ended, 1);
  const auto& volumes = simulation.surface().fragment_volume_m3;
  ASSERT_EQ(volumes.size(), 2u);
  EXPECT_NEAR(volumes[0] + volumes[1], kVolume, 1e-9 * kVolume);
  // Every vertex of a fragment stays on its side of the plane that was cut.
  const Surface& surface = simulation.surface();
  for (size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::uint32_t v : surface.triangles[t]) {
      const double x = surface.rest_positions[v][0];
      if (surface.fragment[t] == 0) {
        EXPECT_LT(x, 0.062 + scene.object.lattice_size_m);
      } else {
        EXPECT_GT(x, 0.062 - scene.object.lattice_size_m);
      }
    }
  // Free fall from the velocity that the piece had when it came free.
  const double dt = scene.time_step_s;
  const double v0 = (height[1] - height[0]) / dt + 0.5 * 9.81 * dt;
  for (size_t i = 5; i < height.size(); ++i) {
    const double t = static_cast<double>(i) * dt, fallen = height[0] + v0 * t - height[i];
    EXPECT_NEAR(fallen, 0.5 * 9.81 * t * t, 0.02 * 0.5 * 9.81 * t * t) << "after " << t << " s";
  }
  EXPECT_GT(height.size(), 20u);
}

/// A cut in the first layer of cells beside the wall: the nodes of the wall are in reach of what was cut off, its material is not.
TEST(Block, WhatIsCutOffBesideTheWallFalls) {
  for (double x : {0.0115, 0.015, 0.0185}) {
    Scene scene = BlockScene();
    scene.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
    scene.object.slits = {{{x, -0.01, -0.01}, {Eigen::Vector3d(0, 0.06, 0), Eigen::Vector3d(0.001, 0, 0.06)}}};
    Simulation simulation(scene);
    ASSERT_EQ(simulation.CheckInvariants(), "");
    ASSERT_EQ(simulation.surface().fragment_volume_m3.size(), 2u);
    const double height = Centroid(simulation.surface(), 0)[2];
    constexpr int kFrames = 20;
    for (int step = 0; step < kFrames; ++step) simulation.Step();
    const double t = kFrames * scene.time_step_s;
    EXPECT_NEAR(height - Centroid(simulation.surface(), 0)[2], 0.5 * 9.81 * t * t, 0.01 * 0.5 * 9.81 * t * t) << "cut at " << x;
    EXPECT_EQ(simulation.CheckInvariants(), "");
  }
}

TEST(Block, HalfAStrokeLeavesOnePieceThatGapes) {
  Scene scene = BlockScene();
  scene.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  Simulation simulation(scene);
  LineMotion blade{{0.05, 0.02, 0.06}, {0.05, 0.02, 0.02}, 0.05, 0.2};
  for (int step = 1; step <= 60; ++step) {
    blade.FeedUntil(simulation, 0, step * scene.time_step_s);
    simulation.Step();
    ASSERT_EQ(simulation.CheckInvariants(), "") << "step " << step;
  }
  const Surface& surface = simulation.surface();
  EXPECT_EQ(surface.fragment_volume_m3.size(), 1u);
  // The lips at the top of the cut stand apart: where cut faces reach z = 0.04 at rest, on average over either lip.
  double left = 0, right = 0;
  int left_count = 0, right_count = 0;
  for (size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.region[t] != SurfaceRegion::kCutFace) continue;
    const auto& v = surface.triangles[t];
    const auto& X = surface.rest_positions;
    const bool on_left = (X[v[1]] - X[v[0]]).cross(X[v[2]] - X[v[0]])[0] > 0;  // its face looks to the right
    for (std::uint32_t corner : v)
      if (X[corner][2] > 0.0399) {
        (on_left ? left : right) += surface.positions[corner][0];
        ++(on_left ? left_count : right_count);
      }
  }
  ASSERT_GT(left_count, 0);
  ASSERT_GT(right_count, 0);
  EXPECT_GT(right / right_count - left / left_count, 0.001) << "mouth of the cut, m";
}

TEST(Block, StaysAsItIsWithoutALoad) {
  Simulation simulation(BlockScene());
  const auto start = simulation.surface().positions;
  for (int step = 0; step < 10; ++step) simulation.Step();
  for (size_t v = 0; v < start.size(); ++v) EXPECT_LT((simulation.surface().positions[v] - start[v]).norm(), 1e-12);
}

TEST(Block, SameSamplesSameBitsWhateverTheThreads) {
  std::vector<Eigen::Vector3d> reference;
  for (int threads : {1, 2, 1}) {
    Scene scene = BlockScene();
    scene.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
    scene.solver.threads = threads;
    Simulation simulation(scene);
    LineMotion blade{{0.062, 0.02, -0.02}, {0.062, 0.02, 0.14}, 0.05, 0.2};
    for (int step = 1; step <= 20; ++step) {
      blade.FeedUntil(simulation, 0, step * scene.time_step_s);
      simulation.Step();
    }
    if (reference.empty()) reference = simulation.surface().positions;
    ASSERT_EQ(reference.size(), simulation.surface().positions.size());
    for (size_t v = 0; v < reference.size(); ++v) ASSERT_EQ(reference[v], simulation.surface().positions[v]);
  }
}

TEST(Block, ResetGoesBackToTheStart) {
  Scene scene = BlockScene();
  scene.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  Simulation simulation(scene);
  std::vector<Eigen::Vector3d> first;
  for (int run = 0; run < 2; ++run) {
    LineMotion blade{{0.062, 0.02, -0.02}, {0.062, 0.02, 0.14}, 0.05, 0.2};
    for (int step = 1; step <= 20; ++step) {
      blade.FeedUntil(simulation, 0, step * scene.time_step_s);
      simulation.Step();
    }
    if (run == 0)
      first = simulation.surface().positions;
    else
      EXPECT_EQ(first, simulation.surface().positions);
    simulation.Reset();
    EXPECT_EQ(simulation.surface().fragment_volume_m3.size(), 1u);
    EXPECT_EQ(simulation.statistics().step, 0u);
  }
}

TEST(Block, ASceneWithoutPartsBuildsNone) {
  Scene scene = BlockScene();
  scene.tools.clear();
  scene.object.fixed.clear();
  Simulation simulation(scene);
  EXPECT_FALSE(simulation.parts().tools || simulation.parts().gravity || simulation.parts().damping ||
               simulation.parts().fixed || simulation.parts().obstacles);
  simulation.Step();
  EXPECT_EQ(simulation.statistics().move_tools_s, 0);
  EXPECT_EQ(simulation.statistics().find_crossings_s, 0);
  EXPECT_EQ(simulation.statistics().cut_s, 0);
  EXPECT_EQ(simulation.statistics().contacts, 0);
}

}  // namespace
}  // namespace meshless_cutting
