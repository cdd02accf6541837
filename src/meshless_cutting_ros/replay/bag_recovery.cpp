#include "replay/bag_recovery.h"

#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>

#include <cstring>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>

#include "replay/bag_records.h"

namespace meshless_cutting {
namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";
constexpr std::size_t kMagicSize = sizeof(kMagic) - 1;

class Recovery {
 public:
  explicit Recovery(rosbag::Bag* bag) : bag_(bag) {}

  // The records of `bytes` from `position` on; the position behind the last that was whole.
  std::size_t Read(const char* bytes, std::size_t size, std::size_t position) {
    std::size_t read = position;
    while (const auto record = NextRecord(bytes, size, &position)) {
      if (!Take(*record)) break;
      read = position;
    }
    return read;
  }

  std::uint64_t messages() const { return messages_; }

 private:
  struct Connection {
    std::string topic;
    topic_tools::ShapeShifter shape;
    boost::shared_ptr<ros::M_string> header;
  };

  // False: the record is not whole.
  bool Take(const BagRecord& record) {
    const auto op = Op(record.fields);
    if (op == BagOp::kChunk) {
      const auto bytes = Decompress(record);
      if (bytes) Read(bytes->data(), bytes->size(), 0);
      return record.whole && bytes;
    }
    if (!record.whole || !op) return false;
    if (op == BagOp::kConnection) AddConnection(record);
    if (op == BagOp::kMessage) AddMessage(record);
    return true;
  }

  void AddConnection(const BagRecord& record) {
    const auto fields = ParseFields(record.data, record.size);
    const auto topic = record.fields.find("topic");
    if (!fields || topic == record.fields.end()) return;
    Connection& connection = connections_[Uint32(record.fields, "conn")];
    connection.topic = topic->second;
    connection.header = boost::make_shared<ros::M_string>(fields->begin(), fields->end());
    ros::M_string& header = *connection.header;
    connection.shape.morph(header["md5sum"], header["type"], header["message_definition"], header["latching"]);
  }

  void AddMessage(const BagRecord& record) {
    const auto found = connections_.find(Uint32(record.fields, "conn"));
    if (found == connections_.end()) return;
    Connection& connection = found->second;
    ros::serialization::IStream stream(reinterpret_cast<std::uint8_t*>(const_cast<char*>(record.data)),
                                       static_cast<std::uint32_t>(record.size));
    connection.shape.read(stream);
    const std::uint64_t time = Uint64(record.fields, "time");  // seconds in the low half, nanoseconds in the high half
    const ros::Time stamp(static_cast<std::uint32_t>(time), static_cast<std::uint32_t>(time >> 32));
    if (stamp < ros::TIME_MIN) return;
    bag_->write(connection.topic, stamp, connection.shape, connection.header);
    ++messages_;
  }

  rosbag::Bag* bag_;
  std::map<std::uint32_t, Connection> connections_;
  std::uint64_t messages_ = 0;
};

BagBytes ReadFile(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read; expected a bag");
  return BagBytes(std::istreambuf_iterator<char>(stream), {});
}

}  // namespace

BagRecovery RecoverBag(const std::filesystem::path& damaged, const std::filesystem::path& recovered) {
  const BagBytes bytes = ReadFile(damaged);
  if (bytes.size() < kMagicSize || std::memcmp(bytes.data(), kMagic, kMagicSize) != 0) {
    throw std::runtime_error(damaged.string() + ": not a bag; expected a file of `rosbag record`, format 2.0");
  }
  rosbag::Bag bag(recovered.string(), rosbag::bagmode::Write);
  Recovery recovery(&bag);
  const std::size_t read = recovery.Read(bytes.data(), bytes.size(), kMagicSize);
  bag.close();
  return {recovery.messages(), bytes.size(), bytes.size() - read};
}

}  // namespace meshless_cutting
