// The records of a bag file, format 2.0 (http://wiki.ros.org/Bags/Format/2.0), as bytes.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace meshless_cutting {

using BagBytes = std::vector<char>;

enum class BagOp : std::uint8_t { kMessage = 2, kHeader = 3, kIndex = 4, kChunk = 5, kChunkInfo = 6, kConnection = 7 };

/// name=value pairs of a header, values as raw bytes.
using BagFields = std::map<std::string, std::string>;

struct BagRecord {
  BagFields fields;
  const char* data = nullptr;  // in the bytes that were parsed
  std::size_t size = 0;        // of data that is there
  bool whole = false;          // all of data is there
};

/// The record at `*position`, which is moved behind it. Nothing at the end, or where no whole header is.
std::optional<BagRecord> NextRecord(const char* bytes, std::size_t size, std::size_t* position);

/// Fields of a header of `size` bytes; nothing when they are not well-formed.
std::optional<BagFields> ParseFields(const char* bytes, std::size_t size);

std::optional<BagOp> Op(const BagFields& fields);
/// A little-endian number; 0 when the field is missing or of another size.
std::uint32_t Uint32(const BagFields& fields, const std::string& name);
std::uint64_t Uint64(const BagFields& fields, const std::string& name);

/// The records in a chunk; nothing when they cannot be decompressed.
std::optional<BagBytes> Decompress(const BagRecord& chunk);

}  // namespace meshless_cutting
