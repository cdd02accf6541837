// Frames that lag: simulated time slips, the path of a tool does not.
#include "session.h"

#include <gtest/gtest.h>

#include "scene_loading.h"
#include "strokes.h"

namespace meshless_cutting {
namespace {

constexpr std::int64_t kSecond = 1000000000;

struct Outcome {
  int fragments = 0, links_cut = 0, jumps = 0;
};

// A stroke through the block in 0.5 s, frames made at the ends given, s.
Outcome Cut(const std::vector<double>& frame_ends, double max_speed_m_s) {
  Scene scene = LoadSceneFile(BlockScene(), "");
  scene.tools[0].max_speed_m_s = max_speed_m_s;
  InputReports reports;
  for (const ToolConfig& tool : scene.tools) reports.push_back(std::make_shared<InputReport>(tool.name, "", 0));
  Session session(scene, 1, reports, Session::WallTimes::kLeftOut);
  session.Start(kSecond);
  for (const auto& pose : Stroke(ros::Time(1.002), 0.0627)) session.Add(0, FromMessage(pose));
  Outcome outcome;
  for (const double end : frame_ends) {
    const FrameMessages frame = session.Step(kSecond + std::llround(end * 1e9));
    for (const CutEventConstPtr& event : frame.events) outcome.jumps += event->event == CutEvent::JUMP_REFUSED;
    outcome.fragments = static_cast<int>(frame.statistics->fragments);
    outcome.links_cut = static_cast<int>(frame.statistics->links_cut);
  }
  EXPECT_EQ(session.simulation().CheckInvariants(), "");
  return outcome;
}

std::vector<double> Ends(double step) {
  std::vector<double> ends;
  for (double end = step; end < 0.6 + step; end += step) ends.push_back(end);
  return ends;
}

TEST(SessionTest, ALaggingFrameUsesTheWholePathOfTheTool) {
  const double speed = 0.2;  // the stroke has 0.18 m/s
  const Outcome on_time = Cut(Ends(0.02), speed);
  EXPECT_EQ(on_time.fragments, 2);
  EXPECT_EQ(on_time.jumps, 0);
  for (const double step : {0.1, 0.35, 0.7}) {
    const Outcome late = Cut(Ends(step), speed);
    EXPECT_EQ(late.jumps, 0) << step << ": slow motion is no jump because frames are late";
    EXPECT_EQ(late.fragments, 2) << step;
    EXPECT_GT(late.links_cut, 0.9 * on_time.links_cut) << step;
  }
  EXPECT_GT(Cut(Ends(0.35), 0.1).jumps, 0) << "what is too fast is too fast in a late frame too";
}

TEST(SessionTest, AButtonSwitchesTheBladeAtItsStamp) {
  Scene scene = LoadSceneFile(BlockScene(), "");
  scene.tools[0].blade_button = BladeButton{"joy", 0};
  InputReports reports;
  for (const ToolConfig& tool : scene.tools) reports.push_back(std::make_shared<InputReport>(tool.name, "", 0));
  const auto links_cut = [&](std::int64_t on_ns, std::int64_t off_ns) {
    Session session(scene, 1, reports, Session::WallTimes::kLeftOut);
    session.Start(kSecond);
    for (const auto& pose : Stroke(ros::Time(1.002), 0.0627)) session.Add(0, FromMessage(pose));
    session.Add(0, ButtonSample{on_ns, true});
    session.Add(0, ButtonSample{off_ns, false});
    std::uint32_t cut = 0;
    for (const double end : Ends(0.02)) cut = session.Step(kSecond + std::llround(end * 1e9)).statistics->links_cut;
    return cut;
  };
  const auto all = links_cut(0, 3 * kSecond);
  EXPECT_GT(all, 0u);
  EXPECT_EQ(links_cut(3 * kSecond, 4 * kSecond), 0u) << "pressed after the stroke";
  const auto half = links_cut(0, kSecond + 2 * kSecond / 10);
  EXPECT_GT(half, 0u);
  EXPECT_LT(half, all);
}

}  // namespace
}  // namespace meshless_cutting
