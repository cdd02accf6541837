// Which stamps belong to which frame.
#pragma once

#include <cstdint>
#include <deque>

namespace meshless_cutting {

/// Frame k of a session covers the simulated time (t_{k-1}, t_k], t_k = k * time_step, and the samples with a stamp in
/// (r_{k-1}, r_k] on the clock of the tools. On time both intervals are equally long, r_k = start + t_k. A frame that
/// comes too late covers a longer interval of stamps: simulated time slips, the tool's path does not. Stamps are ns,
/// session times s from the start of the session.
class SessionClock {
 public:
  SessionClock() = default;
  SessionClock(std::int64_t start_ns, double time_step_s);

  /// r_k of the next frame when it is on time.
  std::int64_t NextInputEnd() const;
  /// Opens the next frame, which covers the stamps up to `input_end_ns` (later than those of the last frame).
  void BeginFrame(std::int64_t input_end_ns);
  /// Continues, after a pause, with a frame that covers the stamps from `input_ns` on.
  void Rebase(std::int64_t input_ns);
  /// Where a stamp lies in session time: monotone, exact to 1 ns while no time slips. Valid up to the end of the open
  /// frame.
  double SessionTime(std::int64_t stamp_ns) const;

  /// Simulated time at the end of the last frame that was begun, on the clock of the tools at the start.
  std::int64_t SimulatedStamp() const { return SimulatedStamp(frame_); }
  std::int64_t SimulatedStamp(std::uint64_t frame) const;
  std::int64_t start_ns() const { return start_ns_; }
  std::int64_t input_end_ns() const { return knots_.back().input_ns; }
  /// How far simulated time is behind the clock of the tools, s.
  double slip_s() const;

 private:
  struct Knot {
    std::int64_t input_ns;
    std::int64_t session_ns;
  };

  double time_step_s_ = 0;
  std::int64_t start_ns_ = 0;
  std::uint64_t frame_ = 0;
  std::deque<Knot> knots_ = {
      {0, 0}};  // ends of the last frames: late samples are mapped as their frame would have been
};

}  // namespace meshless_cutting
