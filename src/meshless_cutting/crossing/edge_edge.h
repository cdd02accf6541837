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

/// Where and when two edges touch first.
struct EdgeCrossing {
  double t;  // first time of contact, in [0, 1]; relative error below 1e-9
  double u;  // proportion along a (from p to q) at t, in [0, 1]; on parallel edges, of one of the common points
  double v;  // proportion along b, likewise
};

/// First contact of the closed segments a and b at a time in the closed [0, 1], or nothing. The answer is that of exact
/// arithmetic on the given numbers: no miss and no false hit, also where ends touch, where edges stay in one plane, are
/// parallel or have no length. Any finite doubles. Allocates only where doubles cannot decide (touches, double roots).
std::optional<EdgeCrossing> FindFirstCrossing(const MovingSegment& a, const MovingSegment& b);

}  // namespace meshless_cutting
