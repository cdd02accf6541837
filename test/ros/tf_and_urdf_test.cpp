// Poses through tf2, cutting edges from a robot description.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "scene_loading.h"
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

constexpr char kCell[] = R"(<robot name="cell"><link name="world"/><link name="table">
  <collision><origin xyz="0 0 -0.02"/><geometry><box size="0.8 0.6 0.04"/></geometry></collision>
  <collision><origin xyz="0.3 0 0.1" rpy="0 0 1.5707963"/><geometry><box size="0.1 0.2 0.3"/></geometry></collision></link>
  <joint name="j" type="fixed"><parent link="world"/><child link="table"/><origin xyz="0 0 -0.12"/></joint>
  <link name="ball"><collision><geometry><sphere radius="1"/></geometry></collision></link>
  <joint name="k" type="fixed"><parent link="table"/><child link="ball"/></joint>
  <link name="arm"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="table"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit effort="1" velocity="1" lower="-1" upper="1"/></joint></robot>)";

TEST(UrdfToolsTest, CollisionBoxesOfALink) {
  const auto boxes = CollisionBoxes(kCell, "table", "world");
  ASSERT_EQ(boxes.size(), 2u);
  EXPECT_TRUE(boxes[0].half_extents.isApprox(Eigen::Vector3d(0.4, 0.3, 0.02)));
  EXPECT_TRUE(boxes[0].T_WB.translation().isApprox(Eigen::Vector3d(0, 0, -0.14)));
  EXPECT_TRUE((boxes[1].T_WB.linear() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-6));
  EXPECT_TRUE(CollisionBoxes(kCell, "table", "table")[0].T_WB.translation().isApprox(Eigen::Vector3d(0, 0, -0.02)));
  const auto error = [](const std::string& link, const std::string& frame, const std::string& urdf = kCell) {
    try {
      CollisionBoxes(urdf, link, frame);
    } catch (const std::runtime_error& caught) {
      return std::string(caught.what());
    }
    return std::string();
  };
  EXPECT_NE(error("ball", "world").find("expected boxes as collision shapes"), std::string::npos);
  EXPECT_NE(error("arm", "world").find("`shoulder` moves"), std::string::npos);
  EXPECT_NE(error("world", "world").find("has none"), std::string::npos);
  EXPECT_NE(error("table", "moon").find("expected a link of the robot description `cell`: moon"), std::string::npos);
  EXPECT_NE(error("table", "world", "").find("expected a robot description"), std::string::npos);
}

TEST(UrdfToolsTest, TheScenesOfTheArmsFitTheirCell) {
  std::ifstream stream(MESHLESS_CUTTING_SOURCE_DIR "/urdf/two_arm_cell.urdf");
  std::ostringstream urdf;
  urdf << stream.rdbuf();
  const Scene scene = LoadSceneFile(MESHLESS_CUTTING_SOURCE_DIR "/launch/arms.yaml", urdf.str());
  ASSERT_EQ(scene.tools.size(), 2u);
  for (const ToolConfig& tool : scene.tools) {
    ASSERT_EQ(tool.cutting_edge.size(), 2u) << tool.name;
    EXPECT_NEAR((tool.cutting_edge[1] - tool.cutting_edge[0]).norm(), 0.03, 1e-12);
  }
  EXPECT_TRUE(scene.link_obstacles.empty());
  EXPECT_GE(scene.obstacles.size(), 2u) << "the tray and the table of the cell";
}

}  // namespace
}  // namespace meshless_cutting
