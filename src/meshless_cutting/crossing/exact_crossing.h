// The crossing test by real algebra on integers: slow, and certain.
#pragma once

#include <optional>

#include "crossing/edge_edge.h"
#include "crossing/fixed_pair.h"
#include "crossing/pair_polynomials.h"

namespace meshless_cutting::exact {

/// Decides what FindFirstCrossing() promises. For integers of any kind that ToInteger() takes.
template <class Polynomials>
std::optional<EdgeCrossing> DecideCrossing(const Polynomials& pair);
extern template std::optional<EdgeCrossing> DecideCrossing(const FixedPair::Polynomials& pair);

/// The same for any finite doubles, without any filter.
std::optional<EdgeCrossing> DecideCrossing(const MovingSegment& a, const MovingSegment& b);

}  // namespace meshless_cutting::exact
