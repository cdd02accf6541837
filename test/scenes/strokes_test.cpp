// Ways to handle a blade: several at once, one that bends, strokes that come back, a blade left in its cut.
#include <gtest/gtest.h>

#include <map>

#include "simulation_checks.h"
#include "support/scenes.h"

namespace meshless_cutting {
namespace {

ToolConfig SecondTool() {
  ToolConfig tool = BlockScene().tools[0];
  tool.name = "second";
  return tool;
}

void ExpectAllHolds(const Simulation& simulation) {
  EXPECT_EQ(simulation.CheckInvariants(), "") << "step " << simulation.statistics().step;
}

TEST(Strokes, TwoToolsCutAtOnceAndEachReportsItsOwn) {
  Scene scene = BlockScene();
  scene.tools.push_back(SecondTool());
  Simulation simulation(scene);
  LineMotion first{{0.0413, 0.02, 0.06}, {0.0413, 0.02, -0.02}, 0.0, 0.2};
  LineMotion second{{0.0713, 0.02, -0.02}, {0.0713, 0.02, 0.06}, 0.0, 0.2};
  std::map<int, int> links;  // by tool
  for (int step = 1; step <= 15; ++step) {
    first.FeedUntil(simulation, 0, step * scene.time_step_s);
    second.FeedUntil(simulation, 1, step * scene.time_step_s);
    simulation.Step();
    for (const StrokeEvent& event : simulation.events())
      if (event.type == StrokeEventType::kStarted || event.type == StrokeEventType::kProgress)
        links[event.tool] += event.links_cut;
  }
  ExpectAllHolds(simulation);
  EXPECT_EQ(simulation.surface().fragment_volume_m3.size(), 3u);
  EXPECT_GT(links[0], 0);
  EXPECT_GT(links[1], 0);
  EXPECT_EQ(links[0] + links[1], simulation.statistics().links_cut);
}

TEST(Strokes, ALinkThatTwoBladesCrossIsCutOnceByTheFirst) {
  Scene one = BlockScene(), two = BlockScene();
  two.tools.push_back(SecondTool());
  Simulation alone(one), together(two);
  LineMotion blade{{0.0413, 0.02, 0.06}, {0.0413, 0.02, -0.02}, 0.0, 0.2};
  LineMotion same = blade, shadow = blade;
  int by_shadow = 0;
  for (int step = 1; step <= 15; ++step) {
    blade.FeedUntil(alone, 0, step * one.time_step_s);
    same.FeedUntil(together, 0, step * one.time_step_s);
    shadow.FeedUntil(together, 1, step * one.time_step_s);
    alone.Step();
    together.Step();
    for (const StrokeEvent& event : together.events()) by_shadow += event.tool == 1 ? event.links_cut : 0;
  }
  EXPECT_GT(alone.statistics().links_cut, 0);
  EXPECT_EQ(together.statistics().links_cut, alone.statistics().links_cut);
  EXPECT_EQ(by_shadow, 0);
}

TEST(Strokes, AnEdgeThatBendsCutsWhereItGoes) {
  Scene scene = BlockScene();
  scene.tools[0].cutting_edge = {{0, -0.04, 0}, {0, 0, 0}, {0, 0.04, 0}};
  Simulation simulation(scene);
  // The tool stays above the block; its edge is let down through it, the middle first.
  LineMotion still{{0.0613, 0.02, 0.06}, {0.0613, 0.02, 0.06}, 0.0, 1.0};
  for (int step = 1; step <= 30; ++step) {
    still.FeedUntil(simulation, 0, step * scene.time_step_s);
    const double depth = -0.003 * step;
    ASSERT_TRUE(simulation.SetToolEdge(0, {{0, -0.04, std::min(0.0, depth + 0.015)}, {0, 0, depth}, {0, 0.04, std::min(0.0, depth + 0.015)}}));
    simulation.Step();
  }
  ExpectAllHolds(simulation);
  EXPECT_EQ(simulation.surface().fragment_volume_m3.size(), 2u);
  EXPECT_FALSE(simulation.SetToolEdge(0, {{0, 0, 0}, {0, 0, 1}}));  // the number of points stays
}

TEST(Strokes, ComingBackOnTheSamePathCutsNothingMore) {
  Scene scene = BlockScene();
  Simulation simulation(scene);
  // Half way in, out again, in again.
  LineMotion in{{0.0613, 0.02, 0.06}, {0.0613, 0.02, 0.021}, 0.0, 0.2};
  LineMotion out{{0.0613, 0.02, 0.021}, {0.0613, 0.02, 0.06}, 0.25, 0.45};
  LineMotion again{{0.0613, 0.02, 0.06}, {0.0613, 0.02, 0.021}, 0.5, 0.7};
  out.next = 126;
  again.next = 251;
  int links = 0;
  for (int step = 1; step <= 60; ++step) {
    const double t = step * scene.time_step_s;
    LineMotion& motion = t <= 0.25 ? in : t <= 0.5 ? out : again;
    motion.FeedUntil(simulation, 0, std::min(t, t <= 0.25 ? 0.25 : t <= 0.5 ? 0.5 : 1.0));
    simulation.Step();
    if (step == 15) links = simulation.statistics().links_cut;
  }
  EXPECT_GT(links, 0);
  EXPECT_EQ(simulation.statistics().links_cut, links);
  EXPECT_EQ(simulation.surface().fragment_volume_m3.size(), 1u);
  ExpectAllHolds(simulation);
}

TEST(Strokes, ABladeLeftInItsCutForTenThousandFramesCutsNothingMore) {
  Scene scene = BlockScene();
  scene.object.cell_size_m = 0.02;
  scene.object.lattice_size_m = 0.01;
  scene.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  scene.damping = DampingConfig{4.0, 0.004};
  scene.tools[0].timeout_s = 1000;
  Simulation simulation(scene);
  LineMotion blade{{0.0613, 0.02, 0.06}, {0.0613, 0.02, 0.017}, 0.0, 0.3};
  int links = 0;
  size_t fragments = 0;
  const int settled = 300;
  for (int step = 1; step <= settled + 10000; ++step) {
    if (step <= settled) blade.FeedUntil(simulation, 0, step * scene.time_step_s);
    simulation.Step();
    if (step != settled) continue;
    links = simulation.statistics().links_cut;
    fragments = simulation.surface().fragment_volume_m3.size();
  }
  EXPECT_FALSE(simulation.blade(0).empty());
  EXPECT_GT(links, 0);
  EXPECT_EQ(simulation.statistics().links_cut, links);
  EXPECT_EQ(simulation.surface().fragment_volume_m3.size(), fragments);
  ExpectAllHolds(simulation);
}

}  // namespace
}  // namespace meshless_cutting
