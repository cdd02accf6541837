// Stamps for the samples of a driver that does not stamp them.
#pragma once

#include <cstdint>

namespace meshless_cutting {

/// The time of receipt, but for bursts: samples that the network or a busy machine kept back arrive at once, though
/// they were taken at the driver's period. They are spread over that period again; otherwise each would look like a
/// jump. A stamp is never later than its receipt and at most 20 ms earlier, and stamps rise.
class ReceiptStamps {
 public:
  /// The stamp of a sample received at `received_ns`.
  std::int64_t Next(std::int64_t received_ns);

 private:
  std::int64_t last_received_ns_ = 0;
  std::int64_t last_stamp_ns_ = 0;
  double period_ns_ = 0;  // of the driver, averaged
};

}  // namespace meshless_cutting
