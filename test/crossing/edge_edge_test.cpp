// FindFirstCrossing() against answers known otherwise, and against its own symmetries.
#include "crossing/edge_edge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "crossing/exact_crossing.h"
#include "crossing/random_queries.h"
#include "crossing/reference_crossing.h"

namespace meshless_cutting::test {
namespace {

constexpr double kTimeAccuracy = 1e-9;  // relative

MovingSegment Segment(const Eigen::Vector3d& p_t0, const Eigen::Vector3d& q_t0, const Eigen::Vector3d& p_t1,
                      const Eigen::Vector3d& q_t1) {
  return {p_t0, q_t0, p_t1, q_t1};
}

MovingSegment Swapped(const MovingSegment& s) { return {s.q_t0, s.p_t0, s.q_t1, s.p_t1}; }
MovingSegment Reversed(const MovingSegment& s) { return {s.p_t1, s.q_t1, s.p_t0, s.q_t0}; }

template <class Change>
MovingSegment Changed(const MovingSegment& s, Change change) {
  return {change(s.p_t0), change(s.q_t0), change(s.p_t1), change(s.q_t1)};
}

/// Finite, in range, and a common point at t as far as rounding lets see.
void ExpectSound(const CrossingQuery& query, const EdgeCrossing& crossing, double tolerance) {
  for (const double x : {crossing.t, crossing.u, crossing.v}) {
    EXPECT_GE(x, 0);
    EXPECT_LE(x, 1);
  }
  const auto at = [&](const MovingSegment& s, double u) -> Eigen::Vector3d {
    return (1 - u) * ((1 - crossing.t) * s.p_t0 + crossing.t * s.p_t1) +
           u * ((1 - crossing.t) * s.q_t0 + crossing.t * s.q_t1);
  };
  double extent = 0;
  CrossingQuery copy = query;
  for (const Eigen::Vector3d* point : Points(copy)) extent = std::max(extent, point->cwiseAbs().maxCoeff());
  EXPECT_LE((at(query.a, crossing.u) - at(query.b, crossing.v)).cwiseAbs().maxCoeff(), tolerance * extent);
}

void ExpectSame(const std::optional<EdgeCrossing>& x, const std::optional<EdgeCrossing>& y) {
  ASSERT_EQ(x.has_value(), y.has_value());
  if (!x) return;
  EXPECT_NEAR(x->t, y->t, kTimeAccuracy * x->t);
}

TEST(FindFirstCrossing, FindsAPlainCrossing) {
  const MovingSegment a = Segment({-1, 0, 1}, {3, 0, 1}, {-1, 0, -1}, {3, 0, -1});
  const MovingSegment b = Segment({0, -1, 0}, {0, 2, 0}, {0, -1, 0}, {0, 2, 0});
  const auto crossing = FindFirstCrossing(a, b);
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->t, 0.5, 1e-15);
  EXPECT_NEAR(crossing->u, 0.25, 1e-15);
  EXPECT_NEAR(crossing->v, 1.0 / 3, 1e-15);
}

TEST(FindFirstCrossing, MissesWhatPassesBeside) {
  const MovingSegment a = Segment({-1, 0, 1}, {3, 0, 1}, {-1, 0, -1}, {3, 0, -1});
  const MovingSegment b = Segment({-1.5, -1, 0}, {-0.5, -1e-9, 0}, {-1.5, -1, 0}, {-0.5, -1e-9, 0});
  EXPECT_FALSE(FindFirstCrossing(a, b));
}

TEST(FindFirstCrossing, IsClosedInTimeAndSpace) {
  const MovingSegment b = Segment({0, -1, 0}, {0, 1, 0}, {0, -1, 0}, {0, 1, 0});
  const double above = std::nextafter(0.0, 1.0);
  for (const double z : {0.0, above}) {
    const bool touches = z == 0;
    EXPECT_EQ(FindFirstCrossing(Segment({-1, 0, 1}, {1, 0, 1}, {-1, 0, z}, {1, 0, z}), b).has_value(), touches) << z;
    EXPECT_EQ(FindFirstCrossing(Segment({-1, 0, z}, {1, 0, z}, {-1, 0, 1}, {1, 0, 1}), b).has_value(), touches) << z;
    EXPECT_EQ(FindFirstCrossing(Segment({z, 0, 1}, {1, 0, 1}, {z, 0, -1}, {1, 0, -1}), b).has_value(), touches) << z;
  }
}

TEST(FindFirstCrossing, RestingContactIsAtTheStart) {
  const MovingSegment b = Segment({0, -1, 0}, {0, 1, 0}, {0, -1, 0}, {0, 1, 0});
  for (const MovingSegment& a : {b, Swapped(b), Segment({0, 1, 0}, {1, 1, 1}, {0, 1, 0}, {1, 1, 1}),
                                 Segment({0, 0.5, 0}, {0, 0.5, 0}, {0, 0.5, 0}, {0, 0.5, 0})}) {
    const auto crossing = FindFirstCrossing(a, b);
    ASSERT_TRUE(crossing);
    EXPECT_EQ(crossing->t, 0);
    ExpectSound({a, b, "", true, 0, 0, 0}, *crossing, 1e-15);
  }
}

TEST(FindFirstCrossing, TakesAnyFiniteNumber) {
  const double huge = std::numeric_limits<double>::max(), tiny = std::numeric_limits<double>::denorm_min();
  for (const double x : {huge, tiny, 1.0}) {
    for (const double z : {huge, tiny}) {
      const MovingSegment a = Segment({-x, 0, z}, {x, 0, z}, {-x, 0, -z}, {x, 0, -z});
      const MovingSegment b = Segment({0, -x, 0}, {0, x, 0}, {0, -x, 0}, {0, x, 0});
      const auto crossing = FindFirstCrossing(a, b);
      ASSERT_TRUE(crossing) << x << " " << z;
      EXPECT_NEAR(crossing->t, 0.5, 1e-9);
      EXPECT_NEAR(crossing->u, 0.5, 1e-9);
      EXPECT_NEAR(crossing->v, 0.5, 1e-9);
      const MovingSegment beside = Segment({0, tiny, 0}, {0, x, 0}, {0, tiny, 0}, {0, x, 0});
      EXPECT_FALSE(FindFirstCrossing(a, beside)) << x << " " << z;
    }
  }
}

/// Kept queries, with answers of make_crossing_queries: no build of the code under test has a share in them.
TEST(FindFirstCrossing, AgreesWithKeptQueries) {
  const auto queries = ReadCrossingQueries(MESHLESS_CUTTING_TEST_DIR "/data/crossing/edge_edge.csv");
  EXPECT_GE(queries.size(), 300u);
  for (const CrossingQuery& query : queries) {
    SCOPED_TRACE(query.category + " line " + std::to_string(query.line));
    const auto crossing = FindFirstCrossing(query.a, query.b);
    ASSERT_EQ(crossing.has_value(), query.truth);
    if (!crossing) continue;
    EXPECT_NEAR(crossing->t, query.time_of_contact, kTimeAccuracy * query.time_of_contact);
    ExpectSound(query, *crossing, 1e-7);
  }
}

class RandomKind : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, RandomKind, ::testing::ValuesIn(RandomKinds()),
                         [](const auto& kind) { return kind.param; });

