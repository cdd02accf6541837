#include "surface_matcher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <limits>
#include <random>

#include "position_encoding.h"

namespace meshless_cutting {
namespace {

using Outcome = SurfaceMatcher::Outcome;

// One triangle per version, so that sizes tell versions apart.
SurfaceTopologyPtr Topology(std::uint32_t session, std::uint32_t version, std::uint32_t triangles = 0) {
  auto message = boost::make_shared<SurfaceTopology>();
  message->object = "block";
  message->session = session;
  message->version = version;
  const std::uint32_t count = triangles ? triangles : version;
  for (std::uint32_t i = 0; i < 3 * count; ++i) {
    message->triangles.push_back(i);
    message->rest_positions.insert(message->rest_positions.end(),
                                   {0.1f * static_cast<float>(i), i % 3 == 1 ? 1.f : 0.f, 0});
  }
  message->region.assign(count, 0);
  message->fragment.assign(count, 0);
  return message;
}

SurfacePositionsPtr Positions(const SurfaceTopology& topology, std::uint64_t step = 0) {
  auto message = boost::make_shared<SurfacePositions>();
  message->object = topology.object;
  message->session = topology.session;
  message->version = topology.version;
  message->step = step;
  message->positions = topology.rest_positions;
  return message;
}

TEST(SurfaceMatcherTest, PositionsWaitForTheirTopology) {
  SurfaceMatcher matcher;
  const auto first = Topology(1, 1), second = Topology(1, 2);
  EXPECT_EQ(matcher.Add(Positions(*first)), Outcome::kWaiting);
  EXPECT_FALSE(matcher.surface().positions);
  EXPECT_EQ(matcher.Add(second), Outcome::kKept);
  EXPECT_EQ(matcher.Add(first), Outcome::kShown);
  EXPECT_EQ(matcher.surface().topology, first);
  EXPECT_EQ(matcher.Add(Positions(*second)), Outcome::kShown);
  EXPECT_EQ(matcher.Add(first), Outcome::kKept) << "sent again, as every second";
  EXPECT_EQ(matcher.surface().topology, second);
}

TEST(SurfaceMatcherTest, ASeekBackShowsWhatCameLast) {
  SurfaceMatcher matcher;
  for (const std::uint32_t version : {1, 2, 3}) {
    const auto topology = Topology(4, version);
    matcher.Add(topology);
    EXPECT_EQ(matcher.Add(Positions(*topology, version)), Outcome::kShown);
  }
  EXPECT_EQ(matcher.Add(Positions(*Topology(4, 1), 1)), Outcome::kShown) << "still known";
  EXPECT_EQ(matcher.surface().positions->step, 1u);
  EXPECT_EQ(matcher.Add(Positions(*Topology(2, 9), 7)), Outcome::kWaiting) << "an older session of the bag";
  EXPECT_EQ(matcher.surface().positions->step, 1u) << "the last surface stays";
  EXPECT_EQ(matcher.Add(Topology(2, 9)), Outcome::kShown);
}

TEST(SurfaceMatcherTest, AnotherRunThatCountsTheSameReplacesTheTopology) {
  SurfaceMatcher matcher;
  const auto old_run = Topology(1, 1, 5), new_run = Topology(1, 1, 7);
  matcher.Add(old_run);
  matcher.Add(Positions(*old_run));
  EXPECT_EQ(matcher.Add(Positions(*new_run)), Outcome::kWaiting);
  EXPECT_EQ(matcher.Add(new_run), Outcome::kShown);
  EXPECT_EQ(matcher.surface().topology, new_run);
}

TEST(SurfaceMatcherTest, RefusesWhatWouldCrashADisplay) {
  SurfaceMatcher matcher;
  const auto good = Topology(1, 1);
  matcher.Add(good);
  matcher.Add(Positions(*good));
  const auto spoil = [](auto change) {
    const auto topology = Topology(1, 2);
    change(topology.get());
    return topology;
  };
  for (const auto& bad : {spoil([](auto* t) { t->triangles[4] = 6; }), spoil([](auto* t) { t->triangles.pop_back(); }),
                          spoil([](auto* t) { t->region.pop_back(); }), spoil([](auto* t) { t->fragment.clear(); }),
                          spoil([](auto* t) { t->rest_positions.pop_back(); }),
                          spoil([](auto* t) { t->rest_positions[1] = std::numeric_limits<float>::quiet_NaN(); })}) {
    EXPECT_EQ(matcher.Add(bad), Outcome::kRefused);
    EXPECT_FALSE(matcher.error().empty());
  }
  const auto infinite = Positions(*good);
  infinite->positions[2] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(matcher.Add(infinite), Outcome::kRefused);
  const auto unknown = Positions(*good);
  unknown->encoding = 77;
  EXPECT_EQ(matcher.Add(unknown), Outcome::kRefused);
  EXPECT_EQ(matcher.surface().topology, good);
}

TEST(SurfaceMatcherTest, ReadsBothEncodings) {
  SurfaceMatcher matcher;
  const auto topology = Topology(1, 3);
  matcher.Add(topology);
  const auto packed = Positions(*topology);
  packed->positions.clear();
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < topology->rest_positions.size(); i += 3)
    points.emplace_back(topology->rest_positions[i], topology->rest_positions[i + 1], topology->rest_positions[i + 2]);
  Encode(points, PositionEncoding::kUint16, packed.get());
  EXPECT_EQ(matcher.Add(packed), Outcome::kShown);
  EXPECT_EQ(matcher.surface().positions->positions.size(), topology->rest_positions.size());
}

// Whatever the order, with repeats and losses: what is shown always fits, and once all is there the newest is shown.
TEST(SurfaceMatcherTest, AnyOrderOfMessages) {
  std::mt19937 random(7);
  for (int run = 0; run < 300; ++run) {
    SurfaceMatcher matcher;
    std::vector<SurfaceTopologyPtr> topologies;
    for (std::uint32_t version = 1; version <= 5; ++version) topologies.push_back(Topology(1 + run % 2, version));
    SurfacePositionsPtr newest;
    for (int message = 0; message < 40; ++message) {
      const auto& topology = topologies[random() % topologies.size()];
      if (random() % 2) {
        matcher.Add(topology);
      } else {
        newest = Positions(*topology, static_cast<std::uint64_t>(message));
        matcher.Add(newest);
      }
      const MatchedSurface& shown = matcher.surface();
      if (!shown.positions) continue;
      ASSERT_EQ(shown.positions->version, shown.topology->version);
      ASSERT_EQ(shown.positions->positions.size(), shown.topology->rest_positions.size());
    }
    for (const auto& topology : topologies) matcher.Add(topology);
    if (newest) {
      EXPECT_EQ(matcher.surface().positions, newest) << run;
    }
  }
}

}  // namespace
}  // namespace meshless_cutting
