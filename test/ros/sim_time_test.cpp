// The node under /use_sim_time: it follows /clock, stands when that stands, and begins a new session when it goes back.
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>

#include "messages.h"
#include "strokes.h"

namespace meshless_cutting {
namespace {

class SimTimeTest : public testing::Test {
 protected:
  SimTimeTest()
      : clock_(nh_.advertise<rosgraph_msgs::Clock>("/clock", 10)),
        poses_(nh_.advertise<geometry_msgs::PoseStamped>("/simulator/scalpel/measured_cp", 1000)),
        statistics_sub_(nh_.subscribe<StepStatistics>("/simulator/statistics", 1000,
                                                      [this](const StepStatisticsConstPtr& m) { last_ = m; })) {
    for (int i = 0; i < 2000 && (poses_.getNumSubscribers() == 0 || statistics_sub_.getNumPublishers() == 0); ++i)
      Spin();
    for (int i = 0; i < 2000 && clock_.getNumSubscribers() < 2; ++i) Spin();  // this node and the simulator
  }

  static void Spin() {
    ros::spinOnce();
    ros::WallDuration(0.005).sleep();
  }

  // Plays a stroke with its clock, 200 ticks a second; then `rest_s` without samples.
  void Play(double start_s, double x, double rest_s) {
    for (const auto& pose : Stroke(ros::Time(start_s), x)) {
      rosgraph_msgs::Clock tick;
      tick.clock = pose.header.stamp;
      clock_.publish(tick);
      ros::WallDuration(0.002).sleep();  // a driver publishes after the clock says so
      poses_.publish(pose);
      Spin();
      // A clock that runs away from a simulator that stands still would test the machine.
      for (int i = 0; i < 4000 && last_ && last_->header.stamp + ros::Duration(0.045) < tick.clock; ++i) Spin();
    }
    for (double t = 0; t < rest_s; t += 0.005) {
      rosgraph_msgs::Clock tick;
      tick.clock = ros::Time(start_s + 0.5 + t);
      clock_.publish(tick);
      Spin();
    }
    const ros::Time end(start_s + 0.5 + rest_s - 0.03);
    for (int i = 0; i < 6000 && !(last_ && last_->header.stamp > end); ++i) Spin();
    for (int i = 0; i < 100; ++i) Spin();
  }

  ros::NodeHandle nh_;
  ros::Publisher clock_, poses_;
  ros::Subscriber statistics_sub_;
  StepStatisticsConstPtr last_;
};

TEST_F(SimTimeTest, FollowsTheClockAndRestartsWhenItGoesBack) {
  Play(50, 0.0627, 0.2);
  ASSERT_TRUE(last_);
  EXPECT_EQ(last_->fragments, 2u);
  EXPECT_NEAR(last_->header.stamp.toSec(), 50.7, 0.1);
  const StepStatisticsConstPtr stood = last_;
  for (int i = 0; i < 60; ++i) Spin();
  EXPECT_EQ(last_->step, stood->step) << "the clock stands, the simulation stands";

  Play(50, 0.0627, 0.2);
  EXPECT_EQ(last_->session, stood->session + 1) << "the bag was played again";
  EXPECT_EQ(last_->fragments, 2u);
  EXPECT_NEAR(last_->header.stamp.toSec(), 50.7, 0.1);
}

}  // namespace
}  // namespace meshless_cutting

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "sim_time_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
