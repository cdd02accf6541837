// A share of session_search, and the seeds that it found failures with.
#include <gtest/gtest.h>

#include "scenes/session_search.h"

namespace meshless_cutting {
namespace {

TEST(RandomSessions, MotionStaysPhysical) {
  SessionCounts counts;
  for (std::uint64_t seed : {1, 2, 3, 4}) EXPECT_EQ(SearchSession(seed, 300, counts), "") << "seed " << seed;
  // A flap of a fortieth of a cell on the way to the next one; it flew off when only lighter particles followed.
  EXPECT_EQ(SearchSession(200, 480, counts), "");
  EXPECT_GT(counts.most_fragments, 3);
}

}  // namespace
}  // namespace meshless_cutting
