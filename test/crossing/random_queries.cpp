#include "crossing/random_queries.h"

#include <cmath>
#include <functional>
#include <map>

namespace meshless_cutting::test {
namespace {

using Eigen::Vector3d;

class Source {
 public:
  explicit Source(std::mt19937_64& random) : random_(random) {}
  int Integer(int lo, int hi) { return lo + static_cast<int>(random_() % static_cast<unsigned>(hi - lo + 1)); }
  double Real() { return static_cast<double>(random_() >> 11) * 0x1p-52 - 1; }  // [-1, 1)
  Vector3d Small(int reach) {
    const int x = Integer(-reach, reach), y = Integer(-reach, reach), z = Integer(-reach, reach);
    return Vector3d(x, y, z);
  }
  Vector3d Any() {
    const double x = Real(), y = Real(), z = Real();
    return Vector3d(x, y, z);
  }
  double Ulps(double x) {  // x or one of its neighbours
    const int step = Integer(-1, 1);
    return step == 0 ? x : std::nextafter(x, step * HUGE_VAL);
  }

 private:
  std::mt19937_64& random_;
};

template <class Make>
CrossingQuery Fill(Make make) {
  CrossingQuery query;
  for (Vector3d* point : Points(query)) *point = make();
  return query;
}

/// Coordinates 0, +-1, ... +-reach: degenerate more often than not.
CrossingQuery SmallIntegers(Source& source, int reach) {
  return Fill([&] { return source.Small(reach); });
}

CrossingQuery Reals(Source& source) {
  CrossingQuery query = Fill([&] { return source.Any(); });
  return query;
}

/// A vertex of one edge is one of the other, at all times.
CrossingQuery SharedCorner(Source& source) {
  CrossingQuery query = Reals(source);
  query.b.q_t0 = query.a.p_t0;
  query.b.q_t1 = query.a.p_t1;
  return query;
}

/// All points stay in one plane, exactly: a plane of small integer direction, coordinates of few bits.
CrossingQuery Coplanar(Source& source) {
  const Vector3d e0 = source.Small(3), e1 = source.Small(3), origin = source.Small(8);
  return Fill([&] {
    const double x = source.Integer(-40, 40), y = source.Integer(-40, 40);
    return Vector3d(origin + x * e0 + y * e1);
  });
}

CrossingQuery Collinear(Source& source) {
  const Vector3d e = source.Small(2), origin = source.Small(4), motion = source.Small(3);
  int i = 0;
  return Fill([&] {
    const double x = source.Integer(-12, 12);
    return Vector3d(origin + x * e + (i++ < 4 ? 0.0 : 1.0) * motion);
  });
}

/// One edge or both are points, at times or always.
CrossingQuery ZeroLength(Source& source) {
  CrossingQuery query = SmallIntegers(source, 2);
  if (source.Integer(0, 3) != 0) query.a.q_t0 = query.a.p_t0;
  if (source.Integer(0, 3) != 0) query.a.q_t1 = query.a.p_t1;
  if (source.Integer(0, 3) == 0) query.b.q_t0 = query.b.p_t0;
  if (source.Integer(0, 3) == 0) query.b.q_t1 = query.b.p_t1;
  return query;
}

/// An end of a lies on b at t = 1/4, 1/2 or 3/4, exactly, or is off by a unit in the last place of one coordinate.
CrossingQuery EndTouch(Source& source) {
  CrossingQuery query = SmallIntegers(source, 1000);
  const double t = 0.25 * source.Integer(1, 3), v = 0.125 * source.Integer(0, 8);
  const Vector3d b_p = (1 - t) * query.b.p_t0 + t * query.b.p_t1, b_q = (1 - t) * query.b.q_t0 + t * query.b.q_t1;
  const Vector3d target = (1 - v) * b_p + v * b_q;
  const Vector3d velocity = 4 * source.Small(300);  // few bits: all of this is exact
  query.a.p_t0 = target - t * velocity;
  query.a.p_t1 = target + (1 - t) * velocity;
  if (source.Integer(0, 1) == 0) {
    double& x = query.a.p_t0[source.Integer(0, 2)];
    x = source.Ulps(x);
  }
  return query;
}

/// The coplanarity cubic has a double root, or nearly: b moves along z by (2 t - 1), a turns, both through the origin.
CrossingQuery Tangent(Source& source) {
  CrossingQuery query = SmallIntegers(source, 20);
  const double touch = 0.25 * source.Integer(1, 3), scale = source.Integer(1, 9);
  // a along x at height z(u, t), b along y at height 0: with a's ends at heights s (t - touch) and its mirror image, u
  // moves with t as well, so that the height at the crossing is a square.
  query.a.p_t0 = Vector3d(-8 * touch, 0, 8 * scale * touch * touch);
  query.a.p_t1 = Vector3d(8 - 8 * touch, 0, 8 * scale * touch * (touch - 1));
  query.a.q_t0 = query.a.p_t0 + Vector3d(8, 0, -8 * scale * touch);
  query.a.q_t1 = query.a.p_t1 + Vector3d(8, 0, 8 * scale * (1 - touch));
  query.b.p_t0 = query.b.p_t1 = Vector3d(0, -1.0 - source.Integer(0, 3), 0);
  query.b.q_t0 = query.b.q_t1 = Vector3d(0, 1.0 + source.Integer(0, 3), 0);
  if (source.Integer(0, 2) != 0) {
    double& x = (*Points(query)[source.Integer(0, 7)])[source.Integer(0, 2)];
    x = x == 0 ? source.Integer(-1, 1) * 0x1p-50 : source.Ulps(x);
  }
  return query;
}

/// Two edges of nearly one direction.
CrossingQuery NearParallel(Source& source) {
  CrossingQuery query = Reals(source);
  const double angle = std::ldexp(1.0, source.Integer(-45, -3));
  // b passes through a with a small offset along it.
  const Vector3d offset = source.Any(), a_t0 = query.a.q_t0 - query.a.p_t0, a_t1 = query.a.q_t1 - query.a.p_t1;
  query.b.p_t0 = query.a.p_t0 - 0.3 * a_t0 + angle * offset;
  query.b.p_t1 = query.a.p_t1 - 0.3 * a_t1 - angle * offset;
  query.b.q_t0 = query.b.p_t0 + a_t0 + angle * source.Any();
  query.b.q_t1 = query.b.p_t1 + a_t1 + angle * source.Any();
  return query;
}

/// Fast, static, tiny and far from the origin, by turns.
CrossingQuery Moving(Source& source) {
  CrossingQuery query = Reals(source);
  switch (source.Integer(0, 3)) {
    case 0:
      query.a.p_t1 = query.a.p_t0;
      query.a.q_t1 = query.a.q_t0;
      break;
    case 1:
      query.b.p_t1 = query.b.p_t0;
      query.b.q_t1 = query.b.q_t0;
      break;
    case 2:
      query.a.p_t1 += 100 * (query.b.p_t0 - query.a.p_t0);
      query.a.q_t1 += 100 * (query.b.p_t0 - query.a.p_t0);
      break;
    default:
      for (Vector3d* point : Points(query)) *point = Vector3d(1000, -700, 300) + 1e-6 * *point;
  }
  return query;
}

/// Any kind but itself, times a power of two beyond which cubes leave the range of doubles.
CrossingQuery Scaled(Source& source, std::mt19937_64& random) {
  const std::vector<std::string>& kinds = RandomKinds();
  CrossingQuery query = RandomQuery(kinds[source.Integer(0, static_cast<int>(kinds.size()) - 2)], random);
  const int exponent = source.Integer(340, 960) * (source.Integer(0, 1) == 0 ? 1 : -1);
  for (Vector3d* point : Points(query)) {
    for (int k = 0; k < 3; ++k) (*point)[k] = std::ldexp((*point)[k], exponent);
  }
  return query;
}

}  // namespace

const std::vector<std::string>& RandomKinds() {
  static const std::vector<std::string> kinds = {
      "integers_1",  "integers_2", "integers_50", "reals",         "shared_corner", "coplanar", "collinear",
      "zero_length", "end_touch",  "tangent",     "near_parallel", "moving",        "scaled"};
  return kinds;
}

CrossingQuery RandomQuery(const std::string& kind, std::mt19937_64& random) {
  Source source(random);
  const std::map<std::string, std::function<CrossingQuery()>> makers = {
      {"integers_1", [&] { return SmallIntegers(source, 1); }},
      {"integers_2", [&] { return SmallIntegers(source, 2); }},
      {"integers_50", [&] { return SmallIntegers(source, 50); }},
      {"reals", [&] { return Reals(source); }},
      {"shared_corner", [&] { return SharedCorner(source); }},
      {"coplanar", [&] { return Coplanar(source); }},
      {"collinear", [&] { return Collinear(source); }},
      {"zero_length", [&] { return ZeroLength(source); }},
      {"end_touch", [&] { return EndTouch(source); }},
      {"tangent", [&] { return Tangent(source); }},
      {"near_parallel", [&] { return NearParallel(source); }},
      {"moving", [&] { return Moving(source); }},
      {"scaled", [&] { return Scaled(source, random); }},
  };
  CrossingQuery query = makers.at(kind)();
  query.category = kind;
  return query;
}

}  // namespace meshless_cutting::test
