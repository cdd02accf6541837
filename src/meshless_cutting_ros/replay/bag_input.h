// The tool samples of a bag, as the node would have received them.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "session.h"

namespace meshless_cutting {

struct ToolRecording {
  std::string topic;              // it was read from; "tf frame x"; "fixed"
  std::vector<PoseSample> poses;  // in the order of the bag, in the scene frame, stamps not 0
  std::vector<EdgeSample> edges;
  std::vector<ButtonSample> buttons;
};

struct BagInput {
  std::vector<ToolRecording> tools;  // as in the scene
  std::int64_t first_ns = 0;  // earliest and latest stamp of a sample; of the bag when no tool has a source in it
  std::int64_t last_ns = 0;
  std::string loss;                // what could not be read, one line; empty: nothing
  std::vector<std::string> notes;  // lines for the user: tools without samples
};

/// Which topic each tool is read from: given, or as the scene names it below `simulator`, or the only one that ends so.
struct TopicChoice {
  std::map<std::string, std::string> given;  // tool -> topic
  std::string simulator;                     // "/simulator"
};

/// Reads `bag`; a damaged one as far as it goes, through a copy in the temporary directory. `reports`, one per tool,
/// take samples that cannot be used. Throws std::runtime_error: no bag, or no tool of the scene has a topic in it.
BagInput ReadBag(const std::filesystem::path& bag, const Scene& scene, const TopicChoice& choice,
                 const InputReports& reports);

}  // namespace meshless_cutting
