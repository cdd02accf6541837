#include "receipt_stamps.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace meshless_cutting {
namespace {

constexpr std::int64_t kMillisecond = 1000000;
constexpr std::int64_t kStart = 1700000000000000000;

TEST(ReceiptStampsTest, SteadySamplesAreStampedWithTheirReceipt) {
  ReceiptStamps stamps;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(stamps.Next(kStart + 2 * i * kMillisecond), kStart + 2 * i * kMillisecond);
}

TEST(ReceiptStampsTest, ABurstIsSpreadOverTheDriversPeriod) {
  ReceiptStamps stamps;
  std::int64_t now = kStart, last = 0;
  for (int i = 0; i < 200; ++i) last = stamps.Next(now = kStart + 2 * i * kMillisecond);
  now += 12 * kMillisecond;  // five are kept back and come with the sixth
  for (int i = 0; i < 6; ++i) {
    const std::int64_t stamp = stamps.Next(now + i * 10000);
    EXPECT_GT(stamp - last, kMillisecond) << i;
    EXPECT_LE(stamp, now + i * 10000) << i;
    last = stamp;
  }
}

TEST(ReceiptStampsTest, StampsRiseAndStayNearTheReceiptWhateverComes) {
  ReceiptStamps stamps;
  std::int64_t now = kStart, last = 0;
  unsigned random = 1;
  for (int i = 0; i < 5000; ++i) {
    random = random * 1664525u + 1013904223u;
    now += (random >> 24) < 200 ? 0 : static_cast<std::int64_t>(random >> 8) * 3;
    const std::int64_t stamp = stamps.Next(now);
    EXPECT_GT(stamp, last);
    EXPECT_GE(stamp, now - 21 * kMillisecond);
    last = stamp;
  }
}

TEST(ReceiptStampsTest, AfterAPauseReceiptCounts) {
  ReceiptStamps stamps;
  stamps.Next(kStart);
  stamps.Next(kStart + kMillisecond);
  EXPECT_EQ(stamps.Next(kStart + 5000 * kMillisecond), kStart + 5000 * kMillisecond);
}

}  // namespace
}  // namespace meshless_cutting
