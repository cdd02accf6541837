#include "frame_clock.h"

#include <cmath>

namespace meshless_cutting {
namespace {

constexpr double kStep_ns = 5e8;
constexpr double kShareFollowed = 0.01;  // of the difference, per call: a time constant of about a second

}  // namespace

FrameClock::FrameClock()
    : steady_start_(ros::SteadyTime::now()), offset_ns_(static_cast<double>(ros::WallTime::now().toNSec())) {}

std::int64_t FrameClock::Now() {
  if (ros::Time::isSimTime()) return static_cast<std::int64_t>(ros::Time::now().toNSec());
  const double elapsed = static_cast<double>((ros::SteadyTime::now() - steady_start_).toNSec());
  const double difference = static_cast<double>(ros::WallTime::now().toNSec()) - (offset_ns_ + elapsed);
  offset_ns_ += std::abs(difference) > kStep_ns ? difference : kShareFollowed * difference;
  return static_cast<std::int64_t>(offset_ns_ + elapsed);
}

}  // namespace meshless_cutting
