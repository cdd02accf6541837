// The rounding bounds of the crossing filters against rational arithmetic, on random and on adversarial numbers.
#include <gtest/gtest.h>

#include <cmath>

#include "crossing/exact_form.h"
#include "crossing/fixed_pair.h"
#include "crossing/random_queries.h"
#include "crossing/rational_polynomial.h"
#include "crossing/rounded_pair.h"

namespace meshless_cutting::test {
namespace {

using RationalPair = PairPolynomials<Rational, Rational, Rational>;

RationalPair Exact(const CrossingQuery& query) {
  CrossingQuery copy = query;
  RationalPair::Ends ends;
  for (int i = 0; i < 24; ++i) ends[i / 3][i % 3] = Rational((*Points(copy)[i / 3])[i % 3]);
  return RationalPair(ends);
}

/// Bernstein coefficients times binomials.
template <size_t size>
Rational Value(const std::array<Rational, size>& c, const Rational& t) {
  Rational value = 0, weight = 1;
  for (size_t i = 0; i < size; ++i) {
    Rational term = c[i];
    for (size_t j = 0; j < i; ++j) term *= t;
    for (size_t j = i + 1; j < size; ++j) term *= 1 - t;
    value += term;
  }
  return value;
}

/// |computed - exact| / bound
double Ratio(double computed, const Rational& exact, double bound) {
  const Rational error = abs(Rational(computed) - exact);
  return error == 0 ? 0 : Rational(error / Rational(bound)).convert_to<double>();
}

/// Numbers whose products round badly (mantissas next to powers of two), of one size, or of many.
double Nasty(std::mt19937_64& random) {
  const double sign = random() % 2 == 0 ? 1 : -1;
  const double ulp = 0x1p-52;
  switch (random() % 5) {
    case 0:
      return sign * (1 + static_cast<double>(random() % 8) * ulp);
    case 1:
      return sign * (2 - static_cast<double>(1 + random() % 8) * ulp);
    case 2:
      return sign * (1 + 0x1p-26 + static_cast<double>(random() % 8) * ulp);
    case 3:
      return sign * std::ldexp(1 + static_cast<double>(random() >> 12) * 0x1p-52, -static_cast<int>(random() % 40));
    default:
      return sign * (1 + static_cast<double>(random() >> 12) * 0x1p-52);
  }
}

CrossingQuery NastyQuery(std::mt19937_64& random) {
  CrossingQuery query;
  for (Eigen::Vector3d* point : Points(query)) *point << Nasty(random), Nasty(random), Nasty(random);
  if (random() % 3 == 0) {  // nearly parallel and nearly touching: all cancels
    query.b.p_t0 = query.a.p_t0 + 0x1p-40 * query.b.p_t0;
    query.b.q_t0 = query.a.q_t0 + 0x1p-40 * query.b.q_t0;
    query.b.p_t1 = query.a.p_t1 + 0x1p-40 * query.b.p_t1;
    query.b.q_t1 = query.a.q_t1 + 0x1p-40 * query.b.q_t1;
  }
  return query;
}

std::vector<CrossingQuery> Queries() {
  std::mt19937_64 random(5);
  std::vector<CrossingQuery> queries;
  for (int i = 0; i < 600; ++i) queries.push_back(NastyQuery(random));
  for (const char* kind : {"reals", "near_parallel", "tangent", "moving", "end_touch"}) {
    for (int i = 0; i < 60; ++i) queries.push_back(RandomQuery(kind, random));
  }
  return queries;
}

constexpr double kTimes[] = {0, 1, 0.5, 1.0 / 3, 0x1.fffffffffffffp-1, 0x1p-30, 0.7071067811865476};

template <class Pair>
void ExpectQuadraticsWithinBounds(const Pair& pair, const RationalPair& exact, double& worst) {
  for (int k = 0; k < 3; ++k) {
    const auto n = exact.n[k], p = exact.P(k), q = exact.Q(k);
    const auto minus_n = [&](const RationalPair::Quadratic& x) -> RationalPair::Quadratic {
      return {x[0] - n[0], x[1] - n[1], x[2] - n[2]};
    };
    const EndSides a = pair.EndsOfA(k), b = pair.EndsOfB(k);
    const std::pair<BoundedQuadratic, RationalPair::Quadratic> cases[] = {
        {pair.N(k), n}, {a.first, p}, {a.second, minus_n(p)}, {b.first, q}, {b.second, minus_n(q)}};
    for (const auto& [bounded, truth] : cases) {
      for (const double t : kTimes) {
        const double ratio = Ratio(bounded.Polar(t, t), Value(truth, Rational(t)), bounded.error);
        EXPECT_LE(ratio, 1);
        worst = std::max(worst, ratio);
        // slope: |2 ((1 - t) (c1 - c0) + t (c2 - c1))| with c1 = truth[1] / 2
        const Rational s =
            2 * ((1 - Rational(t)) * (truth[1] / 2 - truth[0]) + Rational(t) * (truth[2] - truth[1] / 2));
        EXPECT_LE(Rational(abs(s)), Rational(bounded.slope));
      }
    }
  }
}

TEST(RoundedPair, StaysWithinItsBounds) {
  double worst_cubic = 0, worst_quadratic = 0;
  for (const CrossingQuery& query : Queries()) {
    SCOPED_TRACE(ToLine(query));
    const RationalPair exact = Exact(query);
    const auto f = exact.Coplanarity();
    RoundedPair pair(query.a, query.b);
    ASSERT_TRUE(pair.InRange());
    const BoundedCubic cubic = pair.Coplanarity();
    for (const double t : kTimes) {
      const double ratio = Ratio(cubic.At(t), Value(f, Rational(t)), cubic.error);
      EXPECT_LE(ratio, 1);
      worst_cubic = std::max(worst_cubic, ratio);
    }
    // The ends of On(s, t) are values; its inner coefficients are checked through the value in the middle.
    const BoundedCubic part = cubic.On(0.25, 0.7);
    EXPECT_LE(Ratio(part.c0, Value(f, Rational(0.25)), cubic.error), 1);
    EXPECT_LE(Ratio(part.c3, Value(f, Rational(0.7)), cubic.error), 1);
    const Rational middle = (Rational(part.c0) + 3 * Rational(part.c1) + 3 * Rational(part.c2) + Rational(part.c3)) / 8;
    EXPECT_LE(Rational(abs(middle - Value(f, (Rational(0.25) + Rational(0.7)) / 2))), Rational(cubic.error));
    ExpectQuadraticsWithinBounds(pair, exact, worst_quadratic);
  }
  // Constants that are never nearly used up would be guesses.
  EXPECT_GT(worst_cubic, 0.02);
  EXPECT_GT(worst_quadratic, 0.05);
}

TEST(RoundedPair, RefusesWhatCouldOverflow) {
  CrossingQuery query = Queries()[0];
  for (Eigen::Vector3d* point : Points(query)) *point *= 0x1p201;
  EXPECT_FALSE(RoundedPair(query.a, query.b).InRange());
  query.a.p_t0.x() = -std::numeric_limits<double>::max();
  query.a.q_t0.x() = std::numeric_limits<double>::max();  // the difference overflows
  EXPECT_FALSE(RoundedPair(query.a, query.b).InRange());
}

TEST(RoundedPair, BoundsHoldWhereProductsUnderflow) {
  for (CrossingQuery query : Queries()) {
    for (Eigen::Vector3d* point : Points(query)) *point *= 0x1p-330;
    const RationalPair exact = Exact(query);
    RoundedPair pair(query.a, query.b);
    const BoundedCubic cubic = pair.Coplanarity();
    for (const double t : kTimes)
      EXPECT_LE(Ratio(cubic.At(t), Value(exact.Coplanarity(), Rational(t)), cubic.error), 1);
    double worst = 0;
    ExpectQuadraticsWithinBounds(pair, exact, worst);
  }
}

TEST(FixedPair, QuadraticsStayWithinTheirBounds) {
  double worst = 0;
  std::mt19937_64 random(6);
  for (int i = 0; i < 300; ++i) {
    CrossingQuery query;
    for (Eigen::Vector3d* point : Points(query)) {
      for (int k = 0; k < 3; ++k) (*point)[k] = std::trunc(Nasty(random) * 0x1p52);
    }
    query.a.p_t0.x() = 1;  // so that the integers are the coordinates themselves
    const FixedPair pair(IntegerCoordinates(query.a, query.b));
    ExpectQuadraticsWithinBounds(pair, Exact(query), worst);
  }
  EXPECT_GT(worst, 0.05);
}

TEST(FixedInteger, AgreesWithUnboundedIntegers) {
  std::mt19937_64 random(7);
  const auto any = [&random](auto& x) {
    const auto limb = [&random] { return random() % 4 == 0 ? 0 : random() % 4 == 0 ? ~std::uint64_t{0} : random(); };
    for (Word& word : x.word) word = (static_cast<Word>(limb()) << 64) | limb();
    x.word.back() >>= 2;  // sums fit
    if (random() % 2 == 0) x = std::decay_t<decltype(x)>() - x;
  };
  for (int i = 0; i < 5000; ++i) {
    FixedInteger<1> x, y;
    FixedInteger<2> z, w;
    any(x), any(y), any(z), any(w);
    EXPECT_EQ(exact::ToInteger(x * y), exact::ToInteger(x) * exact::ToInteger(y));
    EXPECT_EQ(exact::ToInteger(z * y), exact::ToInteger(z) * exact::ToInteger(y));
    EXPECT_EQ(exact::ToInteger(z + w), exact::ToInteger(z) + exact::ToInteger(w));
    EXPECT_EQ(exact::ToInteger(z - w), exact::ToInteger(z) - exact::ToInteger(w));
    EXPECT_EQ(z.Sign(), exact::ToInteger(z).sign());
    EXPECT_LE(Ratio(z.ToDouble(), Rational(boost::multiprecision::cpp_int(exact::ToInteger(z))),
                    0x1p-51 * std::abs(z.ToDouble()) + 0x1p-1000),
              1);
  }
}

}  // namespace
}  // namespace meshless_cutting::test
