// Sessions with random strokes: whatever is cut to whatever pieces, the motion stays one that physics allows.
#pragma once

#include <cstdint>
#include <string>

namespace meshless_cutting {

struct SessionCounts {
  long sessions = 0, frames = 0, strokes = 0;
  long hard_frames = 0;     // more than 8 Newton iterations
  long most_fragments = 0;  // of one session
};

/// One session of `frames` frames: an object that is held at one end (launch/block.yaml, or a scene file with gravity and a tool),
/// blades from all sides until half of the time has gone, then what is left falls. After every frame: no step was given up or
/// repeated in halves, no particle flew off, and the elastic energy is no more than gravity can have brought into the object; at
/// the end all invariants of topology and mapping. Returns the first predicate that failed, in words; empty: all held.
std::string SearchSession(std::uint64_t seed, int frames, SessionCounts& counts, const std::string& scene_file = {});

}  // namespace meshless_cutting
