// Reads a bag, whole or damaged.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace meshless_cutting {

/// Calls `read` with the bag, or, when that throws rosbag::BagException, with a copy in the temporary directory that
/// holds what could be saved of it. Returns what was lost, one line; empty: nothing. Throws std::runtime_error: no such
/// file, no bag, nothing to be saved.
std::string ReadDamagedToo(const std::filesystem::path& bag, const std::function<void(const std::string& file)>& read);

}  // namespace meshless_cutting
