#include "replay/damaged_bag.h"

#include <rosbag/exceptions.h>
#include <unistd.h>

#include <stdexcept>

#include "replay/bag_recovery.h"
#include "replay/temporary_file.h"

namespace meshless_cutting {
namespace {

std::string Loss(const std::string& name, const BagRecovery& recovery) {
  return name + ": damaged or not closed; used the " + std::to_string(recovery.messages) +
         " messages that could be read, lost the last " + std::to_string(recovery.bytes_lost) + " of " +
         std::to_string(recovery.bytes_total) + " bytes";
}

}  // namespace

std::string ReadDamagedToo(const std::filesystem::path& bag, const std::function<void(const std::string& file)>& read) {
  const std::string name = bag.string();
  std::error_code error;
  if (!std::filesystem::is_regular_file(bag, error)) throw std::runtime_error(name + ": no such file; expected a bag");
  try {
    read(name);
    return {};
  } catch (const rosbag::BagException&) {
    // Not closed, cut off, or no bag at all: below.
  }
  const TemporaryFile copy(std::filesystem::temp_directory_path() /
                           ("replay_recovered_" + std::to_string(getpid()) + ".bag"));
  try {
    const BagRecovery recovery = RecoverBag(bag, copy.path());
    const std::string loss = Loss(name, recovery);
    if (recovery.messages == 0) throw std::runtime_error(loss + "; expected at least one tool pose");
    read(copy.path().string());
    return loss;
  } catch (const rosbag::BagException& damage) {
    throw std::runtime_error(name + ": cannot be read (" + damage.what() + "); expected a bag of `rosbag record`");
  }
}

}  // namespace meshless_cutting
