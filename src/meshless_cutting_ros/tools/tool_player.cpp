// The program `tool_player`: a scripted tool driver. Way-points in a file become a topic of poses at the rate of a
// device, or a bag of them without any master.
#include <geometry_msgs/PoseStamped.h>
#include <ros/ros.h>
#include <rosbag/bag.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "message_conversions.h"
#include "replay/temporary_file.h"
#include "scene_loading.h"
#include "tools/tool_path.h"
#include "topics.h"

namespace meshless_cutting {
namespace {

constexpr char kUsage[] =
    "usage: tool_player _path:=STROKES.yaml [_topic:=T] [_rate:=500] [_loop:=false] [_listeners:=1]   plays on a topic\n"
    "       tool_player --path STROKES.yaml --bag OUT.bag [--topic T] [--rate 500]                    writes a bag; no "
    "master\n"
    "\n"
    "STROKES.yaml: tool_path_version: 1, frame, waypoints of {time_s, position_m, orientation_xyzw or z_axis and "
    "x_axis}.\n"
    "The topic defaults to /simulator/scalpel/measured_cp. The path begins when so many nodes listen.\n";

geometry_msgs::PoseStamped Sample(const ToolPath& path, double path_s, ros::Time stamp) {
  geometry_msgs::PoseStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = path.frame();
  message.pose = ToPose(path.At(path_s));
  return message;
}

int SampleCount(const ToolPath& path, double rate) {
  return static_cast<int>(std::floor((path.end_s() - path.start_s()) * rate)) + 1;
}

double CheckedRate(double rate) {
  if (!(rate > 0 && rate <= 10000))
    throw std::runtime_error("rate: " + std::to_string(rate) + ": expected above 0, at most 10000 Hz");
  return rate;
}

std::string DefaultTopic() { return std::string(kDefaultSimulatorName) + "/scalpel/measured_cp"; }

// Stamps begin at 1 s: 0 means "not stamped".
void WriteBag(const ToolPath& path, const std::string& file, const std::string& topic, double rate) {
  TemporaryFile part(file + ".part");
  rosbag::Bag bag(part.path().string(), rosbag::bagmode::Write);
  const int samples = SampleCount(path, rate);
  for (int i = 0; i < samples; ++i) {
    const ros::Time stamp = ros::Time(1) + ros::Duration(i / rate);
    bag.write(topic, stamp, Sample(path, path.start_s() + i / rate, stamp));
  }
  bag.close();
  part.RenameTo(file);
  std::printf("%s: %d poses on %s, %.3f s\n", file.c_str(), samples, topic.c_str(), path.end_s() - path.start_s());
}

int RunWithoutMaster(const std::vector<std::string>& arguments) {
  std::map<std::string, std::string> values = {
      {"--path", ""}, {"--bag", ""}, {"--topic", DefaultTopic()}, {"--rate", "500"}};
  for (std::size_t i = 0; i < arguments.size(); i += 2) {
    if (!values.count(arguments[i]) || i + 1 == arguments.size()) {
      throw std::runtime_error(arguments[i] + ": expected --path, --bag, --topic or --rate, each with a value");
    }
    values[arguments[i]] = arguments[i + 1];
  }
  if (values["--path"].empty() || values["--bag"].empty())
    throw std::runtime_error("expected --path and --bag; see --help");
  const double rate = CheckedRate(std::strtod(values["--rate"].c_str(), nullptr));
  WriteBag(ReadToolPath(ResourcePath(values["--path"])), values["--bag"], values["--topic"], rate);
  return 0;
}

int RunAsNode() {
  ros::NodeHandle nh("~");
  std::string file;
  if (!nh.getParam("path", file)) throw std::runtime_error("parameter ~path: missing; expected a file of way-points");
  const ToolPath path = ReadToolPath(ResourcePath(file));
  const double rate = CheckedRate(nh.param("rate", 500.0));
  const std::string topic = nh.param<std::string>("topic", DefaultTopic());
  ros::Publisher publisher = nh.advertise<geometry_msgs::PoseStamped>(topic, 1000);
  const int listeners = nh.param("listeners", 1);
  if (listeners > 0) ROS_INFO("waiting for %d listeners on %s", listeners, publisher.getTopic().c_str());
  while (ros::ok() && static_cast<int>(publisher.getNumSubscribers()) < listeners) ros::WallDuration(0.05).sleep();
  ros::Time::waitForValid();
  const int samples = SampleCount(path, rate);
  do {
    ROS_INFO("playing %s: %.1f s", file.c_str(), path.end_s() - path.start_s());
    const ros::Time start = ros::Time::now();
    for (int i = 0; i < samples && ros::ok(); ++i) {
      // Stamps lie on the grid of the rate whatever the machine does meanwhile: two plays are the same strokes.
      const ros::Time stamp = start + ros::Duration(i / rate);
      ros::Time::sleepUntil(stamp);
      publisher.publish(Sample(path, path.start_s() + i / rate, stamp));
    }
  } while (ros::ok() && nh.param("loop", false));
  ros::WallDuration(0.5).sleep();  // the last poses are still on their way
  return 0;
}

int Main(int argc, char** argv) {
  const std::vector<std::string> given(argv + 1, argv + argc);
  for (const std::string& argument : given) {
    if (argument == "--help" || argument == "-h") {
      std::fputs(kUsage, stdout);
      return 0;
    }
  }
  if (!given.empty() && given.front().compare(0, 2, "--") == 0) return RunWithoutMaster(given);
  ros::init(argc, argv, "tool_player");
  return RunAsNode();
}

}  // namespace
}  // namespace meshless_cutting

int main(int argc, char** argv) {
  try {
    return meshless_cutting::Main(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tool_player: %s\n", error.what());
    return 1;
  }
}
