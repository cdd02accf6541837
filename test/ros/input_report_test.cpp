#include "input_report.h"

#include <gtest/gtest.h>

namespace meshless_cutting {
namespace {

TEST(InputReportTest, SaysEachFaultOnceWithItsCount) {
  InputReport report("scalpel", "/arm/measured_cp", 2);
  EXPECT_TRUE(report.TakeLines().empty());
  report.Count(InputFault::kNotFinite, "position (nan, 0, 0) m");
  report.Count(InputFault::kNotFinite, "position (0, inf, 0) m");
  report.Count(InputFault::kJump, "position (9, 0, 0) m");
  const auto lines = report.TakeLines();
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NE(lines[0].find("/arm/measured_cp: not finite, 2 samples, last: position (0, inf, 0) m; expected"),
            std::string::npos)
      << lines[0];
  EXPECT_NE(lines[1].find("at most 2 m/s"), std::string::npos) << lines[1];
  EXPECT_TRUE(report.TakeLines().empty()) << "told once";
  EXPECT_EQ(report.counts()[static_cast<int>(InputFault::kNotFinite)], 2u) << "but not forgotten";
}

TEST(InputReportTest, EveryFaultHasNameAndRemedy) {
  InputReport report("a", "/b", 1);
  for (int fault = 0; fault < kInputFaults; ++fault) report.Count(static_cast<InputFault>(fault), "x");
  const auto lines = report.TakeLines();
  ASSERT_EQ(lines.size(), static_cast<std::size_t>(kInputFaults));
  for (const std::string& line : lines) {
    EXPECT_NE(line.find("expected"), std::string::npos) << line;
    EXPECT_EQ(line.find("unknown,"), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

TEST(InputReportTest, EveryVerdictIsAFault) {
  for (int verdict = 1; verdict < kSampleVerdicts; ++verdict) {
    EXPECT_NO_THROW(FaultOf(static_cast<SampleVerdict>(verdict)));
  }
  EXPECT_THROW(FaultOf(SampleVerdict::kAccepted), std::logic_error);
}

}  // namespace
}  // namespace meshless_cutting
