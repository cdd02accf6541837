#include "receipt_stamps.h"

#include <algorithm>

namespace meshless_cutting {
namespace {

constexpr std::int64_t kLate_ns = 20000000;
constexpr std::int64_t kPause_ns = 100000000;    // between two samples: the driver stopped, this is not its period
constexpr std::int64_t kClockBack_ns = 1000000;  // the clock of the receipts was set back
constexpr std::ptrdiff_t kLongestAverage = 100;  // samples
constexpr double kShareCaughtUp = 0.02;          // of the lateness, per sample: a driver may have changed its rhythm

}  // namespace

std::size_t ReceiptStamps::Settle(std::int64_t now_ns, std::deque<PoseSample>* samples) {
  Samples begin = samples->begin();
  while (begin != samples->end()) {
    const std::int64_t received_ns = begin->stamp_ns;
    if (received_ns < last_stamp_ns_ - kClockBack_ns) *this = ReceiptStamps();
    const std::int64_t late_ns = received_ns - last_stamp_ns_ - static_cast<std::int64_t>(period_ns_);
    const bool is_late = averaged_over_ > 0 && late_ns > 0;  // without a period nothing is
    Samples end = begin + 1;
    if (is_late && late_ns > kLate_ns) {
      if (received_ns + kLate_ns > now_ns) break;
      end = std::find_if(end, samples->end(),
                         [&](const PoseSample& sample) { return sample.stamp_ns > received_ns + kLate_ns; });
    }
    const std::int64_t newest_ns = (end - 1)->stamp_ns;
    if (is_late && late_ns <= kLate_ns) {
      const bool in_burst = static_cast<double>(received_ns - last_received_ns_) < 0.5 * period_ns_;
      const double excused = in_burst ? 1 : 1 - kShareCaughtUp;
      begin->stamp_ns -= static_cast<std::int64_t>(excused * static_cast<double>(late_ns));
    }
    Spread(begin, end);
    UpdatePeriod(newest_ns, end - begin);
    begin = end;
  }
  return static_cast<std::size_t>(begin - samples->begin());
}

// Back from the last of them, over the period or, where that has no room, as evenly as their receipts allow.
void ReceiptStamps::Spread(Samples begin, Samples end) {
  auto step_ns = static_cast<std::int64_t>(period_ns_);
  for (Samples sample = begin; sample != end; ++sample) {
    step_ns = std::min(step_ns, (sample->stamp_ns - last_stamp_ns_) / (sample - begin + 1));
  }
  for (Samples sample = end - 1; sample != begin; --sample) {
    const Samples before = sample - 1;
    before->stamp_ns = std::min(before->stamp_ns, sample->stamp_ns - step_ns);
  }
  for (Samples sample = begin; sample != end; ++sample) {
    last_stamp_ns_ = sample->stamp_ns = std::max(sample->stamp_ns, last_stamp_ns_ + 1);
  }
}

void ReceiptStamps::UpdatePeriod(std::int64_t received_ns, std::ptrdiff_t count) {
  const std::int64_t interval_ns = (received_ns - last_received_ns_) / count;
  if (last_received_ns_ != 0 && interval_ns < kPause_ns) {
    averaged_over_ = std::min(averaged_over_ + count, kLongestAverage);
    const double share = std::min(1.0, static_cast<double>(count) / static_cast<double>(averaged_over_));
    period_ns_ += share * (static_cast<double>(interval_ns) - period_ns_);
  }
  last_received_ns_ = received_ns;
}

}  // namespace meshless_cutting
