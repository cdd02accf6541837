// Another way to the same answer, to check against: rational power-basis polynomials, Sturm-Tarski queries instead of
// certified doubles and resultants, products of whole vectors (up to degree 4) instead of projections along an axis.
#pragma once

#include <optional>

#include "crossing/edge_edge.h"

namespace meshless_cutting::test {

/// The first time of contact, with a relative error below 2^-48; nothing if there is no contact. Takes milliseconds.
std::optional<double> ReferenceFirstContact(const MovingSegment& a, const MovingSegment& b);

}  // namespace meshless_cutting::test
