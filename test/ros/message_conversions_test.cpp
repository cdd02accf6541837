#include "message_conversions.h"

#include <gtest/gtest.h>

#include <limits>

#include "pose_sample.h"

namespace meshless_cutting {
namespace {

Scene SmallScene() {
  Scene scene;
  scene.frame = "cell";
  scene.object.name = "thing";
  scene.time_step_s = 0.01;
  scene.tools.resize(2);
  scene.tools[1].name = "knife";
  return scene;
}

Surface SmallSurface() {
  Surface surface;
  surface.version = 7;
  surface.triangles = {{0, 1, 2}, {2, 1, 3}};
  surface.region = {SurfaceRegion::kSkin, SurfaceRegion::kCutFace};
  surface.fragment = {0, 1};
  surface.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5}};
  surface.positions = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1.5}};
  return surface;
}

const FrameTag kTag{1500000000, 3, 42};

TEST(MessageConversionsTest, Topology) {
  const auto message = ToTopology(SmallScene(), SmallSurface(), kTag);
  EXPECT_EQ(message->header.stamp, ros::Time(1, 500000000));
  EXPECT_EQ(message->header.frame_id, "cell");
  EXPECT_EQ(message->object, "thing");
  EXPECT_EQ(message->session, 3u);
  EXPECT_EQ(message->version, 7u);
  EXPECT_EQ(message->step, 42u);
  EXPECT_EQ(message->triangles, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3}));
  EXPECT_EQ(message->region, (std::vector<std::uint8_t>{SurfaceTopology::SKIN, SurfaceTopology::CUT_FACE}));
  EXPECT_EQ(message->fragment, (std::vector<std::uint32_t>{0, 1}));
  ASSERT_EQ(message->rest_positions.size(), 12u);
  EXPECT_EQ(message->rest_positions[11], 0.5f);
}

TEST(MessageConversionsTest, PositionsAndHowManyAreNotFinite) {
  Surface surface = SmallSurface();
  int not_finite = -1;
  const auto message = ToPositions(SmallScene(), surface, kTag, PositionEncoding::kFloat32, &not_finite);
  EXPECT_EQ(not_finite, 0);
  EXPECT_EQ(message->version, 7u);
  ASSERT_EQ(message->positions.size(), 12u);
  EXPECT_EQ(message->positions[11], 1.5f);
  surface.positions[2].y() = std::numeric_limits<double>::quiet_NaN();
  ToPositions(SmallScene(), surface, kTag, PositionEncoding::kFloat32, &not_finite);
  EXPECT_EQ(not_finite, 1);
}

TEST(MessageConversionsTest, CutEvents) {
  StrokeEvent event;
  event.type = StrokeEventType::kSeparated;
  event.tool = 1;
  event.stroke = 2;
  event.links_cut = 5;
  event.area_m2 = 0.25;
  event.length_m = 0.5;
  event.depth_m = 0.125;
  event.points = {{1, 2, 3}};
  event.rest_points = {{4, 5, 6}};
  event.fragment_volume_m3 = {2, 1};
  const auto message = ToCutEvent(SmallScene(), event, kTag);
  EXPECT_EQ(message->event, CutEvent::SEPARATED);
  EXPECT_EQ(message->tool, "knife");
  EXPECT_EQ(message->stroke, 2u);
  EXPECT_EQ(message->links_cut, 5u);
  EXPECT_EQ(message->area_m2, 0.25);
  EXPECT_EQ(message->length_m, 0.5);
  EXPECT_EQ(message->depth_m, 0.125);
  ASSERT_EQ(message->points.size(), 1u);
  EXPECT_EQ(message->points[0].z, 3);
  EXPECT_EQ(message->rest_points[0].x, 4);
  EXPECT_EQ(message->fragments, 2u);
  EXPECT_EQ(message->fragment_volume_m3, (std::vector<double>{2, 1}));
}

TEST(MessageConversionsTest, EventNumbersAreThoseOfTheMessage) {
  EXPECT_EQ(static_cast<int>(StrokeEventType::kStarted), CutEvent::STARTED);
  EXPECT_EQ(static_cast<int>(StrokeEventType::kProgress), CutEvent::PROGRESS);
  EXPECT_EQ(static_cast<int>(StrokeEventType::kEnded), CutEvent::ENDED);
  EXPECT_EQ(static_cast<int>(StrokeEventType::kSeparated), CutEvent::SEPARATED);
  EXPECT_EQ(static_cast<int>(StrokeEventType::kJumpRefused), CutEvent::JUMP_REFUSED);
  EXPECT_EQ(static_cast<std::uint32_t>(kStepNotConverged), StepStatistics::NOT_CONVERGED);
  EXPECT_EQ(static_cast<std::uint32_t>(kStepRolledBack), StepStatistics::ROLLED_BACK);
  EXPECT_EQ(static_cast<std::uint32_t>(kStepFrozen), StepStatistics::FROZEN);
  EXPECT_EQ(static_cast<int>(SurfaceRegion::kCutFace), SurfaceTopology::CUT_FACE);
}

TEST(MessageConversionsTest, StatisticsWithAndWithoutWallTimes) {
  FrameStatistics statistics;
  statistics.total_s = 0.02;
  statistics.cut_s = 0.001;
  statistics.particles = 11;
  statistics.elastic_j = 1.5;
  statistics.status = kStepNotConverged;
  const auto timed = ToStatistics(SmallScene(), statistics, kTag, 99, true);
  EXPECT_EQ(timed->total_s, 0.02);
  EXPECT_EQ(timed->deadline_s, 0.01);
  EXPECT_TRUE(timed->missed);
  EXPECT_EQ(timed->particles, 11u);
  EXPECT_EQ(timed->elastic_j, 1.5);
  EXPECT_EQ(timed->status, StepStatistics::NOT_CONVERGED);
  EXPECT_EQ(timed->input_until, ros::Time(0, 99));
  const auto untimed = ToStatistics(SmallScene(), statistics, kTag, 99, false);
  EXPECT_EQ(untimed->total_s, 0);
  EXPECT_EQ(untimed->cut_s, 0);
  EXPECT_FALSE(untimed->missed);
  EXPECT_EQ(untimed->particles, 11u);
}

TEST(PoseSampleTest, PoseAndTransformAreTheSame) {
  geometry_msgs::PoseStamped pose;
  pose.header.stamp = ros::Time(5, 7);
  pose.header.frame_id = "/base";
  pose.pose.position.x = 1;
  pose.pose.position.z = 3;
  pose.pose.orientation.w = 0.5;
  pose.pose.orientation.y = -0.5;
  geometry_msgs::TransformStamped transform;
  transform.header = pose.header;
  transform.transform.translation.x = 1;
  transform.transform.translation.z = 3;
  transform.transform.rotation = pose.pose.orientation;
  for (const PoseSample& sample : {FromMessage(pose), FromMessage(transform)}) {
    EXPECT_EQ(sample.stamp_ns, 5000000007);
    EXPECT_EQ(sample.frame, "base") << "without its slash";
    EXPECT_EQ(sample.position_m, Eigen::Vector3d(1, 0, 3));
    EXPECT_EQ(sample.orientation_xyzw, Eigen::Vector4d(0, -0.5, 0, 0.5)) << "as it came, not normalised";
  }
}

}  // namespace
}  // namespace meshless_cutting
