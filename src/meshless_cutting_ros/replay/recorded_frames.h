// The frames of a node as it recorded them: what `replay --as-recorded` makes again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "messages.h"

namespace meshless_cutting {

struct RecordedFrames {
  std::vector<FrameInputConstPtr> frames;  // whole sessions, in the order of the bag
  std::vector<std::string> notes;          // lines for the user: sessions that cannot be made again
  std::string loss;                        // what of the bag could not be read; empty: nothing
};

/// Reads ~inputs of the simulator `name`. A session that the bag entered in its middle, or that has a gap, ends there
/// or is left out, with a note. Throws std::runtime_error: no bag, no frame that can be made again.
RecordedFrames ReadRecordedFrames(const std::filesystem::path& bag, const std::string& name);

}  // namespace meshless_cutting
