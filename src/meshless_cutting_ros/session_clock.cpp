#include "session_clock.h"

#include <algorithm>
#include <cmath>

namespace meshless_cutting {
namespace {

// Samples that are later than this many frames are old whatever frame they are put in.
constexpr std::size_t kKnots = 64;

}  // namespace

SessionClock::SessionClock(std::int64_t start_ns, double time_step_s)
    : time_step_s_(time_step_s), start_ns_(start_ns), knots_{{start_ns, 0}} {}

std::int64_t SessionClock::SimulatedStamp(std::uint64_t frame) const {
  return start_ns_ + std::llround(static_cast<double>(frame) * time_step_s_ * 1e9);
}

double SessionClock::slip_s() const {
  return 1e-9 * static_cast<double>(knots_.back().input_ns - start_ns_ - knots_.back().session_ns);
}

std::int64_t SessionClock::NextInputEnd() const {
  const Knot& last = knots_.back();
  return last.input_ns + (SimulatedStamp(frame_ + 1) - start_ns_ - last.session_ns);
}

void SessionClock::BeginFrame(std::int64_t input_end_ns) {
  ++frame_;
  knots_.push_back({std::max(input_end_ns, knots_.back().input_ns + 1), SimulatedStamp(frame_) - start_ns_});
  if (knots_.size() > kKnots) knots_.pop_front();
}

void SessionClock::Rebase(std::int64_t input_ns) { knots_.assign(1, {input_ns, knots_.back().session_ns}); }

double SessionClock::SessionTime(std::int64_t stamp_ns) const {
  const auto after = std::upper_bound(knots_.begin(), knots_.end(), stamp_ns,
                                      [](std::int64_t stamp, const Knot& knot) { return stamp <= knot.input_ns; });
  if (after == knots_.begin() || after == knots_.end()) {
    const Knot& end = after == knots_.begin() ? knots_.front() : knots_.back();
    return 1e-9 * static_cast<double>(end.session_ns + (stamp_ns - end.input_ns));
  }
  const Knot& a = *(after - 1);
  const Knot& b = *after;
  if (b.input_ns - a.input_ns == b.session_ns - a.session_ns) {
    return 1e-9 * static_cast<double>(a.session_ns + (stamp_ns - a.input_ns));
  }
  const double share = static_cast<double>(stamp_ns - a.input_ns) / static_cast<double>(b.input_ns - a.input_ns);
  return 1e-9 * (static_cast<double>(a.session_ns) + share * static_cast<double>(b.session_ns - a.session_ns));
}

}  // namespace meshless_cutting
