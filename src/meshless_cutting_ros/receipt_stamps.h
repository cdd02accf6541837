// Stamps for the samples of a driver that does not stamp them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "pose_sample.h"

namespace meshless_cutting {

/// The time of receipt, but for bursts: samples that the network or a busy machine kept back arrive at once, though
/// they were taken at the driver's period; stamped with their receipt each would look like a jump. A sample that is
/// late by up to 20 ms is stamped as if it were not. One that is later waits 20 ms for what was kept back with it: if
/// it comes alone the driver had paused, else all of them are spread back over the period. Stamps rise and are never
/// later than the receipt (but by the nanosecond that parts two samples received at the same one).
class ReceiptStamps {
 public:
  /// `samples` stand in the order of their receipt, whose time is their stamp. Stamps those that at `now_ns` need wait
  /// no longer; returns how many they are: the first ones.
  std::size_t Settle(std::int64_t now_ns, std::deque<PoseSample>* samples);

 private:
  using Samples = std::deque<PoseSample>::iterator;
  void Spread(Samples begin, Samples end);
  void UpdatePeriod(std::int64_t received_ns, std::ptrdiff_t count);

  std::int64_t last_stamp_ns_ = 0;
  std::int64_t last_received_ns_ = 0;
  double period_ns_ = 0;              // of the driver, averaged over
  std::ptrdiff_t averaged_over_ = 0;  // so many of the last samples
};

}  // namespace meshless_cutting
