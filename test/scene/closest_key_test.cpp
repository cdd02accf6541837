#include "scene/closest_key.h"

#include <gtest/gtest.h>

namespace meshless_cutting {
namespace {

TEST(EditDistanceTest, CountsEdits) {
  EXPECT_EQ(EditDistance("", ""), 0);
  EXPECT_EQ(EditDistance("scale", "scale"), 0);
  EXPECT_EQ(EditDistance("Scale", "scale"), 0) << "case does not count";
  EXPECT_EQ(EditDistance("scle", "scale"), 1);
  EXPECT_EQ(EditDistance("sclae", "scale"), 1) << "two neighbours swapped";
  EXPECT_EQ(EditDistance("", "abc"), 3);
  EXPECT_EQ(EditDistance("abc", ""), 3);
}

TEST(ClosestKeyTest, SuggestsWhatWasMeant) {
  const std::vector<std::string> keys = {"object", "obstacles", "gravity_m_s2", "time_step_s"};
  EXPECT_EQ(ClosestKey("obstacle", keys), "obstacles");
  EXPECT_EQ(ClosestKey("gravity", keys), "gravity_m_s2") << "a word cut short";
  EXPECT_EQ(ClosestKey("timestep_s", keys), "time_step_s");
  EXPECT_EQ(ClosestKey("colour", keys), "") << "nothing is near";
  EXPECT_EQ(ClosestKey("x", {}), "");
}

}  // namespace
}  // namespace meshless_cutting
