// Sessions with random strokes: whatever is cut to whatever pieces, the motion stays one that physics allows.
#pragma once

#include <cstdint>
#include <string>

namespace meshless_cutting {

struct SessionCounts {
  long sessions = 0, frames = 0, strokes = 0;
  long hard_frames = 0;       // more than 8 Newton iterations
  long given_up = 0;          // most frames in a row for which no step was found
  long most_fragments = 0;    // of one session
};

/// One session of `frames` frames: the held block of launch/block.yaml, blades from all sides until half of the time
/// has gone, then what is left falls. After every frame: no step was given up or repeated in halves, no particle flew off,
/// and the elastic energy is no more than gravity can have brought into the block. Returns the first predicate that
/// failed, in words; empty: all held. `go_on`: plays the session to its end even so, and returns the last that failed.
std::string SearchSession(std::uint64_t seed, int frames, SessionCounts& counts, bool go_on = false);

}  // namespace meshless_cutting
