// Continuous edge-edge crossing test, closed in space and time (Provot 1997), exact in its answer.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace meshless_cutting {

/// A segment whose two ends move linearly over t in [0, 1].
struct MovingSegment {
  Eigen::Vector3d p_t0, q_t0;  // ends at t = 0, m
  Eigen::Vector3d p_t1, q_t1;  // ends at t = 1, m
};

struct EdgeCrossing {
  double t;  // first time of contact, in [0, 1]
  double u;  // proportion along a (from p to q) at t, in [0, 1]
  double v;  // proportion along b
};

/// First contact of the closed segments a and b at a time in the closed [0, 1], or nothing. Never misses a contact.
/// Any finite doubles. Does not allocate on the fast path.
std::optional<EdgeCrossing> FindFirstCrossing(const MovingSegment& a, const MovingSegment& b);

}  // namespace meshless_cutting
