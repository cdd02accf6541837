#include "receipt_stamps.h"

#include <algorithm>

namespace meshless_cutting {
namespace {

constexpr std::int64_t kLongestDelay_ns = 20000000;
constexpr std::int64_t kPause_ns = 100000000;  // the driver stopped: no period
constexpr double kShareOfNew = 0.01;

}  // namespace

std::int64_t ReceiptStamps::Next(std::int64_t received_ns) {
  const std::int64_t interval = received_ns - last_received_ns_;
  std::int64_t stamp = received_ns;
  if (last_received_ns_ != 0 && interval >= 0 && interval < kPause_ns) {
    period_ns_ = period_ns_ == 0 ? static_cast<double>(interval)
                                 : (1 - kShareOfNew) * period_ns_ + kShareOfNew * static_cast<double>(interval);
    const std::int64_t expected = last_stamp_ns_ + static_cast<std::int64_t>(period_ns_);
    stamp = std::min(received_ns, std::max(expected, received_ns - kLongestDelay_ns));
    stamp = std::max(stamp, last_stamp_ns_ + 1);
  }
  last_received_ns_ = received_ns;
  last_stamp_ns_ = stamp;
  return stamp;
}

}  // namespace meshless_cutting
