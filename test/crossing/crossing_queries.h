// Queries with known answers, and the file format that holds them.
//
// One query per line, '#' starts a comment, comma separated: 24 coordinates as C hex floats (a0 a1 b0 b1 at t = 0, then
// at t = 1; a moves from a0 to a1 as blade edge, b as object edge), category, truth (0 or 1), touch_only, why, first
// contact time (-1 if none), gap. touch_only and why are not read.
#pragma once

#include <string>
#include <vector>

#include "crossing/edge_edge.h"

namespace meshless_cutting::test {

struct CrossingQuery {
  MovingSegment a, b;
  std::string category;
  bool truth = false;
  double time_of_contact = -1;
  double gap = 0;  // approximate distance, an upper bound
  int line = 0;    // of its file
};

/// The ends of both segments, at t = 0, then at t = 1; pointers into the query.
std::vector<Eigen::Vector3d*> Points(CrossingQuery& query);

/// Reads plain or gzipped text. Throws std::runtime_error with file and line.
std::vector<CrossingQuery> ReadCrossingQueries(const std::string& path);

/// One line of such a file, with touch_only and why 0.
std::string ToLine(CrossingQuery query);

}  // namespace meshless_cutting::test
