// Saves what can be read of a bag that was not closed, or was cut off in the middle.
#pragma once

#include <cstdint>
#include <filesystem>

namespace meshless_cutting {

struct BagRecovery {
  std::uint64_t messages = 0;     // that could be read
  std::uint64_t bytes_total = 0;  // of the damaged bag
  std::uint64_t bytes_lost = 0;   // behind the last record that could be read
};

/// Reads the records of `damaged` (bag format 2.0; chunks plain, bz2 or lz4) one after the other as far as they are
/// whole and writes their messages to a new bag `recovered`. Of a plain chunk that is cut off the whole records are
/// taken too. Throws std::runtime_error when `damaged` cannot be opened or is not a bag.
BagRecovery RecoverBag(const std::filesystem::path& damaged, const std::filesystem::path& recovered);

}  // namespace meshless_cutting
