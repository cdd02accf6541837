#include "frame_input.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "message_conversions.h"

namespace meshless_cutting {

std::int64_t ToNanoseconds(const ros::Time& time) { return static_cast<std::int64_t>(time.toNSec()); }

void AddSample(int tool, const PoseSample& sample, bool blade_on, FrameInput* input) {
  input->sample_tool.push_back(static_cast<std::uint8_t>(tool));
  input->sample_stamp.push_back(ToTime(sample.stamp_ns));
  input->sample_blade_on.push_back(blade_on);
  for (int i = 0; i < 3; ++i) input->sample_pose.push_back(sample.position_m[i]);
  for (int i = 0; i < 4; ++i) input->sample_pose.push_back(sample.orientation_xyzw[i]);
}

PoseSample SampleOf(const FrameInput& input, std::size_t index) {
  PoseSample sample;
  sample.stamp_ns = ToNanoseconds(input.sample_stamp[index]);
  const double* pose = &input.sample_pose[7 * index];
  sample.position_m = {pose[0], pose[1], pose[2]};
  sample.orientation_xyzw = {pose[3], pose[4], pose[5], pose[6]};
  return sample;
}

void AddEdge(int tool, const std::vector<Eigen::Vector3d>& points, FrameInput* input) {
  input->edge_tool.push_back(static_cast<std::uint8_t>(tool));
  input->edge_size.push_back(static_cast<std::uint32_t>(points.size()));
  for (const Eigen::Vector3d& point : points) {
    input->edge_points.insert(input->edge_points.end(), point.data(), point.data() + 3);
  }
}

std::vector<Eigen::Vector3d> EdgeOf(const FrameInput& input, std::size_t index, std::size_t* point) {
  std::vector<Eigen::Vector3d> points(input.edge_size[index]);
  for (Eigen::Vector3d& p : points) {
    p = Eigen::Map<const Eigen::Vector3d>(&input.edge_points[3 * *point]);
    ++*point;
  }
  return points;
}

void SetTuning(const Tuning& tuning, FrameInput* input) {
  input->gravity_m_s2.x = tuning.gravity_m_s2.x();
  input->gravity_m_s2.y = tuning.gravity_m_s2.y();
  input->gravity_m_s2.z = tuning.gravity_m_s2.z();
  input->mass_damping_per_s = tuning.damping.mass_per_s;
  input->stiffness_damping_s = tuning.damping.stiffness_s;
  input->newton_iterations = static_cast<std::uint32_t>(tuning.newton_iterations);
}

Tuning TuningOf(const FrameInput& input) {
  const auto& g = input.gravity_m_s2;
  return {{g.x, g.y, g.z},
          {input.mass_damping_per_s, input.stiffness_damping_s},
          static_cast<int>(input.newton_iterations)};
}

std::string CheckFrameInput(const FrameInput& input, const Scene& scene) {
  const std::string where = "frame " + std::to_string(input.step) + ": ";
  const std::size_t samples = input.sample_tool.size();
  if (input.sample_stamp.size() != samples || input.sample_blade_on.size() != samples ||
      input.sample_pose.size() != 7 * samples) {
    return where + "lists of samples differ in length; expected an intact FrameInput";
  }
  const std::size_t points = std::accumulate(input.edge_size.begin(), input.edge_size.end(), std::size_t{0});
  if (input.edge_size.size() != input.edge_tool.size() || input.edge_points.size() != 3 * points) {
    return where + "lists of edges differ in length; expected an intact FrameInput";
  }
  for (const auto& tools : {input.sample_tool, input.edge_tool}) {
    for (const std::uint8_t tool : tools) {
      if (tool >= scene.tools.size()) {
        return where + "tool " + std::to_string(tool) + "; expected one of the " + std::to_string(scene.tools.size()) +
               " tools of " + scene.file.string();
      }
    }
  }
  const Tuning tuning = TuningOf(input);
  const bool finite = tuning.gravity_m_s2.allFinite() && std::isfinite(tuning.damping.mass_per_s) &&
                      std::isfinite(tuning.damping.stiffness_s);
  if (!finite || tuning.newton_iterations < 1) return where + "parameters out of range";
  return {};
}

}  // namespace meshless_cutting
