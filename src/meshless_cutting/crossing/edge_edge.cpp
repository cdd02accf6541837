// Four stages; each answers only what it is certain of and hands the rest on:
//   1. the boxes swept by the edges, compared exactly;
//   2. the coplanarity cubic and the ordering conditions in double arithmetic with proven bounds (rounded_pair.h);
//   3. the same with exact coefficients, rounded once: what cancellation hides, and contact at t = 0 and t = 1
//   (fixed_pair.h);
//   4. real algebra on integers, which decides everything (exact_crossing.h): touches, double roots, coplanar motion.
#include "crossing/edge_edge.h"

#include <algorithm>

#include "crossing/crossing_filter.h"
#include "crossing/exact_crossing.h"
#include "crossing/fixed_pair.h"
#include "crossing/rounded_pair.h"

namespace meshless_cutting {
namespace {

struct Interval {
  double lo, hi;
};

Interval Range(double w, double x, double y, double z) {
  return {std::min(std::min(w, x), std::min(y, z)), std::max(std::max(w, x), std::max(y, z))};
}

/// Whether the boxes that hold the whole motions are apart: comparisons of doubles are exact.
bool SweptBoxesApart(const MovingSegment& a, const MovingSegment& b) {
  for (int k = 0; k < 3; ++k) {
    const Interval x = Range(a.p_t0[k], a.q_t0[k], a.p_t1[k], a.q_t1[k]);
    const Interval y = Range(b.p_t0[k], b.q_t0[k], b.p_t1[k], b.q_t1[k]);
    if (x.lo > y.hi || y.lo > x.hi) return true;
  }
  return false;
}

Verdict DecideRounded(const MovingSegment& a, const MovingSegment& b, EdgeCrossing& crossing) {
  RoundedPair pair(a, b);
  if (!pair.InRange()) return Verdict::kUnsure;
  const BoundedCubic f = pair.Coplanarity();
  return CrossingFilter(pair, f).FirstCrossing(crossing);
}

/// Out of line: the few pairs that come here should not cost the others registers and cache.
[[gnu::noinline]] std::optional<EdgeCrossing> DecideExactly(const MovingSegment& a, const MovingSegment& b) {
  const IntegerCoordinates coordinates(a, b);
  if (coordinates.bits > FixedPair::kCoordinateBits) return exact::DecideCrossing(a, b);
  const FixedPair pair(coordinates);
  EdgeCrossing crossing;
  switch (pair.FirstCrossing(crossing)) {
    case Verdict::kMiss:
      return std::nullopt;
    case Verdict::kHit:
      return crossing;
    case Verdict::kUnsure:
      break;
  }
  return exact::DecideCrossing(pair.polynomials());
}

}  // namespace

std::optional<EdgeCrossing> FindFirstCrossing(const MovingSegment& a, const MovingSegment& b) {
  if (SweptBoxesApart(a, b)) return std::nullopt;
  EdgeCrossing crossing;
  const Verdict verdict = DecideRounded(a, b, crossing);
  if (verdict == Verdict::kMiss) return std::nullopt;
  if (verdict == Verdict::kHit) return crossing;
  return DecideExactly(a, b);
}

}  // namespace meshless_cutting
