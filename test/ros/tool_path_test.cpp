#include "tools/tool_path.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace meshless_cutting {
namespace {

TEST(ToolPathTest, PassesThroughItsWayPointsWithoutOvershoot) {
  const ToolPath path("world", {{0, {0, 0, 0}, Eigen::Quaterniond::Identity()},
                                {1, {1, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ()))},
                                {2, {1, 1, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(2, Eigen::Vector3d::UnitZ()))}});
  EXPECT_TRUE(path.At(1).translation().isApprox(Eigen::Vector3d(1, 0, 0)));
  EXPECT_NEAR(path.At(1).linear()(0, 0), std::cos(1), 1e-12);
  EXPECT_TRUE(path.At(9).translation().isApprox(Eigen::Vector3d(1, 1, 0)));
  Eigen::Vector3d last = path.At(0).translation();
  for (double t = 0; t <= 2; t += 0.01) {
    const Eigen::Vector3d p = path.At(t).translation();
    EXPECT_LE(p.x(), 1 + 1e-12);
    EXPECT_LT((p - last).norm(), 0.02) << "no jump at " << t;
    EXPECT_NEAR(path.At(t).linear().determinant(), 1, 1e-12);
    last = p;
  }
}

class ToolPathFileTest : public testing::Test {
 protected:
  std::string Error(const std::string& text) const {
    std::ofstream(file_) << text;
    try {
      ReadToolPath(file_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  ~ToolPathFileTest() override { std::filesystem::remove(file_); }
  const std::string file_ = testing::TempDir() + "tool_path_" + std::to_string(getpid()) + ".yaml";
};

TEST_F(ToolPathFileTest, ReadsAxesAndQuaternions) {
  std::ofstream(file_) << "tool_path_version: 1\nframe: table\nwaypoints:\n"
                          "  - {time_s: 0, position_m: [0, 0, 1], orientation_xyzw: [0, 0, 0, 1]}\n"
                          "  - {time_s: 2, position_m: [0, 0, 0], z_axis: [0, 1, 0], x_axis: [1, 1, 0]}\n";
  const ToolPath path = ReadToolPath(file_);
  EXPECT_EQ(path.frame(), "table");
  EXPECT_TRUE(path.At(2).linear().col(2).isApprox(Eigen::Vector3d(0, 1, 0)));
  EXPECT_TRUE(path.At(2).linear().col(0).isApprox(Eigen::Vector3d(1, 0, 0))) << "made orthogonal";
}

TEST_F(ToolPathFileTest, RefusesWhatIsWrong) {
  const std::string head =
      "tool_path_version: 1\nwaypoints:\n  - {time_s: 0, position_m: [0, 0, 1], orientation_xyzw: [0, 0, 0, 1]}\n";
  EXPECT_NE(Error(head).find(":2: key `waypoints`: "), std::string::npos)
      << "one way-point is no path: " << Error(head);
  EXPECT_NE(Error(head + "  - {time_s: 0, position_m: [0, 0, 1], orientation_xyzw: [0, 0, 0, 1]}\n")
                .find(":4: key `waypoints[1].time_s`: 0: expected a time after"),
            std::string::npos);
  EXPECT_NE(Error(head + "  - {time_s: 1, position_m: [0, 0, 1], z_axis: [0, 0, 1], x_axis: [0, 0, 2]}\n")
                .find("across z_axis"),
            std::string::npos);
  EXPECT_NE(Error(head + "  - {time_s: 1, position: [0, 0, 1]}\n").find("expected `position_m`?"), std::string::npos);
}

TEST(ShippedToolPathsTest, EveryOneReads) {
  int paths = 0;
  for (const auto& entry : std::filesystem::directory_iterator(MESHLESS_CUTTING_SOURCE_DIR "/launch")) {
    if (entry.path().extension() != ".yaml") continue;
    std::ifstream stream(entry.path());
    const std::string text((std::istreambuf_iterator<char>(stream)), {});
    if (text.find("tool_path_version") == std::string::npos) continue;
    ++paths;
    EXPECT_NO_THROW(ReadToolPath(entry.path())) << entry.path();
  }
  EXPECT_GE(paths, 1);
}

}  // namespace
}  // namespace meshless_cutting
