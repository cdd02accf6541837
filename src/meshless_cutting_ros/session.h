// A simulation with its number, its clock and the samples that wait: the one path of a frame, for the node, the nodelet
// and `replay`. One thread owns it.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "input_report.h"
#include "message_conversions.h"
#include "pose_sample.h"
#include "session_clock.h"
#include "simulation.h"

namespace meshless_cutting {

/// The messages of one frame. All but `positions` and `statistics` may be absent.
struct FrameMessages {
  SessionInfoConstPtr session;         // only at the start of a session
  SurfaceTopologyConstPtr topology;    // when it changed, and once per simulated second
  SurfacePositionsConstPtr positions;  // belongs to the last topology
  std::vector<CutEventConstPtr> events;
  StepStatisticsConstPtr statistics;  // absent before the first frame
  FrameInputConstPtr input;           // what the frame was made of; absent before the first
};

/// A blade that bends: its polyline from a time on.
struct EdgeSample {
  std::int64_t stamp_ns = 0;
  std::vector<Eigen::Vector3d> points;  // m, tool frame
};

/// A button that switches a blade.
struct ButtonSample {
  std::int64_t stamp_ns = 0;
  bool pressed = false;
};

using InputReports = std::vector<std::shared_ptr<InputReport>>;  // per tool

class Session {
 public:
  enum class WallTimes { kInStatistics, kLeftOut };

  /// Builds the simulation; throws as it does. `reports`, one per tool, take what is wrong with samples.
  Session(const Scene& scene, std::uint32_t number, InputReports reports, WallTimes wall_times,
          const Progress& progress = {});

  /// The start of the session: info, topology and positions as loaded, stamped `stamp_ns`.
  FrameMessages Begin(std::int64_t stamp_ns) const;

  /// Queues a sample (scene frame, stamp not 0) for the frame of its stamp.
  void Add(int tool, const PoseSample& sample);
  void Add(int tool, EdgeSample sample);
  void Add(int tool, const ButtonSample& sample);
  /// Stamp of the earliest sample that waits.
  std::optional<std::int64_t> EarliestWaiting() const;

  bool started() const { return clock_.has_value(); }
  /// Simulated time of the start of the first frame.
  void Start(std::int64_t start_ns);
  /// After a pause: the next frame covers the stamps from `now_ns` on, and the samples of the pause are forgotten.
  void Resume(std::int64_t now_ns);
  /// End of the stamps that the next frame covers when it is on time. Only when started.
  std::int64_t NextInputEnd() const { return clock_->NextInputEnd(); }
  /// One frame with the samples up to `input_end_ns`.
  FrameMessages Step(std::int64_t input_end_ns);
  /// The frame that `input` was written by: the same bits. Frames come in order, from the first of a session on.
  /// Throws std::runtime_error when they do not, or when the message does not fit the scene.
  FrameMessages StepAgain(const FrameInput& input);

  /// What may change at run time, from the next frame on; the scene's at first, and kept by Reset().
  void set_tuning(const Tuning& tuning) { tuning_ = tuning; }
  const Tuning& tuning() const { return tuning_; }
  /// Switches all blades off, whatever their buttons say.
  void set_blades_on(bool on) { blades_on_ = on; }

  /// How positions lie in the messages from now on.
  void set_encoding(PositionEncoding encoding) { encoding_ = encoding; }

  /// Back to the start under a new number; waiting samples are forgotten. A button stays as it was last seen.
  void Reset(std::uint32_t number);

  std::uint32_t number() const { return number_; }
  const Simulation& simulation() const { return simulation_; }
  const InputReports& reports() const { return reports_; }
  /// Simulated time, ns; 0 before the start.
  std::int64_t simulated_stamp() const { return clock_ ? clock_->SimulatedStamp() : 0; }
  double slip_s() const { return clock_ ? clock_->slip_s() : 0; }
  std::uint64_t step() const { return step_; }
  /// Positions published since the session began that were not finite.
  std::uint64_t not_finite() const { return not_finite_; }

 private:
  /// Takes what waits for the frame that ends at `input_end_ns`.
  FrameInputPtr Gather(std::int64_t input_end_ns);
  FrameMessages Make(const FrameInputConstPtr& input);
  void HandOver(const FrameInput& input);
  /// What the button of a tool says at a stamp; takes the button's samples up to it.
  bool BladeOn(int tool, std::int64_t stamp_ns);

  Simulation simulation_;
  std::uint32_t number_;
  InputReports reports_;
  WallTimes wall_times_;
  PositionEncoding encoding_ = PositionEncoding::kFloat32;
  std::optional<SessionClock> clock_;
  std::int64_t resumed_ns_ = 0;  // of the pause since the last frame
  Tuning tuning_;
  bool blades_on_ = true;
  std::uint64_t step_ = 0;
  std::uint64_t frames_per_topology_;  // a bag can be entered anywhere within a second
  std::uint32_t published_version_ = 0;
  std::uint64_t not_finite_ = 0;
  std::vector<std::deque<PoseSample>> waiting_;            // per tool
  std::vector<std::deque<EdgeSample>> waiting_edges_;      // per tool
  std::vector<std::deque<ButtonSample>> waiting_buttons_;  // per tool
  std::vector<bool> blade_on_;                             // per tool: as its button says; true without a button
};

}  // namespace meshless_cutting