TEST_P(RandomKind, AgreesWithTheReference) {
  constexpr int kQueries = 150;
  std::mt19937_64 random(20);
  for (int i = 0; i < kQueries; ++i) {
    const CrossingQuery query = RandomQuery(GetParam(), random);
    SCOPED_TRACE(ToLine(query));
    const auto expected = ReferenceFirstContact(query.a, query.b);
    const auto crossing = FindFirstCrossing(query.a, query.b);
    ASSERT_EQ(crossing.has_value(), expected.has_value());
    if (!crossing) continue;
    EXPECT_NEAR(crossing->t, *expected, kTimeAccuracy * *expected);
    ExpectSound(query, *crossing, 1e-7);
  }
}

/// The filters may only save time.
TEST_P(RandomKind, FiltersAgreeWithTheExactStage) {
  constexpr int kQueries = 4000;
  std::mt19937_64 random(21);
  int hits = 0;
  for (int i = 0; i < kQueries; ++i) {
    const CrossingQuery query = RandomQuery(GetParam(), random);
    SCOPED_TRACE(ToLine(query));
    const auto crossing = FindFirstCrossing(query.a, query.b);
    ExpectSame(exact::DecideCrossing(query.a, query.b), crossing);
    if (HasFatalFailure()) return;
    hits += crossing.has_value();
  }
  EXPECT_GT(hits, kQueries / 100);
  if (GetParam() == "shared_corner" || GetParam() == "collinear") return;
  EXPECT_LT(hits, kQueries * 99 / 100);
}

TEST_P(RandomKind, HasTheSymmetriesOfTheProblem) {
  constexpr int kQueries = 2000;
  std::mt19937_64 random(22);
  for (int i = 0; i < kQueries; ++i) {
    const CrossingQuery query = RandomQuery(GetParam(), random);
    SCOPED_TRACE(ToLine(query));
    const MovingSegment &a = query.a, &b = query.b;
    const auto crossing = FindFirstCrossing(a, b);
    ExpectSame(crossing, FindFirstCrossing(b, a));
    ExpectSame(crossing, FindFirstCrossing(Swapped(a), b));
    ExpectSame(crossing, FindFirstCrossing(a, Swapped(b)));
    EXPECT_EQ(crossing.has_value(), FindFirstCrossing(Reversed(a), Reversed(b)).has_value());
    const auto axes_turned = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.z(), -p.x(), p.y()); };
    ExpectSame(crossing, FindFirstCrossing(Changed(a, axes_turned), Changed(b, axes_turned)));
    if (GetParam() != "scaled") {
      for (const int exponent : {-300, -20, 40, 320}) {
        const auto scaled = [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(std::ldexp(1, exponent) * p); };
        ExpectSame(crossing, FindFirstCrossing(Changed(a, scaled), Changed(b, scaled)));
      }
    }
    if (HasFatalFailure()) return;
  }
}

/// Sums with a power of two are exact for these.
TEST(FindFirstCrossing, DoesNotDependOnTheOrigin) {
  std::mt19937_64 random(23);
  for (int i = 0; i < 3000; ++i) {
    const CrossingQuery query = RandomQuery(i % 2 == 0 ? "integers_2" : "coplanar", random);
    const auto moved = [](const Eigen::Vector3d& p) {
      return Eigen::Vector3d(p + Eigen::Vector3d(0x1p40, -0x1p30, 12345));
    };
    SCOPED_TRACE(ToLine(query));
    ExpectSame(FindFirstCrossing(query.a, query.b),
               FindFirstCrossing(Changed(query.a, moved), Changed(query.b, moved)));
  }
}

}  // namespace
}  // namespace meshless_cutting::test
