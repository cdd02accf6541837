// A fixture around a running simulator: what it publishes is collected, its services are called.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "messages.h"
#include "strokes.h"

namespace meshless_cutting {

class SimulatorTest : public testing::Test {
 protected:
  SimulatorTest() {
    topology_sub_ = nh_.subscribe<SurfaceTopology>(
        "/simulator/surface/topology", 100, [this](const SurfaceTopologyConstPtr& m) { topologies_.push_back(m); });
    positions_sub_ = nh_.subscribe<SurfacePositions>(
        "/simulator/surface/positions", 1000, [this](const SurfacePositionsConstPtr& m) { positions_.push_back(m); });
    events_sub_ = nh_.subscribe<CutEvent>("/simulator/cut_events", 1000,
                                          [this](const CutEventConstPtr& m) { events_.push_back(m); });
    statistics_sub_ = nh_.subscribe<StepStatistics>(
        "/simulator/statistics", 1000, [this](const StepStatisticsConstPtr& m) { statistics_.push_back(m); });
    session_sub_ =
        nh_.subscribe<SessionInfo>("/simulator/session", 10, [this](const SessionInfoConstPtr& m) { session_ = m; });
    diagnostics_sub_ = nh_.subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", 100, [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& m) {
          for (const auto& status : m->status) {
            for (const auto& value : status.values) diagnostics_[value.key] = value.value;
          }
        });
    EXPECT_TRUE(Until([this] { return session_ && !positions_.empty() && !topologies_.empty(); })) << "the node is up";
    Reset();
  }

  // Spins until it holds. The limit is for what never comes; it says nothing of how fast a machine is.
  static bool Until(const std::function<bool()>& condition, double seconds = 60) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
    while (ros::ok() && ros::WallTime::now() < end) {
      ros::spinOnce();
      if (condition()) return true;
      ros::WallDuration(0.002).sleep();
    }
    return false;
  }

  // Spins until the simulator has made so many frames more, whatever the machine does meanwhile.
  bool Frames(std::size_t count) {
    const std::size_t wanted = statistics_.size() + count;
    return Until([&] { return statistics_.size() >= wanted; });
  }

  template <class Service>
  Service Call(const std::string& name, const typename Service::Request& request = {}) {
    Service service;
    service.request = request;
    EXPECT_TRUE(ros::service::waitForService("/simulator/" + name, 10000));
    EXPECT_TRUE(ros::service::call("/simulator/" + name, service)) << name;
    return service;
  }

  void Reset() {
    const std::uint32_t before = session_ ? session_->session : 0;
    EXPECT_TRUE(Call<std_srvs::Trigger>("reset").response.success);
    EXPECT_TRUE(Until([&] { return session_ && session_->session > before; }));
    Forget();
  }

  void Forget() {
    positions_.clear();
    topologies_.clear();
    events_.clear();
    statistics_.clear();
  }

  void Pause(bool pause) {
    std_srvs::SetBool::Request request;
    request.data = pause;
    EXPECT_TRUE(Call<std_srvs::SetBool>("pause", request).response.success);
  }

  static bool WaitForListener(const ros::Publisher& publisher) {
    return Until([&] { return publisher.getNumSubscribers() > 0; });
  }

  // Plays a stroke in real time.
  template <class Message>
  static void Play(const ros::Publisher& publisher, double x,
                   const std::function<Message(const geometry_msgs::PoseStamped&)>& to) {
    ASSERT_TRUE(WaitForListener(publisher));
    for (const auto& pose : Stroke(ros::Time::now(), x)) {
      ros::Time::sleepUntil(pose.header.stamp);
      publisher.publish(to(pose));
      ros::spinOnce();
    }
  }

  // The same, and waits until the object is in `count` pieces: a frame that is late uses the whole path all the same.
  template <class Message>
  bool Separate(const ros::Publisher& publisher, double x,
                const std::function<Message(const geometry_msgs::PoseStamped&)>& to, std::uint32_t count) {
    Play<Message>(publisher, x, to);
    return Until([&] { return !statistics_.empty() && statistics_.back()->fragments >= count; });
  }

  int Fault(const std::string& name, const std::string& tool = "scalpel") const {
    const auto found = diagnostics_.find(tool + " " + name);
    return found == diagnostics_.end() ? 0 : std::stoi(found->second);
  }

  ros::NodeHandle nh_;
  ros::Subscriber topology_sub_, positions_sub_, events_sub_, statistics_sub_, session_sub_, diagnostics_sub_;
  std::vector<SurfaceTopologyConstPtr> topologies_;
  std::vector<SurfacePositionsConstPtr> positions_;
  std::vector<CutEventConstPtr> events_;
  std::vector<StepStatisticsConstPtr> statistics_;
  SessionInfoConstPtr session_;
  std::map<std::string, std::string> diagnostics_;
};

}  // namespace meshless_cutting
