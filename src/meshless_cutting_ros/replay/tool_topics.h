// Finds the topics of the tools among those of a bag.
#pragma once

#include <rosbag/view.h>

#include <string>
#include <vector>

#include "replay/bag_input.h"

namespace meshless_cutting {

/// Topic of each tool of the scene, or empty where the bag has none (or the tool needs none).
/// Throws std::runtime_error: a given topic that is not there or is no pose, several that fit, none for any tool.
std::vector<std::string> FindToolTopics(const std::vector<const rosbag::ConnectionInfo*>& connections,
                                        const Scene& scene, const TopicChoice& choice, const std::string& bag);

}  // namespace meshless_cutting
