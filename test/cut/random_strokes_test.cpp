// A share of the random strokes of stroke_search.h with a fixed seed, and every episode that ever failed. The long run
// is a program of its own, cut_search.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "cut/stroke_search.h"

namespace meshless_cutting {
namespace {

class RandomStrokes : public testing::TestWithParam<SearchBody> {};

TEST_P(RandomStrokes, BreakNothing) {
  const Lattice lattice = GetParam().make_lattice();
  SearchCounts counts;
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    ASSERT_EQ(SearchEpisode(lattice, GetParam().cell_size_m, seed, 8, counts), "") << "seed " << seed;
  EXPECT_EQ(counts.strokes, 32);
  EXPECT_GT(counts.links_cut, 100);
}

INSTANTIATE_TEST_SUITE_P(Bodies, RandomStrokes, testing::ValuesIn(SearchBodies()),
                         [](const auto& body) { return body.param.name; });

/// Each file under test/data/bugs: body, seed, strokes of an episode that failed once.
TEST(RandomStrokesBugs, StayMended) {
  for (const auto& entry : std::filesystem::directory_iterator(MESHLESS_CUTTING_TEST_DIR "/data/bugs")) {
    std::ifstream file(entry.path());
    std::string name;
    std::uint64_t seed = 0;
    int strokes = 0;
    ASSERT_TRUE(file >> name >> seed >> strokes) << entry.path() << ": expected 'body seed strokes'";
    bool known = false;
    for (const SearchBody& body : SearchBodies()) {
      if (body.name != name) continue;
      known = true;
      SearchCounts counts;
      EXPECT_EQ(SearchEpisode(body.make_lattice(), body.cell_size_m, seed, strokes, counts), "") << entry.path();
    }
    EXPECT_TRUE(known) << entry.path() << ": no body " << name;
  }
}

}  // namespace
}  // namespace meshless_cutting
