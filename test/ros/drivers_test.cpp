// Drivers as they are in the field, and drivers that fail: the node lives, says why, and goes on.
#include <geometry_msgs/PolygonStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/Joy.h>

#include <cmath>
#include <limits>
#include <random>

#include "simulator_fixture.h"

namespace meshless_cutting {
namespace {

using geometry_msgs::PoseStamped;

class DriversTest : public SimulatorTest {
 protected:
  DriversTest() {
    log_sub_ = nh_.subscribe<rosgraph_msgs::Log>("/rosout", 1000, [this](const rosgraph_msgs::Log::ConstPtr& line) {
      if (line->name == "/simulator") log_.push_back(*line);
    });
  }

  bool Logged(const std::string& words) const {
    return std::any_of(log_.begin(), log_.end(),
                       [&](const rosgraph_msgs::Log& line) { return line.msg.find(words) != std::string::npos; });
  }

  int LinksCut() const { return statistics_.empty() ? 0 : static_cast<int>(statistics_.back()->links_cut); }

  ros::Subscriber log_sub_;
  std::vector<rosgraph_msgs::Log> log_;
};

TEST_F(DriversTest, MillimetresOwnClockOwnFrameNoOrientation) {
  const auto poses = nh_.advertise<PoseStamped>("/simulator/omni/pose", 1000);
  const auto as_omni = [](PoseStamped pose) {
    pose.header.stamp = ros::Time(12.5);  // always the same, of a clock that stands
    pose.header.frame_id = "omni_base_that_nobody_knows";
    pose.pose.position.x *= 1000;
    pose.pose.position.z *= 1000;
    pose.pose.orientation = geometry_msgs::Quaternion();  // zeros
    return pose;
  };
  EXPECT_TRUE(Separate<PoseStamped>(poses, 0.0773, as_omni, 2));
}

// A machine that stalls in mid-stroke: what it kept back for longer than timeout_s comes at once.
TEST_F(DriversTest, SamplesThatWereKeptBackCutAllTheSame) {
  const auto stalls = [](const std::function<void(PoseStamped*)>& change) {
    return [change, sent = 0](PoseStamped pose) mutable {
      if (++sent == 50) ros::WallDuration(0.3).sleep();
      change(&pose);
      return pose;
    };
  };
  const auto scalpel = nh_.advertise<PoseStamped>("/simulator/scalpel/measured_cp", 1000);
  EXPECT_TRUE(Separate<PoseStamped>(scalpel, 0.0773, stalls([](PoseStamped*) {}), 2));
  const auto omni = nh_.advertise<PoseStamped>("/simulator/omni/pose", 1000);
  const auto unstamped = stalls([](PoseStamped* pose) {
    pose->header.stamp = ros::Time();
    pose->pose.position.x *= 1000;
    pose->pose.position.z *= 1000;
  });
  EXPECT_TRUE(Separate<PoseStamped>(omni, 0.0477, unstamped, 3));
}

TEST_F(DriversTest, TheBladeCutsOnlyWhileItsButtonIsPressed) {
  const auto joy = nh_.advertise<sensor_msgs::Joy>("/simulator/pedal/joy", 10);
  const auto poses = nh_.advertise<PoseStamped>("/simulator/pedal/measured_cp", 1000);
  ASSERT_TRUE(WaitForListener(joy));
  const auto press = [&](int pressed) {
    sensor_msgs::Joy message;
    message.header.stamp = ros::Time::now();
    message.buttons = {1 - pressed, pressed};
    joy.publish(message);
    ros::Duration(0.05).sleep();
  };
  const auto stroke = [&](double x) { Play<PoseStamped>(poses, x, [](const PoseStamped& pose) { return pose; }); };
  stroke(0.0477);
  EXPECT_TRUE(Frames(40));
  EXPECT_EQ(LinksCut(), 0) << "never pressed";
  press(1);
  EXPECT_TRUE(Separate<PoseStamped>(
      poses, 0.0477, [](const PoseStamped& pose) { return pose; }, 2));
  press(0);
  EXPECT_TRUE(Frames(20));
  const int cut = LinksCut();
  stroke(0.0773);
  EXPECT_TRUE(Frames(40));
  EXPECT_EQ(LinksCut(), cut) << "released";
  sensor_msgs::Joy small;
  small.buttons = {1};
  joy.publish(small);
  EXPECT_TRUE(Until([this] { return Fault("no such button", "pedal") >= 1; }));
}

TEST_F(DriversTest, SaysWhatLooksLikeMillimetres) {
  const auto poses = nh_.advertise<PoseStamped>("/simulator/scalpel/measured_cp", 1000);
  ASSERT_TRUE(WaitForListener(poses));
  PoseStamped pose = BladePose(ros::Time::now(), 143, 0);
  pose.pose.orientation.w = 2;
  poses.publish(pose);
  EXPECT_TRUE(Until([this] { return Logged("|p| = 143 m: looks like millimetres; set position_scale: 0.001"); }));
  EXPECT_TRUE(Until([this] { return Logged("a quaternion of length 2"); }));
}

TEST_F(DriversTest, ADriverThatDiesInMidStrokeLeavesTheCutWhereItWas) {
  const auto poses = nh_.advertise<PoseStamped>("/simulator/scalpel/measured_cp", 1000);
  ASSERT_TRUE(WaitForListener(poses));
  const auto stroke = Stroke(ros::Time::now(), 0.0773);
  for (std::size_t i = 0; i < 45; ++i) {
    ros::Time::sleepUntil(stroke[i].header.stamp);
    poses.publish(stroke[i]);
    ros::spinOnce();
  }
  EXPECT_TRUE(Until([this] { return Logged("scalpel/measured_cp: silent"); }));
  const int cut = LinksCut();
  EXPECT_GT(cut, 0);
  EXPECT_EQ(statistics_.back()->fragments, 1u) << "half through";
  // It comes back at the far side of the block: nothing is cut on the way.
  PoseStamped far = BladePose(ros::Time::now(), 0.0773, -0.03);
  poses.publish(far);
  EXPECT_TRUE(Frames(40));
  EXPECT_EQ(LinksCut(), cut);
  EXPECT_TRUE(Separate<PoseStamped>(
      poses, 0.0773, [](const PoseStamped& pose) { return pose; }, 2))
      << "and goes on";
}

TEST_F(DriversTest, TheHandFeelsAForceThatIsLimitedAndEndsWithTheTrust) {
  std::vector<geometry_msgs::WrenchStamped> wrenches;
  const auto forces = nh_.subscribe<geometry_msgs::WrenchStamped>(
      "/simulator/scalpel/measured_cf", 1000,
      [&](const geometry_msgs::WrenchStamped::ConstPtr& wrench) { wrenches.push_back(*wrench); });
  const auto norm = [](const geometry_msgs::WrenchStamped& wrench) {
    const auto& f = wrench.wrench.force;
    return std::sqrt(f.x * f.x + f.y * f.y + f.z * f.z);
  };
  ASSERT_TRUE(Until([&] { return !wrenches.empty(); }));
  EXPECT_EQ(norm(wrenches.back()), 0);
  const auto poses = nh_.advertise<PoseStamped>("/simulator/scalpel/measured_cp", 1000);
  ASSERT_TRUE(WaitForListener(poses));
  const auto stroke = Stroke(ros::Time::now(), 0.0773);
  std::size_t sent = 0;
  for (; sent < 45; ++sent) {
    ros::Time::sleepUntil(stroke[sent].header.stamp);
    poses.publish(stroke[sent]);
    ros::spinOnce();
  }
  double largest = 0;
  for (const auto& wrench : wrenches) {
    largest = std::max(largest, norm(wrench));
    EXPECT_EQ(wrench.header.frame_id, "world");
    EXPECT_GE(wrench.wrench.force.z, -1e-9) << "against the way down";
  }
  EXPECT_GT(largest, 0.05);
  EXPECT_LE(largest, 2 + 1e-9);
  Pause(true);
  EXPECT_TRUE(Until([&] { return norm(wrenches.back()) == 0; }, 1)) << "zero at the pause";
  Pause(false);
  EXPECT_EQ(std::count_if(events_.begin(), events_.end(), [](const auto& e) { return e->event == CutEvent::STARTED; }),
            1);
}

// One stream: a stroke with faults at random moments.
class HostileStream {
 public:
  HostileStream(unsigned seed, const ros::Publisher& poses, const ros::Publisher& edges)
      : random_(seed), poses_(poses), edges_(edges) {}

