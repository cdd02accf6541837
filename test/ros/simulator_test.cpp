// The running node, on the wall clock, with a real master.
#include <dynamic_reconfigure/Reconfigure.h>
#include <gtest/gtest.h>
#include <meshless_cutting/LoadScene.h>
#include <meshless_cutting/SaveSurface.h>
#include <meshless_cutting/Step.h>
#include <ros/ros.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>
#include <unistd.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>

#include "simulator_fixture.h"

namespace meshless_cutting {
namespace {

TEST_F(SimulatorTest, PublishesEveryFrameAndTheTopologyEverySecond) {
  ASSERT_TRUE(Until([this] { return statistics_.size() > 110; })) << "two seconds of frames";
  for (std::size_t i = 1; i < statistics_.size(); ++i) {
    EXPECT_EQ(statistics_[i]->step, statistics_[i - 1]->step + 1);
    EXPECT_NEAR((statistics_[i]->header.stamp - statistics_[i - 1]->header.stamp).toSec(), 0.02, 1e-6);
  }
  EXPECT_LT(std::abs((ros::Time::now() - statistics_.back()->input_until).toSec()), 0.5)
      << "frames take what came in up to the present, however late they are";
  EXPECT_GE(topologies_.size(), 2u);
  for (const auto& position : positions_) {
    bool has_topology = false;
    for (const auto& topology : topologies_) {
      has_topology =
          has_topology || (topology->session == position->session && topology->version == position->version &&
                           topology->header.stamp <= position->header.stamp &&
                           topology->rest_positions.size() == position->positions.size());
    }
    // The topology that was latched before this test began may be the one of the first positions.
    EXPECT_TRUE(has_topology || position->header.stamp < topologies_.front()->header.stamp)
        << "step " << position->step;
  }
}

TEST_F(SimulatorTest, CutsWithPosesAndWithTransforms) {
  const auto poses = nh_.advertise<geometry_msgs::PoseStamped>("/simulator/scalpel/measured_cp", 1000);
  EXPECT_TRUE(Separate<geometry_msgs::PoseStamped>(
      poses, 0.0773, [](const geometry_msgs::PoseStamped& pose) { return pose; }, 2));
  const auto transforms = nh_.advertise<geometry_msgs::TransformStamped>("/simulator/probe/measured_cp", 1000);
  EXPECT_TRUE(Separate<geometry_msgs::TransformStamped>(
      transforms, 0.0477, [](const geometry_msgs::PoseStamped& pose) { return ToTransform(pose); }, 3));
  bool scalpel = false, probe = false;
  for (const auto& event : events_) {
    scalpel = scalpel || (event->tool == "scalpel" && event->event == CutEvent::STARTED);
    probe = probe || (event->tool == "probe" && event->event == CutEvent::STARTED);
  }
  EXPECT_TRUE(scalpel);
  EXPECT_TRUE(probe);
}

TEST_F(SimulatorTest, RefusesCountsAndReportsBadSamples) {
  const auto poses = nh_.advertise<geometry_msgs::PoseStamped>("/simulator/scalpel/measured_cp", 1000);
  ASSERT_TRUE(WaitForListener(poses));
  const auto send = [&](const std::function<void(geometry_msgs::PoseStamped*)>& spoil) {
    geometry_msgs::PoseStamped pose = BladePose(ros::Time::now(), 0.05, 0.2);
    spoil(&pose);
    poses.publish(pose);
    ros::Duration(0.01).sleep();
  };
  send([](auto*) {});
  send([](auto* pose) { pose->pose.position.x = std::numeric_limits<double>::quiet_NaN(); });
  send([](auto* pose) { pose->pose.orientation.w = 0; });
  send([](auto* pose) { pose->header.stamp = pose->header.stamp - ros::Duration(0.5); });
  send([](auto* pose) { pose->header.stamp = ros::Time(12); });
  send([](auto* pose) { pose->header.stamp = pose->header.stamp + ros::Duration(3600); });
  send([](auto* pose) { pose->header.frame_id = "moon"; });
  send([](auto* pose) { pose->pose.position.y = 5; });
  const auto strings = nh_.advertise<std_msgs::String>("/simulator/probe/measured_cp", 10);
  ASSERT_TRUE(WaitForListener(strings));
  strings.publish(std_msgs::String());
  for (const char* fault :
       {"not finite", "zero quaternion", "back in time", "too old", "in the future", "unknown frame", "jump"}) {
    EXPECT_TRUE(Until([&] { return Fault(fault) >= 1; })) << fault;
  }
  EXPECT_TRUE(Until([this] { return diagnostics_.count("probe wrong type") > 0; }));
  EXPECT_TRUE(Until([this] { return diagnostics_["non-finite positions"] == "0"; }));
}

TEST_F(SimulatorTest, StampZeroIsTheTimeOfReceipt) {
  const auto poses = nh_.advertise<geometry_msgs::PoseStamped>("/simulator/scalpel/measured_cp", 1000);
  EXPECT_TRUE(Separate<geometry_msgs::PoseStamped>(
      poses, 0.0627,
      [](geometry_msgs::PoseStamped pose) {
        pose.header.stamp = ros::Time();
        return pose;
      },
      2));
}

TEST_F(SimulatorTest, TakesPosesInAFrameOfTf) {
  const auto tf = nh_.advertise<tf2_msgs::TFMessage>("/tf_static", 10, true);
  tf2_msgs::TFMessage base;
  base.transforms = {ToTransform(BladePose(ros::Time::now(), 0.05, 0), "arm_base")};
  tf.publish(base);
  const auto poses = nh_.advertise<geometry_msgs::PoseStamped>("/simulator/scalpel/measured_cp", 1000);
  ASSERT_TRUE(WaitForListener(poses));
  // The first sample of a foreign frame makes the node listen to tf.
  EXPECT_TRUE(Until([&] {
    geometry_msgs::PoseStamped far = BladePose(ros::Time::now(), 0, 0.3);
    far.header.frame_id = "arm_base";
    poses.publish(far);
    ros::Duration(0.05).sleep();
    return tf.getNumSubscribers() > 0;
  }));
  ros::Duration(0.3).sleep();
  EXPECT_TRUE(Separate<geometry_msgs::PoseStamped>(
      poses, 0.0127,
      [](geometry_msgs::PoseStamped pose) {
        pose.header.frame_id = "arm_base";
        return pose;
      },
      2));
}

TEST_F(SimulatorTest, PausesStepsAndGoesOn) {
  Step::Request one;
  one.frames = 1;
  const auto running = Call<Step>("step", one).response;
  EXPECT_FALSE(running.success);
  EXPECT_NE(running.message.find("expected a paused simulation"), std::string::npos) << running.message;

  Pause(true);
  Until([] { return false; }, 0.3);
  Forget();
  Until([] { return false; }, 0.3);
  EXPECT_TRUE(positions_.empty()) << "nothing moves";
  Step::Request seven;
  seven.frames = 7;
  const auto stepped = Call<Step>("step", seven).response;
  EXPECT_TRUE(stepped.success) << stepped.message;
  EXPECT_TRUE(Until([this] { return positions_.size() == 7; }));
  EXPECT_EQ(positions_.back()->step, stepped.step);
  EXPECT_EQ(positions_.back()->header.stamp, stepped.stamp);
  EXPECT_FALSE(Call<Step>("step", Step::Request()).response.success) << "no frames";
  Pause(false);
  EXPECT_TRUE(Until([this] { return positions_.size() > 20; }));
}

TEST_F(SimulatorTest, ResetStartsANewSession) {
  ASSERT_TRUE(Until([this] { return statistics_.size() > 5; }));
  const std::uint32_t before = session_->session;
  Reset();
  EXPECT_EQ(session_->session, before + 1);
  EXPECT_TRUE(Until([this] { return statistics_.size() > 2; }));
  EXPECT_LE(statistics_.front()->step, 3u);
  EXPECT_EQ(statistics_.back()->session, before + 1);
}

TEST_F(SimulatorTest, LoadsScenesAndKeepsTheOldOneOnAnError) {
  LoadScene::Request bad;
  bad.scene = "/nowhere/scene.yaml";
  const auto refused = Call<LoadScene>("load_scene", bad).response;
  EXPECT_FALSE(refused.success);
  EXPECT_NE(refused.message.find("/nowhere/scene.yaml: no such file"), std::string::npos) << refused.message;
  EXPECT_EQ(refused.session, session_->session);
  Forget();
  EXPECT_TRUE(Until([this] { return positions_.size() > 3; })) << "the old scene runs on";
  LoadScene::Request again;
  const auto loaded = Call<LoadScene>("load_scene", again).response;
  EXPECT_TRUE(loaded.success) << loaded.message;
  EXPECT_EQ(loaded.session, refused.session + 1);
  EXPECT_TRUE(
      Until([&] { return session_->session == loaded.session && positions_.back()->session == loaded.session; }));
}

TEST_F(SimulatorTest, SavesTheSurface) {
  for (const std::string extension : {"obj", "ply", "stl"}) {
    SaveSurface::Request request;
    request.path = testing::TempDir() + "surface_" + std::to_string(getpid()) + "." + extension;
    const auto saved = Call<SaveSurface>("save_surface", request).response;
    EXPECT_TRUE(saved.success) << saved.message;
    EXPECT_GT(saved.triangles, 100u);
    EXPECT_TRUE(std::filesystem::exists(request.path));
    std::filesystem::remove(request.path);
  }
  for (const std::string path : {"relative.obj", "/nowhere/a.obj", "/tmp/surface.xyz"}) {
    SaveSurface::Request request;
    request.path = path;
    const auto refused = Call<SaveSurface>("save_surface", request).response;
    EXPECT_FALSE(refused.success) << path;
    EXPECT_NE(refused.message.find(path), std::string::npos) << refused.message;
  }
}

TEST_F(SimulatorTest, ChangesAtRunTime) {
  const auto set = [&](double gravity_z, bool blades_on) {
    dynamic_reconfigure::Reconfigure service;
    dynamic_reconfigure::DoubleParameter gravity;
    gravity.name = "gravity_z";
    gravity.value = gravity_z;
    dynamic_reconfigure::BoolParameter blades;
    blades.name = "blades_on";
    blades.value = blades_on;
    service.request.config.doubles = {gravity};
    service.request.config.bools = {blades};
    EXPECT_TRUE(ros::service::call("/simulator/set_parameters", service));
    for (const auto& value : service.response.config.doubles) {
      if (value.name == "mass_damping_per_s") {
        EXPECT_EQ(value.value, 1) << "the scene's";
      }
      if (value.name == "gravity_z") return value.value;
    }
    return std::nan("");
  };
  const auto weight = [this] { return statistics_.empty() ? 0 : statistics_.back()->gravity_j; };
  EXPECT_TRUE(Until([&] { return weight() > 0; }));
  EXPECT_EQ(set(0, false), 0);
  EXPECT_TRUE(Until([&] { return weight() == 0; })) << "weightless";
  const auto poses = nh_.advertise<geometry_msgs::PoseStamped>("/simulator/scalpel/measured_cp", 1000);
  const auto same = [](const geometry_msgs::PoseStamped& pose) { return pose; };
  Play<geometry_msgs::PoseStamped>(poses, 0.0773, same);
  EXPECT_TRUE(Frames(40));
  EXPECT_EQ(statistics_.back()->links_cut, 0u) << "blades are off";
  EXPECT_EQ(set(-9.81, true), -9.81);
  EXPECT_TRUE(Until([&] { return weight() != 0; }));
  EXPECT_TRUE(Separate<geometry_msgs::PoseStamped>(poses, 0.0773, same, 2));
}

TEST_F(SimulatorTest, DrawsOnlyForThoseWhoLook) {
  std::map<std::string, int> seen;
  const auto markers = nh_.subscribe<visualization_msgs::Marker>(
      "/simulator/marker", 100, [&](const visualization_msgs::Marker::ConstPtr& m) { ++seen[m->ns]; });
  EXPECT_TRUE(Until([&] { return seen["surface"] > 10 && seen["held"] > 0; }));
  int tools = 0, surfaces = 0;
  const auto surroundings = nh_.subscribe<visualization_msgs::Marker>(
      "/simulator/surroundings", 100, [&](const visualization_msgs::Marker::ConstPtr& m) {
        tools += m->ns == "held";
        surfaces += m->ns == "surface";
      });
  EXPECT_TRUE(Until([&] { return tools > 3; }));
  EXPECT_EQ(surfaces, 0) << "the display plugin draws it";
  int mappings = 0;
  const auto mapping = nh_.subscribe<visualization_msgs::MarkerArray>(
      "/simulator/mapping_marker", 10, [&](const visualization_msgs::MarkerArray::ConstPtr& m) {
        mappings += m->markers.size() == 2 && !m->markers[0].points.empty() && !m->markers[1].points.empty();
      });
  EXPECT_TRUE(Until([&] { return mappings > 2; }));
}

}  // namespace
}  // namespace meshless_cutting

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "simulator_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
