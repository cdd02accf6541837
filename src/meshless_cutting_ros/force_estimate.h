// What a hand would feel of a blade: an estimate from what the simulation knows anyway, for haptic devices.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "cut/stroke_event.h"
#include "scene/scene.h"

namespace meshless_cutting {

/// Force and torque on the tool, scene frame; the torque is about the tool's origin.
struct ToolWrench {
  Eigen::Vector3d force_n = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque_nm = Eigen::Vector3d::Zero();
};

/// Two parts, both against the motion:
/// - cutting: new cut face times the toughness is work; divided by the way of the blade it is the force along it;
/// - the flat: the part of the blade inside the tissue, times the stiffness per area, times how far the blade went along
///   its flat's normal since; the tissue gives way with the time constant of `relaxation_s`.
/// The blade of the simulation is an ideal edge, which the tissue does not hold: the estimate is not its reaction.
/// Never more than max_force_n, never rising or turning faster than max_slope_n_s; zero at once when the tool is not
/// trusted.
class ForceEstimate {
 public:
  explicit ForceEstimate(const ForceConfig& config) : config_(config) {}

  struct Frame {
    bool trusted = false;  // running, samples come in, the step was solved
    Eigen::Isometry3d T_WT = Eigen::Isometry3d::Identity();
    std::vector<Eigen::Vector3d> blade;  // scene frame, m; empty while inactive
    std::vector<StrokeEvent> events;     // of this tool in this frame
    double time_step_s = 0;
  };
  ToolWrench Update(const Frame& frame);
  void Reset() { *this = ForceEstimate(config_); }

 private:
  Eigen::Vector3d Wanted(const Frame& frame, const Eigen::Vector3d& way);

  ForceConfig config_;
  bool has_last_ = false;
  Eigen::Vector3d last_middle_ = Eigen::Vector3d::Zero();  // of the blade, m
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();        // given last, N
  double inside_m_ = 0;                                    // blade inside the tissue, as the stroke's events say
  double bend_m_ = 0;                                      // how far the flat has pushed the lips aside
};

}  // namespace meshless_cutting
