// Situations and figures of the paper, from the scene files under launch/scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "scene/scene_reader.h"
#include "simulation_checks.h"
#include "support/discrete_sweep.h"
#include "support/tool_player.h"

namespace meshless_cutting {
namespace {

struct Outcome {
  int links_cut = 0;
  std::vector<double> fragment_volume_m3;
  DiscreteSweep discrete;
  std::vector<Eigen::Vector3d> cut_face;  // vertices, at rest, m
};

/// Runs a figure to the end of its strokes, or for `seconds`, and checks all invariants in every `stride`-th frame that
/// cuts and after the last one.
Outcome Play(const std::string& figure, double seconds, int stride = 1) {
  const std::string base = MESHLESS_CUTTING_SOURCE_DIR "/launch/scenes/" + figure;
  Simulation simulation(ReadScene(base + ".yaml"));
  std::unique_ptr<ToolPlayer> player;
  if (seconds == 0) {
    player = std::make_unique<ToolPlayer>(base + "_strokes.yaml");
    seconds = player->end_s();
  }
  const FrameStatistics& frame = simulation.statistics();
  const double volume = RestVolume(simulation.surface());
  Outcome outcome;
  int cutting_frames = 0;
  while (frame.time_s < seconds - 1e-9) {
    const int links_before = frame.links_cut;
    if (player) player->FeedUntil(simulation, 0, frame.time_s + simulation.scene().time_step_s);
    outcome.discrete.Before(simulation);
    simulation.Step();
    outcome.discrete.After(simulation);
    EXPECT_EQ(frame.status & (kStepRolledBack | kStepFrozen), 0u) << figure << ", step " << frame.step;
    if (frame.links_cut == links_before || ++cutting_frames % stride != 0) continue;
    EXPECT_EQ(simulation.CheckInvariants(), "") << figure << ", step " << frame.step;
    EXPECT_NEAR(RestVolume(simulation.surface()), volume, 1e-11 * volume);
    if (testing::Test::HasFailure()) return outcome;
  }
  EXPECT_EQ(simulation.CheckInvariants(), "") << figure;
  for (const Eigen::Vector3d& x : simulation.surface().positions) EXPECT_TRUE(x.allFinite());
  const Surface& surface = simulation.surface();
  outcome.links_cut = frame.links_cut;
  outcome.fragment_volume_m3 = surface.fragment_volume_m3;
  for (size_t t = 0; t < surface.triangles.size(); ++t)
    if (surface.region[t] == SurfaceRegion::kCutFace)
      for (std::uint32_t v : surface.triangles[t]) outcome.cut_face.push_back(surface.rest_positions[v]);
  return outcome;
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

TEST(Figures, Situation1AnObjectThatPassesTheSweptAreaWithinOneFrameIsCut) {
  const Outcome outcome = Play("situation_1", 0);
  EXPECT_EQ(outcome.fragment_volume_m3.size(), 2u);
  EXPECT_EQ(outcome.discrete.found_by_both(), 0);  // of the discrete scheme: nothing
  EXPECT_EQ(outcome.discrete.missed(), outcome.links_cut);
}

TEST(Figures, Situation2AnObjectThatComesWhenTheBladeHasPassedIsNotCut) {
  const Outcome outcome = Play("situation_2", 0);
  EXPECT_EQ(outcome.links_cut, 0);
  EXPECT_GT(outcome.discrete.found_wrongly(), 100);
}

TEST(Figures, Situation3ABladeAtRestCutsWhatFallsOnIt) {
  const Outcome outcome = Play("situation_3", 0.5);
  EXPECT_EQ(outcome.fragment_volume_m3.size(), 2u);
  EXPECT_EQ(outcome.discrete.found_by_both(), 0);
}

TEST(Figures, Fig7And8FallingOntoABladeIsCutAsByARisingBlade) {
  const Outcome falling = Play("fig7_falling_cylinder", 0.4), rising = Play("fig8_rising_edge", 0);
  EXPECT_EQ(falling.fragment_volume_m3.size(), 2u);
  EXPECT_EQ(rising.fragment_volume_m3.size(), 2u);
  ASSERT_FALSE(falling.cut_face.empty());
  ASSERT_FALSE(rising.cut_face.empty());
  const double lattice_size = 0.004;
  EXPECT_LT(FarthestFrom(falling.cut_face, rising.cut_face), lattice_size);
  EXPECT_LT(FarthestFrom(rising.cut_face, falling.cut_face), lattice_size);
}

TEST(Figures, Fig9ACurvedBladeThatTwistsMissesNothing) {
  const Outcome outcome = Play("fig9_twisting_blade", 0, 3);
  EXPECT_EQ(outcome.fragment_volume_m3.size(), 2u);
  EXPECT_GT(outcome.discrete.missed(), 0);
}

TEST(Figures, Fig10ABrainIsCutThroughItsFolds) {
  const Outcome outcome = Play("fig10_brain", 0, 30);
  EXPECT_GT(outcome.links_cut, 2000);
  EXPECT_GT(outcome.discrete.missed(), 100);
}

TEST(Figures, Fig11ALiverIsCutSeveralTimesWhileItTilts) {
  const Outcome outcome = Play("fig11_liver", 0, 8);
  EXPECT_EQ(outcome.fragment_volume_m3.size(), 3u);  // two pieces come free, the third stroke is an incision
  EXPECT_GT(outcome.links_cut, 1000);
}

TEST(Figures, Fig12EveryVertexFollowsAPointOnItsOwnSide) {
  const Outcome outcome = Play("fig12_mapping", 0);  // the invariants say so
  EXPECT_EQ(outcome.fragment_volume_m3.size(), 2u);
}

}  // namespace
}  // namespace meshless_cutting
