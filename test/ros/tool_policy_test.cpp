#include "tool_policy.h"

#include <gtest/gtest.h>

#include <limits>

namespace meshless_cutting {
namespace {

PoseSample Sample() {
  PoseSample sample;
  sample.stamp_ns = 42;
  sample.frame = "omni";
  sample.position_m = {100, 20, -3};
  sample.orientation_xyzw = {0, 1, 0, 0};
  return sample;
}

TEST(ToolPolicyTest, WithoutKeysNothingChanges) {
  PoseSample sample = Sample();
  ApplyPolicy(ToolConfig(), &sample);
  EXPECT_EQ(sample.stamp_ns, 42);
  EXPECT_EQ(sample.frame, "omni");
  EXPECT_EQ(sample.position_m, Sample().position_m);
  EXPECT_EQ(sample.orientation_xyzw, Sample().orientation_xyzw);
}

TEST(ToolPolicyTest, EachKeyDoesWhatItSays) {
  ToolConfig config;
  config.stamp_policy = StampPolicy::kReceipt;
  config.frame_id = "world";
  config.position_scale = 0.001;
  config.position_only = true;
  config.orientation = Eigen::Quaterniond(0.6, 0, 0.8, 0);
  PoseSample sample = Sample();
  ApplyPolicy(config, &sample);
  EXPECT_EQ(sample.stamp_ns, 0) << "to be stamped at receipt";
  EXPECT_EQ(sample.frame, "world");
  EXPECT_TRUE(sample.position_m.isApprox(Eigen::Vector3d(0.1, 0.02, -0.003)));
  EXPECT_EQ(sample.orientation_xyzw, Eigen::Vector4d(0, 0.8, 0, 0.6));
}

TEST(ToolPolicyTest, HintsAtUnits) {
  EXPECT_EQ(UnitHint(143), "|p| = 143 m: looks like millimetres; set position_scale: 0.001");
  EXPECT_EQ(UnitHint(9), "");
  EXPECT_EQ(UnitHint(std::numeric_limits<double>::quiet_NaN()), "");
  EXPECT_NE(UnitHint(1e200).find("not a place in a cell"), std::string::npos);
}

TEST(ToolPolicyTest, ReportsWhatIsOddAndUsed) {
  InputReport report("scalpel", "/scalpel", 2);
  PoseSample sample = Sample();
  ReportOddities(sample, &report);
  sample.orientation_xyzw *= 1.5;
  ReportOddities(sample, &report);
  sample.position_m[0] = std::numeric_limits<double>::quiet_NaN();
  ReportOddities(sample, &report);
  EXPECT_EQ(report.counts()[static_cast<int>(InputFault::kFarAway)], 2u);
  EXPECT_EQ(report.counts()[static_cast<int>(InputFault::kNotUnit)], 1u);
}

TEST(ToolPolicyTest, ButtonsThatAreThere) {
  InputReport report("scalpel", "/scalpel", 2);
  sensor_msgs::Joy joy;
  joy.buttons = {0, 1};
  EXPECT_EQ(ReadButton({"joy", 1}, joy, &report), true);
  EXPECT_EQ(ReadButton({"joy", 0}, joy, &report), false);
  EXPECT_EQ(ReadButton({"joy", 2}, joy, &report), std::nullopt);
  EXPECT_EQ(report.counts()[static_cast<int>(InputFault::kNoButton)], 1u);
}

}  // namespace
}  // namespace meshless_cutting
