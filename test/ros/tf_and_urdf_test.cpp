// Poses through tf2, cutting edges from a robot description.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tf_poses.h"
#include "urdf_tools.h"

namespace meshless_cutting {
namespace {

geometry_msgs::TransformStamped Transform(const std::string& parent, const std::string& child, double stamp_s,
                                          double x) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.header.stamp = ros::Time(stamp_s);
  transform.child_frame_id = child;
  transform.transform.translation.x = x;
  transform.transform.rotation.z = transform.transform.rotation.w = 0.70710678118654752;  // a quarter turn about z
  return transform;
}

TEST(TfPosesTest, ExpressesSamplesInTheSceneFrame) {
  tf2::BufferCore tf;
  tf.setTransform(Transform("world", "arm", 0, 1), "test", true);
  PoseSample sample;
  sample.frame = "arm";
  sample.stamp_ns = 5;
  sample.position_m = {0, 2, 0};
  ASSERT_TRUE(ExpressIn("world", tf, &sample));
  EXPECT_TRUE(sample.position_m.isApprox(Eigen::Vector3d(-1, 0, 0), 1e-12)) << sample.position_m.transpose();
  EXPECT_NEAR(sample.orientation_xyzw[2], 0.70710678118654752, 1e-12);
  EXPECT_EQ(sample.frame, "world");

  PoseSample lost;
  lost.frame = "moon";
  EXPECT_FALSE(ExpressIn("world", tf, &lost));
  PoseSample unnamed;
  EXPECT_TRUE(ExpressIn("world", tf, &unnamed)) << "no frame is the scene frame";
}

TEST(TfPosesTest, NewestPoseOfATool) {
  tf2::BufferCore tf;
  EXPECT_FALSE(NewestPose("world", "blade", tf));
  tf.setTransform(Transform("world", "blade", 1, 1), "test");
  tf.setTransform(Transform("world", "blade", 2, 3), "test");
  const auto pose = NewestPose("world", "blade", tf);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->stamp_ns, 2000000000);
  EXPECT_EQ(pose->position_m.x(), 3);
}

std::string Urdf(const std::string& more) {
  return R"(<robot name="r"><link name="base"/>
    <link name="box"><collision><origin xyz="0 0 0.1"/><geometry><box size="0.01 0.03 0.002"/></geometry></collision></link>
    <joint name="j" type="fixed"><parent link="base"/><child link="box"/></joint>)" +
         more + "</robot>";
}

TEST(UrdfToolsTest, EdgeOfABoxIsItsLongestCentreLine) {
  const auto edge = EdgeOfLink(Urdf(""), "box");
  ASSERT_EQ(edge.size(), 2u);
  EXPECT_TRUE(edge[0].isApprox(Eigen::Vector3d(0, -0.015, 0.1), 1e-12));
  EXPECT_TRUE(edge[1].isApprox(Eigen::Vector3d(0, 0.015, 0.1), 1e-12));
}

TEST(UrdfToolsTest, ChildrenNamedEdgeComeFirst) {
  const auto edge = EdgeOfLink(Urdf(R"(<link name="box_edge_0"/><link name="box_edge_1"/>
    <joint name="e0" type="fixed"><parent link="box"/><child link="box_edge_0"/><origin xyz="1 0 0"/></joint>
    <joint name="e1" type="fixed"><parent link="box"/><child link="box_edge_1"/><origin xyz="2 0 0"/></joint>)"),
                               "box");
  ASSERT_EQ(edge.size(), 2u);
  EXPECT_EQ(edge[1], Eigen::Vector3d(2, 0, 0));
}

TEST(UrdfToolsTest, SaysWhatIsMissing) {
  for (const auto& [urdf, link] : std::vector<std::pair<std::string, std::string>>{
           {"", "box"}, {"<robot", "box"}, {Urdf(""), "cup"}, {Urdf(""), "base"}}) {
    try {
      EdgeOfLink(urdf, link);
      ADD_FAILURE() << link << " of " << urdf;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()).compare(0, 8, "expected"), 0) << error.what();
    }
  }
}

TEST(UrdfToolsTest, ShippedCellHasAScalpel) {
  std::ifstream stream(MESHLESS_CUTTING_SOURCE_DIR "/urdf/cell.urdf");
  std::ostringstream text;
  text << stream.rdbuf();
  const auto edge = EdgeOfLink(text.str(), "scalpel");
  ASSERT_EQ(edge.size(), 2u);
  EXPECT_TRUE(edge[1].isApprox(Eigen::Vector3d(0, 0, 0.03)));
}

}  // namespace
}  // namespace meshless_cutting
