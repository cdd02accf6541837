// Random pairs of moving segments, of the kinds that make a crossing test fail.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "crossing/crossing_queries.h"

namespace meshless_cutting::test {

/// The names of the kinds.
const std::vector<std::string>& RandomKinds();

/// A query of that kind; truth and time are not set. The same numbers on every platform for the same state of the
/// engine.
CrossingQuery RandomQuery(const std::string& kind, std::mt19937_64& random);

}  // namespace meshless_cutting::test
