// The program `simulator`.
#include <ros/ros.h>

#include <cstdio>
#include <exception>

#include "simulator_ros.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "simulator");
  try {
    const meshless_cutting::SimulatorRos simulator{ros::NodeHandle("~")};
    ros::waitForShutdown();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "simulator: %s\n", error.what());
    return 1;
  }
  return 0;
}
