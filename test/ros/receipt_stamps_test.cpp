#include "receipt_stamps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace meshless_cutting {
namespace {

constexpr std::int64_t kMillisecond = 1000000;
constexpr std::int64_t kStart = 1700000000000000000;
constexpr std::int64_t kFrame = 16666667;

using Times = std::vector<std::int64_t>;

// The stamps of samples received at `receipts`, fetched at the frames of a simulator.
Times Stamps(const Times& receipts, std::int64_t frame_ns = kFrame) {
  ReceiptStamps receipt_stamps;
  std::deque<PoseSample> waiting;
  Times stamps;
  std::size_t received = 0;
  for (std::int64_t now = receipts.front(); stamps.size() < receipts.size(); now += frame_ns) {
    for (; received < receipts.size() && receipts[received] <= now; ++received) {
      waiting.emplace_back();
      waiting.back().stamp_ns = receipts[received];
    }
    for (std::size_t left = receipt_stamps.Settle(now, &waiting); left > 0; --left) {
      EXPECT_LE(now - receipts[stamps.size()], 20 * kMillisecond + frame_ns) << "kept for too long";
      stamps.push_back(waiting.front().stamp_ns);
      waiting.pop_front();
    }
  }
  return stamps;
}

Times Steady(int count, std::int64_t period_ns) {
  Times receipts;
  for (int i = 0; i < count; ++i) receipts.push_back(kStart + i * period_ns);
  return receipts;
}

std::int64_t SmallestStep(const Times& stamps) {
  std::int64_t smallest = stamps[1] - stamps[0];
  for (std::size_t i = 1; i < stamps.size(); ++i) smallest = std::min(smallest, stamps[i] - stamps[i - 1]);
  return smallest;
}

TEST(ReceiptStampsTest, SteadySamplesAreStampedWithTheirReceipt) {
  const Times receipts = Steady(100, 2 * kMillisecond);
  EXPECT_EQ(Stamps(receipts), receipts);
}

TEST(ReceiptStampsTest, ABurstIsSpreadOverTheDriversPeriod) {
  for (const std::int64_t period : {kMillisecond, 2 * kMillisecond, 5 * kMillisecond}) {
    for (const int kept_back : {2, 5, 60, 300}) {
      Times receipts = Steady(900, period);
      // From the 400th on they come with the last of them, as fast as a machine takes them in.
      const std::int64_t arrival = receipts[400 + kept_back];
      for (int i = 0; i < 900; ++i) receipts[i] = std::max(receipts[i], i >= 400 ? arrival + (i - 400) * 20000 : 0);
      std::sort(receipts.begin(), receipts.end());
      for (const std::int64_t frame : {kFrame, kMillisecond}) {
        const Times stamps = Stamps(receipts, frame);
        EXPECT_GE(SmallestStep(stamps), period / 2) << "period " << period << ", kept back " << kept_back;
        for (std::size_t i = 0; i < stamps.size(); ++i) EXPECT_LE(stamps[i], receipts[i]) << i;
      }
    }
  }
}

TEST(ReceiptStampsTest, EvensOutWhatABusyMachineDelays) {
  unsigned random = 7;
  const auto draw = [&random](int below) {
    random = random * 1664525u + 1013904223u;
    return static_cast<std::int64_t>(random >> 16) % below;
  };
  for (const std::int64_t period : {kMillisecond, 2 * kMillisecond, 5 * kMillisecond}) {
    Times receipts = Steady(5000, period);
    for (std::size_t i = 0; i < receipts.size(); ++i) {
      receipts[i] += draw(10) == 0 ? draw(18000) * 1000 : draw(200) * 1000;
      if (i > 0) receipts[i] = std::max(receipts[i], receipts[i - 1] + 10000);
    }
    const Times stamps = Stamps(receipts);
    const auto hasty = [period](const Times& times) {
      int count = 0;
      for (std::size_t i = 1; i < times.size(); ++i) count += times[i] - times[i - 1] < period / 2 ? 1 : 0;
      return count;
    };
    EXPECT_LE(hasty(stamps), hasty(receipts) / 10) << "period " << period;
    for (std::size_t i = 0; i < stamps.size(); ++i) EXPECT_LE(stamps[i], receipts[i]) << i;
  }
}

TEST(ReceiptStampsTest, StampsRiseAndAreNotLaterThanTheReceiptWhateverComes) {
  Times receipts;
  std::int64_t now = kStart;
  unsigned random = 1;
  for (int i = 0; i < 5000; ++i) {
    random = random * 1664525u + 1013904223u;
    now += (random >> 24) < 200 ? 0 : static_cast<std::int64_t>(random >> 8) * 3;
    receipts.push_back(now);
  }
  const Times stamps = Stamps(receipts);
  EXPECT_GT(SmallestStep(stamps), 0);
  std::size_t settled = 0;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    EXPECT_LE(stamps[i], receipts[i] + 100) << "a nanosecond for each that came at the same one";
    for (; receipts[settled] < receipts[i] - 20 * kMillisecond; ++settled) {
    }
    EXPECT_TRUE(settled == 0 || stamps[i] > receipts[settled - 1]) << "not kept back for as long as that";
  }
}

TEST(ReceiptStampsTest, ASampleAloneAfterAPauseIsStampedWithItsReceipt) {
  Times receipts = Steady(50, kMillisecond);
  receipts.push_back(receipts.back() + 70 * kMillisecond);
  receipts.push_back(receipts.back() + 5000 * kMillisecond);
  EXPECT_EQ(Stamps(receipts), receipts);
}

TEST(ReceiptStampsTest, FollowsAClockThatIsSetBack) {
  Times receipts = Steady(50, kMillisecond);
  ReceiptStamps receipt_stamps;
  for (int again = 0; again < 2; ++again) {
    for (const std::int64_t receipt : receipts) {
      std::deque<PoseSample> one(1);
      one[0].stamp_ns = receipt;
      EXPECT_EQ(receipt_stamps.Settle(receipt + 25 * kMillisecond, &one), 1u);
      EXPECT_EQ(one[0].stamp_ns, receipt);
    }
  }
}

}  // namespace
}  // namespace meshless_cutting
