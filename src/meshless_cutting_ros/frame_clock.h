// What time it is for the loop that makes frames.
#pragma once

#include <ros/time.h>

#include <cstdint>

namespace meshless_cutting {

/// ROS time as ns. With /use_sim_time that of /clock; else a steady clock that follows the system's slowly, so that a
/// small correction by NTP neither stretches nor doubles a frame. A correction above 0.5 s is followed at once.
class FrameClock {
 public:
  FrameClock();
  std::int64_t Now();
  /// With /use_sim_time before the first /clock there is no time.
  bool valid() const { return ros::Time::isValid(); }

 private:
  ros::SteadyTime steady_start_;
  double offset_ns_;  // ROS time at steady_start_
};

}  // namespace meshless_cutting
