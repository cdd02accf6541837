#include "session_clock.h"

#include <gtest/gtest.h>

namespace meshless_cutting {
namespace {

constexpr std::int64_t kStart = 1700000000123456789;
constexpr std::int64_t kMillisecond = 1000000;

TEST(SessionClockTest, OnTimeStampsAreSimulatedTime) {
  SessionClock clock(kStart, 1.0 / 60);
  for (int frame = 1; frame <= 600; ++frame) clock.BeginFrame(clock.NextInputEnd());
  EXPECT_EQ(clock.SimulatedStamp(), kStart + 10000000000) << "600 sixtieths are 10 s, without drift";
  EXPECT_EQ(clock.slip_s(), 0);
  EXPECT_DOUBLE_EQ(clock.SessionTime(kStart + 10000000000), 10);
  EXPECT_DOUBLE_EQ(clock.SessionTime(kStart + 10000000000 - kMillisecond), 9.999);
}

TEST(SessionClockTest, ALateFrameSpreadsItsSamples) {
  SessionClock clock(kStart, 0.01);
  clock.BeginFrame(clock.NextInputEnd());
  clock.BeginFrame(kStart + 40 * kMillisecond);  // 30 ms of stamps in 10 ms
  EXPECT_NEAR(clock.slip_s(), 0.02, 1e-12);
  EXPECT_DOUBLE_EQ(clock.SessionTime(kStart + 10 * kMillisecond), 0.01);
  EXPECT_DOUBLE_EQ(clock.SessionTime(kStart + 25 * kMillisecond), 0.015);
  EXPECT_DOUBLE_EQ(clock.SessionTime(kStart + 40 * kMillisecond), 0.02);
  EXPECT_EQ(clock.NextInputEnd(), kStart + 50 * kMillisecond);
  EXPECT_EQ(clock.SimulatedStamp(), kStart + 20 * kMillisecond);
}

TEST(SessionClockTest, SessionTimeRisesWithTheStamp) {
  SessionClock clock(kStart, 0.01);
  for (int frame = 0; frame < 20; ++frame) {
    clock.BeginFrame(clock.NextInputEnd() + (frame % 3 == 0 ? 7 * kMillisecond : 0));
  }
  double last = -1;
  for (std::int64_t stamp = kStart - 5 * kMillisecond; stamp < clock.input_end_ns(); stamp += kMillisecond / 3) {
    const double time = clock.SessionTime(stamp);
    EXPECT_GT(time, last);
    last = time;
  }
}

TEST(SessionClockTest, GoesOnAfterAPause) {
  SessionClock clock(kStart, 0.01);
  clock.BeginFrame(clock.NextInputEnd());
  clock.Rebase(kStart + 5000 * kMillisecond);
  EXPECT_EQ(clock.NextInputEnd(), kStart + 5010 * kMillisecond);
  clock.BeginFrame(clock.NextInputEnd());
  EXPECT_DOUBLE_EQ(clock.SessionTime(kStart + 5005 * kMillisecond), 0.015);
}

}  // namespace
}  // namespace meshless_cutting
