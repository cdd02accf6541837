// Node and replay fed the same samples publish the same positions.
#include <gtest/gtest.h>
#include <meshless_cutting/Step.h>
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <unistd.h>

#include <filesystem>
#include <map>

#include "messages.h"
#include "replay/replay.h"
#include "strokes.h"

namespace meshless_cutting {
namespace {

constexpr char kTopic[] = "/simulator/scalpel/measured_cp";

TEST(SteppedTest, NodeAndReplayAgreeToTheBit) {
  const auto stroke = Stroke(ros::Time(100), 0.0627);

  const std::string folder = testing::TempDir() + "stepped_" + std::to_string(getpid()) + "_";
  rosbag::Bag input(folder + "in.bag", rosbag::bagmode::Write);
  for (const auto& pose : stroke) input.write(kTopic, pose.header.stamp, pose);
  input.close();
  ReplayOptions options;
  options.scene = BlockScene();
  options.input = folder + "in.bag";
  options.output = folder + "out.bag";
  options.name = "/simulator";
  const ReplayResult result = RunReplay(options, [](double, const std::string&) { return true; });
  std::map<std::uint64_t, SurfacePositionsConstPtr> replayed;
  std::map<std::uint64_t, SurfaceTopologyConstPtr> replayed_topologies;
  std::map<std::uint64_t, StepStatisticsConstPtr> replayed_statistics;
  {
    const rosbag::Bag bag(options.output, rosbag::bagmode::Read);
    for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
      if (const auto positions = message.instantiate<SurfacePositions>()) replayed[positions->step] = positions;
      if (const auto topology = message.instantiate<SurfaceTopology>()) replayed_topologies[topology->step] = topology;
      if (const auto statistics = message.instantiate<StepStatistics>())
        replayed_statistics[statistics->step] = statistics;
    }
  }
  std::filesystem::remove(options.input);
  std::filesystem::remove(options.output);
  ASSERT_EQ(replayed.size(), 26u) << result.summary;

  ros::NodeHandle nh;
  std::map<std::uint64_t, SurfacePositionsConstPtr> live;
  std::map<std::uint64_t, SurfaceTopologyConstPtr> topologies;
  std::map<std::uint64_t, StepStatisticsConstPtr> statistics;
  const auto positions_sub = nh.subscribe<SurfacePositions>(
      "/simulator/surface/positions", 1000, [&](const SurfacePositionsConstPtr& m) { live[m->step] = m; });
  const auto topology_sub = nh.subscribe<SurfaceTopology>(
      "/simulator/surface/topology", 1000, [&](const SurfaceTopologyConstPtr& m) { topologies[m->step] = m; });
  const auto statistics_sub = nh.subscribe<StepStatistics>(
      "/simulator/statistics", 1000, [&](const StepStatisticsConstPtr& m) { statistics[m->step] = m; });
  const auto poses = nh.advertise<geometry_msgs::PoseStamped>(kTopic, 1000);
  for (int i = 0; i < 2000 && (poses.getNumSubscribers() == 0 || positions_sub.getNumPublishers() == 0 ||
                               topology_sub.getNumPublishers() == 0 || statistics_sub.getNumPublishers() == 0);
       ++i) {
    ros::WallDuration(0.01).sleep();
  }
  ros::WallDuration(0.5).sleep();
  for (const auto& pose : stroke) poses.publish(pose);
  ros::WallDuration(3).sleep();  // all are in the mailbox
  ASSERT_TRUE(ros::service::waitForService("/simulator/step", 10000));
  Step step;
  step.request.frames = 25;
  ASSERT_TRUE(ros::service::call("/simulator/step", step));
  ASSERT_TRUE(step.response.success) << step.response.message;
  EXPECT_EQ(step.response.stamp, ros::Time(100.5));
  // Topics do not wait for each other.
  const auto all_there = [&] {
    return live.count(25) && statistics.count(25) && topologies.count(replayed_topologies.rbegin()->first);
  };
  for (int i = 0; i < 1000 && !all_there(); ++i) {
    ros::spinOnce();
    ros::WallDuration(0.01).sleep();
  }

  for (std::uint64_t frame = 1; frame <= 25; ++frame) {
    ASSERT_TRUE(live.count(frame)) << frame;
    EXPECT_EQ(live[frame]->header.stamp, replayed[frame]->header.stamp) << frame;
    EXPECT_EQ(live[frame]->version, replayed[frame]->version) << frame;
    EXPECT_TRUE(live[frame]->positions == replayed[frame]->positions) << "frame " << frame;
    ASSERT_TRUE(statistics.count(frame)) << frame;
    EXPECT_EQ(statistics[frame]->links_cut, replayed_statistics[frame]->links_cut) << frame;
    EXPECT_EQ(statistics[frame]->elastic_j, replayed_statistics[frame]->elastic_j) << frame;
    ASSERT_EQ(topologies.count(frame), replayed_topologies.count(frame)) << frame;
    if (!topologies.count(frame)) continue;
    EXPECT_TRUE(topologies[frame]->triangles == replayed_topologies[frame]->triangles) << frame;
    EXPECT_TRUE(topologies[frame]->rest_positions == replayed_topologies[frame]->rest_positions) << frame;
  }
  EXPECT_EQ(statistics[25]->fragments, 2u);
}

}  // namespace
}  // namespace meshless_cutting

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "stepped_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
