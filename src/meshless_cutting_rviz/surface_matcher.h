// Brings positions and topology of a surface together, in whatever order they come.
#pragma once

#include <meshless_cutting/SurfacePositions.h>
#include <meshless_cutting/SurfaceTopology.h>

#include <deque>
#include <string>

namespace meshless_cutting {

/// A surface that can be drawn: indices, regions and positions fit each other and are finite.
struct MatchedSurface {
  SurfaceTopologyConstPtr topology;
  SurfacePositionsConstPtr positions;  // encoding FLOAT32
};

/// The newest positions that came in win, also when they are older than those before: that is what a seek in a bag
/// looks like. Positions whose topology is not known wait for it (it comes every second); meanwhile the last surface
/// stays. A topology that comes again replaces the one of the same object, session and version: another run counts
/// sessions from 1 too.
class SurfaceMatcher {
 public:
  enum class Outcome {
    kShown,    // surface() has changed
    kKept,     // nothing new to draw
    kWaiting,  // for the topology of the newest positions
    kRefused,  // error() says why
  };

  Outcome Add(const SurfaceTopologyConstPtr& topology);
  Outcome Add(const SurfacePositionsConstPtr& positions);
  void Clear();

  /// Empty pointers before the first match.
  const MatchedSurface& surface() const { return surface_; }
  /// What is wrong with the last message that was refused, in words.
  const std::string& error() const { return error_; }

 private:
  const SurfaceTopologyConstPtr* Find(const SurfacePositions& positions) const;
  Outcome Match(const SurfacePositionsConstPtr& positions);

  std::deque<SurfaceTopologyConstPtr> topologies_;  // the last few that came in
  SurfacePositionsConstPtr waiting_;
  MatchedSurface surface_;
  std::string error_;
};

/// What is wrong with a topology, in words; empty: nothing.
std::string CheckTopology(const SurfaceTopology& topology);

}  // namespace meshless_cutting
