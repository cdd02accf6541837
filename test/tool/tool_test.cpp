// Samples in, blade windows out: no gap, no jump cut, nothing from bad samples.
#include "tool/tool.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <vector>

namespace meshless_cutting {
namespace {

ToolConfig Config() {
  ToolConfig config;
  config.cutting_edge = {{0, 0, 0}, {0, 0, 0.03}};
  config.pose_source = TopicPoseSource{"scalpel"};
  config.max_speed_m_s = 2;
  config.timeout_s = 0.1;
  return config;
}

ToolSample At(double time_s, double x) {
  ToolSample sample;
  sample.time_s = time_s;
  sample.position_m[0] = x;
  return sample;
}

TEST(Tool, IsInactiveBeforeTheFirstSample) {
  Tool tool(Config());
  EXPECT_TRUE(tool.Move(0, 0.02).empty());
  EXPECT_FALSE(tool.pose());
}

TEST(Tool, ChainsWindowsThroughEverySampleAndFromFrameToFrame) {
  Tool tool(Config());
  for (int i = 1; i <= 20; ++i) ASSERT_EQ(tool.Add(At(0.002 * i, 0.001 * i)), SampleVerdict::kAccepted);
  std::vector<Eigen::Vector3d> last;
  double last_t = 0;
  int windows = 0;
  for (int frame = 0; frame < 2; ++frame) {
    const BladeMotion motion = tool.Move(0.02 * frame, 0.02 * (frame + 1));
    for (const BladeWindow& window : motion) {
      if (!last.empty()) {
        EXPECT_EQ(window.points_t0, last);
        EXPECT_EQ(window.t0, frame > 0 && &window == &motion[0] ? 0 : last_t);
      }
      last = window.points_t1;
      last_t = window.t1;
      ++windows;
    }
    EXPECT_EQ(motion.back().t1, 1);
  }
  EXPECT_EQ(windows, 19);
  EXPECT_DOUBLE_EQ(last[0][0], 0.020);
}

TEST(Tool, RestsAsAWindowThatStillCuts) {
  Tool tool(Config());
  tool.Add(At(0.01, 0.1));
  tool.Move(0, 0.02);
  const BladeMotion motion = tool.Move(0.02, 0.04);
  ASSERT_EQ(motion.size(), 1u);
  EXPECT_EQ(motion[0].points_t0, motion[0].points_t1);
  EXPECT_EQ(motion[0].t0, 0);
  EXPECT_EQ(motion[0].t1, 1);
}

TEST(Tool, NeverCutsAlongAJump) {
  Tool tool(Config());
  tool.Add(At(0.01, 0));
  tool.Move(0, 0.02);
  EXPECT_EQ(tool.Add(At(0.03, 1.0)), SampleVerdict::kJump);
  const BladeMotion motion = tool.Move(0.02, 0.04);
  EXPECT_EQ(tool.jumps(), 1);
  for (const BladeWindow& window : motion) EXPECT_EQ(window.points_t0[0][0], 1.0);
}

TEST(Tool, IsInactiveWhenSamplesStopAndStartsAnewWhenTheyReturn) {
  Tool tool(Config());
  tool.Add(At(0.01, 0));
  tool.Move(0, 0.02);
  EXPECT_FALSE(tool.Move(0.02, 0.10).empty());
  EXPECT_TRUE(tool.Move(0.10, 0.30).empty());
  EXPECT_TRUE(tool.Move(0.30, 0.50).empty());
  tool.Add(At(0.6, 0.05));
  const BladeMotion motion = tool.Move(0.5, 0.7);
  for (const BladeWindow& window : motion) EXPECT_EQ(window.points_t0[0][0], 0.05);
}

TEST(Tool, RefusesBadSamplesAndKeepsItsState) {
  Tool tool(Config());
  ASSERT_EQ(tool.Add(At(0.01, 0)), SampleVerdict::kAccepted);
  EXPECT_EQ(tool.Add(At(0.01, 0)), SampleVerdict::kDuplicate);
  EXPECT_EQ(tool.Add(At(0.005, 0)), SampleVerdict::kBackInTime);
  EXPECT_EQ(tool.Add(At(0.02, std::numeric_limits<double>::quiet_NaN())), SampleVerdict::kNotFinite);
  EXPECT_EQ(tool.Add(At(std::numeric_limits<double>::infinity(), 0)), SampleVerdict::kNotFinite);
  ToolSample zero = At(0.02, 0);
  zero.orientation_xyzw.setZero();
  EXPECT_EQ(tool.Add(zero), SampleVerdict::kZeroQuaternion);
  ToolSample scaled = At(0.02, 0);
  scaled.orientation_xyzw *= 3;
  EXPECT_EQ(tool.Add(scaled), SampleVerdict::kAccepted);
  const BladeMotion motion = tool.Move(0, 0.02);
  EXPECT_NEAR(motion.back().points_t1[1][2], 0.03, 1e-15);
}

TEST(Tool, BendsItsEdgeFromTheNextFrameOn) {
  Tool tool(Config());
  tool.Add(At(0.01, 0));
  tool.Move(0, 0.02);
  EXPECT_FALSE(tool.SetEdge({{0, 0, 0}}));
  EXPECT_FALSE(tool.SetEdge({{0, 0, 0}, {0, 0, std::numeric_limits<double>::quiet_NaN()}}));
  EXPECT_TRUE(tool.SetEdge({{0, 0, 0}, {0.01, 0, 0.03}}));
  const BladeMotion motion = tool.Move(0.02, 0.04);
  ASSERT_EQ(motion.size(), 1u);
  EXPECT_EQ(motion[0].points_t0[1], Eigen::Vector3d(0, 0, 0.03));
  EXPECT_EQ(motion[0].points_t1[1], Eigen::Vector3d(0.01, 0, 0.03));
}

// Session time is compressed when frames lag; the speed of a hand is not.
TEST(Tool, JudgesSpeedAndSilenceByTheClockOfTheTool) {
  ToolConfig config = Config();
  config.max_speed_m_s = 1;
  Tool tool(config);
  const auto sample = [](double time_s, double measured_s, double x) {
    ToolSample at = At(time_s, x);
    at.measured_s = measured_s;
    return at;
  };
  EXPECT_EQ(tool.Add(sample(0.001, 1.00, 0)), SampleVerdict::kAccepted);
  EXPECT_EQ(tool.Add(sample(0.002, 1.05, 0.04)), SampleVerdict::kAccepted) << "40 m/s in session time";
  EXPECT_EQ(tool.Add(sample(0.003, 1.10, 0.14)), SampleVerdict::kJump);
  EXPECT_EQ(tool.Add(sample(0.004, 1.10, 0.14)), SampleVerdict::kDuplicate);
  EXPECT_EQ(tool.Add(sample(0.005, 1.09, 0.14)), SampleVerdict::kBackInTime);
  EXPECT_EQ(tool.Add(sample(0.006, 1.50, 0.15)), SampleVerdict::kAccepted);
  const BladeMotion motion = tool.Move(0, 0.02);
  // To the second sample, at the jump, and after 0.4 s of silence: only the first and the rests are windows.
  ASSERT_EQ(motion.size(), 2u);
  EXPECT_DOUBLE_EQ(motion[0].points_t1[0][0], 0.04);
  EXPECT_DOUBLE_EQ(motion[1].points_t0[0][0], 0.15);
}

// Samples that a busy machine kept back longer than timeout_s say, when they come, that the driver was never silent.
TEST(Tool, ContinuesFromWhereItWasWhenLateSamplesCloseTheGap) {
  Tool tool(Config());
  constexpr double kFrame = 0.02, kPeriod = 0.005;
  std::vector<BladeMotion> frames;
  int sent = 0;
  for (int frame = 0; frame < 30; ++frame) {
    const double t0 = frame * kFrame, t1 = t0 + kFrame;
    const bool kept_back = frame >= 10 && frame < 20;
    for (; !kept_back && (sent + 1) * kPeriod <= t1; ++sent)
      EXPECT_EQ(tool.Add(At((sent + 1) * kPeriod, 0.001 * sent)), SampleVerdict::kAccepted);
    frames.push_back(tool.Move(t0, t1));
  }
  EXPECT_TRUE(frames[17].empty()) << "inactive while nothing comes";
  std::optional<double> x;
  for (const BladeMotion& motion : frames)
    for (const BladeWindow& window : motion) {
      EXPECT_DOUBLE_EQ(window.points_t0[0][0], x.value_or(0)) << "a part of the path is left out";
      x = window.points_t1[0][0];
    }
  EXPECT_DOUBLE_EQ(x.value(), 0.001 * (sent - 1));
}

// A driver that is late and whose clock does not rise evenly: what is newer by its own clock is never before.
TEST(Tool, TakesANewerSampleWhoseSessionTimeFellBehind) {
  Tool tool(Config());
  ToolSample first = At(0.010, 0), second = At(0.009, 0.001);
  first.measured_s = 1;
  second.measured_s = 1.001;
  EXPECT_EQ(tool.Add(first), SampleVerdict::kAccepted);
  EXPECT_EQ(tool.Add(second), SampleVerdict::kAccepted);
  const BladeMotion motion = tool.Move(0, 0.02);
  ASSERT_EQ(motion.size(), 2u);
  EXPECT_DOUBLE_EQ(motion[0].points_t1[0][0], 0.001);
}

// A driver that stamps when it publishes: a burst is no jump, a jump within a burst is one.
TEST(Tool, JudgesABurstByTheMeanInterval) {
  Tool tool(Config());
  for (int i = 0; i < 50; ++i) EXPECT_EQ(tool.Add(At(0.005 * i, 0.001 * i)), SampleVerdict::kAccepted);
  for (int i = 50; i < 60; ++i) EXPECT_EQ(tool.Add(At(0.3 + 1e-5 * i, 0.001 * i)), SampleVerdict::kAccepted) << i;
  EXPECT_EQ(tool.Add(At(0.3 + 60e-5, 0.059 + 0.011)), SampleVerdict::kJump);
}

TEST(Tool, MovesWithoutCuttingWhileItsBladeIsOff) {
  Tool tool(Config());
  ToolSample off = At(0.015, 0.02);
  off.blade_on = false;
  tool.Add(At(0.005, 0));
  tool.Add(At(0.010, 0.01));
  tool.Add(off);
  const BladeMotion motion = tool.Move(0, 0.02);
  ASSERT_EQ(motion.size(), 1u);
  EXPECT_DOUBLE_EQ(motion[0].points_t1[0][0], 0.01);
  EXPECT_DOUBLE_EQ(tool.pose()->translation().x(), 0.02) << "it moved";
  tool.Add(At(0.025, 0.03));
  const BladeMotion again = tool.Move(0.02, 0.04);
  ASSERT_EQ(again.size(), 1u) << "starts where it is switched on";
  EXPECT_DOUBLE_EQ(again[0].points_t0[0][0], 0.03);
}

}  // namespace
}  // namespace meshless_cutting
