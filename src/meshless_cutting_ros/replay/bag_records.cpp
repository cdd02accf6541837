#include "replay/bag_records.h"

#include <bzlib.h>
#include <roslz4/lz4s.h>

#include <cstring>

namespace meshless_cutting {
namespace {

// A chunk that claims more is damaged; rosbag writes chunks of below 1 MB.
constexpr std::uint32_t kLargestChunk = 1u << 30;

template <class Number>
Number Read(const char* bytes) {
  Number number = 0;
  std::memcpy(&number, bytes, sizeof(number));  // bags are little-endian, as every machine that ROS 1 runs on
  return number;
}

template <class Number>
Number Field(const BagFields& fields, const std::string& name) {
  const auto found = fields.find(name);
  return found == fields.end() || found->second.size() != sizeof(Number) ? 0 : Read<Number>(found->second.data());
}

}  // namespace

std::optional<BagFields> ParseFields(const char* bytes, std::size_t size) {
  BagFields fields;
  std::size_t position = 0;
  while (position < size) {
    if (size - position < 4) return std::nullopt;
    const auto length = Read<std::uint32_t>(bytes + position);
    position += 4;
    if (length > size - position) return std::nullopt;
    const std::string field(bytes + position, length);
    const auto equals = field.find('=');
    if (equals == std::string::npos) return std::nullopt;
    fields[field.substr(0, equals)] = field.substr(equals + 1);
    position += length;
  }
  return fields;
}

std::optional<BagRecord> NextRecord(const char* bytes, std::size_t size, std::size_t* position) {
  std::size_t at = *position;
  if (size - at < 4) return std::nullopt;
  const auto header_size = Read<std::uint32_t>(bytes + at);
  at += 4;
  if (header_size > size - at || size - at - header_size < 4) return std::nullopt;
  const auto fields = ParseFields(bytes + at, header_size);
  if (!fields) return std::nullopt;
  at += header_size;
  const auto data_size = Read<std::uint32_t>(bytes + at);
  at += 4;
  BagRecord record;
  record.fields = *fields;
  record.data = bytes + at;
  record.whole = data_size <= size - at;
  record.size = record.whole ? data_size : size - at;
  *position = at + record.size;
  return record;
}

std::optional<BagOp> Op(const BagFields& fields) {
  const auto found = fields.find("op");
  if (found == fields.end() || found->second.size() != 1) return std::nullopt;
  return static_cast<BagOp>(found->second[0]);
}

std::uint32_t Uint32(const BagFields& fields, const std::string& name) { return Field<std::uint32_t>(fields, name); }
std::uint64_t Uint64(const BagFields& fields, const std::string& name) { return Field<std::uint64_t>(fields, name); }

std::optional<BagBytes> Decompress(const BagRecord& chunk) {
  const auto found = chunk.fields.find("compression");
  const std::string compression = found == chunk.fields.end() ? "none" : found->second;
  if (compression == "none") return BagBytes(chunk.data, chunk.data + chunk.size);
  if (!chunk.whole) return std::nullopt;
  unsigned int size = Uint32(chunk.fields, "size");
  if (size == 0 || size > kLargestChunk) return std::nullopt;
  BagBytes bytes(size);
  const auto input_size = static_cast<unsigned int>(chunk.size);
  char* input = const_cast<char*>(chunk.data);  // neither library writes to it
  const bool done =
      compression == "bz2"
          ? BZ2_bzBuffToBuffDecompress(bytes.data(), &size, input, input_size, 0, 0) == BZ_OK
          : compression == "lz4" && roslz4_buffToBuffDecompress(input, input_size, bytes.data(), &size) == ROSLZ4_OK;
  if (!done) return std::nullopt;
  bytes.resize(size);
  return bytes;
}

}  // namespace meshless_cutting
