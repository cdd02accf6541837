#include "markers.h"

#include <gtest/gtest.h>

namespace meshless_cutting {
namespace {

TEST(MarkersTest, SurfaceHasAColourPerCornerAndTellsSkinFromCutFace) {
  SurfaceTopology topology;
  topology.triangles = {0, 1, 2, 2, 1, 3};
  topology.region = {SurfaceTopology::SKIN, SurfaceTopology::CUT_FACE};
  SurfacePositions positions;
  positions.header.frame_id = "world";
  positions.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  const auto marker = SurfaceMarker(topology, positions);
  EXPECT_EQ(marker.header.frame_id, "world");
  ASSERT_EQ(marker.points.size(), 6u);
  ASSERT_EQ(marker.colors.size(), 6u);
  EXPECT_EQ(marker.points[5].y, 1);
  EXPECT_GT(marker.colors[5].g, marker.colors[0].g + 0.2f) << "the cut face is lighter";
  EXPECT_GT(marker.colors[0].r, 2 * marker.colors[0].g) << "the skin is red";
}

TEST(MarkersTest, HeldVerticesAreThoseInTheBoxes) {
  Scene scene;
  scene.object.lattice_size_m = 0.01;
  scene.object.fixed = {{{-1, -1, -1}, {0.5, 1, 1}}};
  SurfaceTopology topology;
  topology.rest_positions = {0, 0, 0, 1, 0, 0};
  SurfacePositions positions;
  positions.positions = {7, 0, 0, 8, 0, 0};
  const auto marker = FixedMarker(scene, topology, positions);
  ASSERT_EQ(marker.points.size(), 1u);
  EXPECT_EQ(marker.points[0].x, 7) << "where it is now";
}

TEST(MarkersTest, ToolsAreDrawnOnceTheyHaveAPose) {
  Scene scene;
  scene.frame = "world";
  scene.tools.resize(2);
  scene.tools[0].cutting_edge = {{0, 0, 0}, {0, 0, 0.06}};
  scene.tools[1].cutting_edge = {{0, -1, 0}, {0, 1, 0}};
  EXPECT_TRUE(ToolMarkers(scene, {{}, {}}, ros::Time(1)).empty());
  const ToolView scalpel{Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3)), {{1, 2, 3}, {1, 2, 3.06}}};
  const ToolView resting{Eigen::Isometry3d::Identity(), {}};
  const auto markers = ToolMarkers(scene, {scalpel, resting}, ros::Time(1));
  ASSERT_EQ(markers.size(), 3u) << "body and blade of the scalpel, blade of the other";
  EXPECT_EQ(markers[0].type, visualization_msgs::Marker::MESH_RESOURCE);
  EXPECT_EQ(markers[0].scale.x, 2) << "twice as long as the mesh";
  EXPECT_EQ(markers[1].points.size(), 2u);
  EXPECT_EQ(markers[2].points[0].y, -1) << "inactive: where its pose puts it";
}

TEST(MarkersTest, ObstaclesAreDrawnWhereTheyAre) {
  Scene scene;
  BoxObstacle box;
  box.half_extents = {1, 2, 3};
  PlaneObstacle plane;
  plane.point = {0, 0, -1};
  scene.obstacles = {{box, 0}, {plane, 0}};
  const auto markers = ObstacleMarkers(scene, ros::Time(1));
  ASSERT_EQ(markers.size(), 2u);
  EXPECT_EQ(markers[0].scale.z, 6);
  EXPECT_NEAR(markers[1].pose.position.z + 0.5 * markers[1].scale.z, -1, 1e-12) << "its upper side is the plane";
}

}  // namespace
}  // namespace meshless_cutting