  void Play() {
    for (PoseStamped pose : Stroke(ros::Time::now(), 0.03 + 0.05 * Share())) {
      if (Share() < 0.3) Spoil(&pose);
      ros::Time::sleepUntil(std::min(pose.header.stamp, ros::Time::now() + ros::Duration(0.005)));
      for (int copies = Share() < 0.05 ? 50 : 1; copies > 0; --copies) poses_.publish(pose);
      ros::spinOnce();
    }
  }

 private:
  double Share() { return std::uniform_real_distribution<double>(0, 1)(random_); }

  double Evil() {
    const double values[] = {std::nan(""), INFINITY, -INFINITY, 1e308, -1e300, 1e9, 1e-310, 0, 143, -5};
    return values[random_() % 10];
  }

  void Spoil(PoseStamped* pose) {
    auto& p = pose->pose.position;
    auto& q = pose->pose.orientation;
    auto& stamp = pose->header.stamp;
    switch (random_() % 12) {
      case 0:
        p.x = Evil();
        break;
      case 1:
        p.y = Evil(), p.z = Evil();
        break;
      case 2:
        q.x = Evil(), q.w = Evil();
        break;
      case 3:
        q.w = 0;
        break;
      case 4:
        q.z = 1e200;
        break;
      case 5:
        stamp = ros::Time(std::max(0.0, stamp.toSec() + 20 * (Share() - 0.5)));
        break;
      case 6:
        stamp = ros::Time();
        break;
      case 7:
        stamp = ros::TIME_MAX;
        break;
      case 8:
        pose->header.frame_id = random_() % 2 ? "moon" : "/";
        break;
      case 9:
        p.x += 0.5 * Share();
        break;  // a jump
      case 10:
        ros::Duration(0.15 * Share()).sleep();
        break;
      default:
        SpoilEdge();
    }
  }

