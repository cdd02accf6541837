// The command line of `replay`.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "position_encoding.h"

namespace meshless_cutting {

struct ReplayOptions {
  std::string scene;                                       // path or package:// URL
  std::string input;                                       // bag with the poses of the tools
  std::string output;                                      // bag to write
  std::map<std::string, std::string> topics;               // tool -> topic, where they are not those of the scene
  std::string name;                                        // of the simulator: prefix of topics
  std::string urdf;                                        // file; for scenes that take an edge from a link
  PositionEncoding encoding = PositionEncoding::kFloat32;  // of the positions written
  bool as_recorded = false;                                // the frames of a recorded node, to the bit
  bool help = false;
};

/// `arguments` without the program's name. Throws std::runtime_error with one line on what is wrong.
ReplayOptions ParseReplayOptions(const std::vector<std::string>& arguments);

extern const char kReplayUsage[];

}  // namespace meshless_cutting
