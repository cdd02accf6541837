// A tool: screens the pose samples that come in and turns those of one frame into the motion of its blade.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "tool/blade_motion.h"

namespace meshless_cutting {

/// A pose of the tool in the scene frame as it came in. Nothing is assumed of its values.
struct ToolSample {
  double time_s = 0;  // on the clock of the session
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector4d orientation_xyzw = Eigen::Vector4d::UnitW();
  // On the clock of the tool, any origin: when the simulation lags, session time is compressed and would make slow
  // motion look like a jump. Absent: time_s.
  std::optional<double> measured_s = std::nullopt;
  bool blade_on = true;  // false: the tool moves, its blade does not cut
};

/// What became of a sample. Everything but kAccepted and kJump is refused and only counted. A jump is a motion faster
/// than config.max_speed_m_s, over the time since the last sample or over the mean interval of the last hundred if that
/// is longer (stamps that are put on late come in bursts; the hand does not move in bursts); it re-anchors the blade.
enum class SampleVerdict { kAccepted, kNotFinite, kZeroQuaternion, kBackInTime, kDuplicate, kJump };
inline constexpr int kSampleVerdicts = 6;

/// One tool of the scene with its recent past.
class Tool {
 public:
  explicit Tool(const ToolConfig& config);

  /// Queues a sample for the frame in which its time lies. Samples of one tool come in order of time.
  SampleVerdict Add(const ToolSample& sample);

  /// The blade's motion in the frame that covers (t0_s, t1_s]; consumes the samples up to t1_s.
  /// Before the first sample, and when none came for config.timeout_s, the blade is inactive (empty motion). It goes on
  /// from where it was when samples that come late close the gap on the clock of the tool, else anew.
  BladeMotion Move(double t0_s, double t1_s);

  /// A blade that bends: replaces the polyline (tool frame, m) from the next frame on. False (and unchanged) when the
  /// number of points differs or a coordinate is not finite.
  bool SetEdge(const std::vector<Eigen::Vector3d>& points);

  const ToolConfig& config() const { return config_; }
  /// Pose at the end of the last frame; nothing before the first sample.
  const std::optional<Eigen::Isometry3d>& pose() const { return T_WT_; }
  /// Jumps refused during the last Move().
  int jumps() const { return jumps_; }

 private:
  struct Queued {
    double time_s;
    double measured_s;
    Eigen::Isometry3d T_WT;
    bool jump;
    bool blade_on;
  };
  std::vector<Eigen::Vector3d> BladeAt(const Eigen::Isometry3d& T_WT) const;

  ToolConfig config_;
  std::vector<Eigen::Vector3d> edge_;       // polyline, tool frame, m
  std::vector<Eigen::Vector3d> edge_next_;  // what edge_ becomes in the next frame
  std::vector<Queued> queue_;
  std::optional<Queued> newest_;           // last accepted sample, for the screening
  double mean_interval_s_ = 0;             // between samples without a silence between them, over
  int averaged_over_ = 0;                  // so many
  std::optional<Eigen::Isometry3d> T_WT_;  // at the end of the last frame
  std::optional<std::vector<Eigen::Vector3d>>
      blade_;                   // polyline at the end of the last frame while active, scene frame
  double last_sample_s_ = 0;    // session time
  double last_measured_s_ = 0;  // clock of the tool
  int jumps_ = 0;
};

}  // namespace meshless_cutting