  void SpoilEdge() {
    geometry_msgs::PolygonStamped edge;
    edge.polygon.points.resize(random_() % 4);
    for (auto& point : edge.polygon.points) point.x = static_cast<float>(Evil());
    edges_.publish(edge);
  }

  std::mt19937 random_;
  const ros::Publisher &poses_, &edges_;
};

TEST_F(DriversTest, TwentyHostileStreams) {
  const auto poses = nh_.advertise<PoseStamped>("/simulator/scalpel/measured_cp", 1000);
  const auto edges = nh_.advertise<geometry_msgs::PolygonStamped>("/simulator/scalpel/edge", 1000);
  ASSERT_TRUE(WaitForListener(poses) && WaitForListener(edges));
  log_.clear();
  for (unsigned seed = 1; seed <= 20; ++seed) {
    HostileStream(seed, poses, edges).Play();
    const std::size_t before = positions_.size();
    ASSERT_TRUE(Until([&] { return positions_.size() > before + 3; })) << "the node goes on; seed " << seed;
  }
  for (const auto& message : positions_) {
    const bool finite = std::all_of(message->positions.begin(), message->positions.end(),
                                    [](float coordinate) { return std::isfinite(coordinate); });
    ASSERT_TRUE(finite) << "step " << message->step;
  }
  EXPECT_TRUE(Until([this] { return Fault("not finite") > 20 && Fault("jump") > 5 && Fault("unknown frame") > 5; }));

  // At most one line a second per cause, on the average over the time of the test.
  std::map<std::string, std::vector<ros::Time>> told;
  int lines = 0;
  for (const rosgraph_msgs::Log& line : log_) {
    if (line.level < rosgraph_msgs::Log::WARN) continue;
    told[line.msg.substr(0, line.msg.find(", ", line.msg.find(": ")))].push_back(line.header.stamp);
    EXPECT_NE(line.msg.find("expected"), std::string::npos) << line.msg;
    ++lines;
  }
  for (const auto& [cause, times] : told) {
    EXPECT_LE(static_cast<double>(times.size()), (times.back() - times.front()).toSec() + 2) << cause;
  }
  EXPECT_GT(lines, 20);

  Reset();
  EXPECT_TRUE(Separate<PoseStamped>(
      poses, 0.0773, [](const PoseStamped& pose) { return pose; }, 2))
      << "a good stroke cuts";
}

}  // namespace
}  // namespace meshless_cutting

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "drivers_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
