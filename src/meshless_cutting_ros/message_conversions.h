// From the simulation's values to messages. Free functions: no master, no clock.
#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Polygon.h>
#include <geometry_msgs/Pose.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "messages.h"
#include "position_encoding.h"
#include "simulation.h"

namespace meshless_cutting {

/// What every message of a frame says about where it belongs.
struct FrameTag {
  std::int64_t stamp_ns = 0;  // simulated time
  std::uint32_t session = 0;
  std::uint64_t step = 0;
};

ros::Time ToTime(std::int64_t nanoseconds);
geometry_msgs::Point ToPoint(const Eigen::Vector3d& point);
geometry_msgs::Pose ToPose(const Eigen::Isometry3d& pose);
/// Points of a polygon, m.
std::vector<Eigen::Vector3d> ToPoints(const geometry_msgs::Polygon& polygon);

SurfaceTopologyPtr ToTopology(const Scene& scene, const Surface& surface, const FrameTag& tag);
/// `not_finite` counts the positions that are not, if given.
SurfacePositionsPtr ToPositions(const Scene& scene, const Surface& surface, const FrameTag& tag,
                                PositionEncoding encoding = PositionEncoding::kFloat32, int* not_finite = nullptr);
CutEventPtr ToCutEvent(const Scene& scene, const StrokeEvent& event, const FrameTag& tag);
/// `with_wall_times` false leaves all that depends on the machine at 0.
StepStatisticsPtr ToStatistics(const Scene& scene, const FrameStatistics& statistics, const FrameTag& tag,
                               std::int64_t input_until_ns, bool with_wall_times);
SessionInfoPtr ToSessionInfo(const Simulation& simulation, const FrameTag& tag);

}  // namespace meshless_cutting
