// Time of the crossing test on the pairs that a broad phase leaves over, beside a plain double-precision solver (Provot
// 1997: roots of the cubic, then the proportions at each) that promises nothing.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>

#include "crossing/edge_edge.h"
#include "crossing/random_queries.h"

namespace meshless_cutting::test {
namespace {

using Eigen::Vector3d;

double Det(const Vector3d& x, const Vector3d& y, const Vector3d& z) {
  return x[0] * (y[1] * z[2] - y[2] * z[1]) + x[1] * (y[2] * z[0] - y[0] * z[2]) + x[2] * (y[0] * z[1] - y[1] * z[0]);
}

/// Real roots of k0 + k1 t + k2 t^2 + k3 t^3 in order, by the closed formula.
int CubicRoots(double k0, double k1, double k2, double k3, std::array<double, 3>& roots) {
  const double size = std::abs(k0) + std::abs(k1) + std::abs(k2) + std::abs(k3);
  if (std::abs(k3) < 1e-14 * size) {
    if (std::abs(k2) < 1e-14 * size) {
      roots[0] = -k0 / k1;
      return k1 != 0;
    }
    const double discriminant = k1 * k1 - 4 * k0 * k2;
    if (discriminant < 0) return 0;
    const double w = -0.5 * (k1 + std::copysign(std::sqrt(discriminant), k1));
    roots[0] = w / k2, roots[1] = k0 / w;
    std::sort(roots.begin(), roots.begin() + 2);
    return 2;
  }
  const double a = k2 / k3, b = k1 / k3, c = k0 / k3;
  const double q = (a * a - 3 * b) / 9, r = (2 * a * a * a - 9 * a * b + 27 * c) / 54;
  if (r * r >= q * q * q) {
    const double w = -std::copysign(std::cbrt(std::abs(r) + std::sqrt(r * r - q * q * q)), r);
    roots[0] = w + (w == 0 ? 0 : q / w) - a / 3;
    return 1;
  }
  const double angle = std::acos(r / std::sqrt(q * q * q)), length = -2 * std::sqrt(q);
  constexpr double kTurn = 6.283185307179586;
  for (int i = 0; i < 3; ++i) roots[i] = length * std::cos((angle + kTurn * (i - 1)) / 3) - a / 3;
  std::sort(roots.begin(), roots.end());
  return 3;
}

std::optional<EdgeCrossing> PlainProvot(const MovingSegment& s, const MovingSegment& r) {
  for (int k = 0; k < 3; ++k) {
    const auto [s_lo, s_hi] = std::minmax({s.p_t0[k], s.q_t0[k], s.p_t1[k], s.q_t1[k]});
    const auto [r_lo, r_hi] = std::minmax({r.p_t0[k], r.q_t0[k], r.p_t1[k], r.q_t1[k]});
    if (s_lo > r_hi || r_lo > s_hi) return std::nullopt;
  }
  const Vector3d a0 = s.q_t0 - s.p_t0, b0 = r.q_t0 - r.p_t0, c0 = r.p_t0 - s.p_t0;
  const Vector3d da = s.q_t1 - s.p_t1 - a0, db = r.q_t1 - r.p_t1 - b0, dc = r.p_t1 - s.p_t1 - c0;
  std::array<double, 3> roots;
  const int count = CubicRoots(Det(a0, b0, c0), Det(da, b0, c0) + Det(a0, db, c0) + Det(a0, b0, dc),
                               Det(da, db, c0) + Det(da, b0, dc) + Det(a0, db, dc), Det(da, db, dc), roots);
  for (int i = 0; i < count; ++i) {
    const double t = roots[i];
    if (!(t >= 0 && t <= 1)) continue;
    const Vector3d a = a0 + t * da, b = b0 + t * db, c = c0 + t * dc;
    const double aa = a.dot(a), ab = a.dot(b), bb = b.dot(b), ac = a.dot(c), bc = b.dot(c), det = aa * bb - ab * ab;
    const double u = (ac * bb - bc * ab) / det, v = (ac * ab - bc * aa) / det;
    if (u >= 0 && u <= 1 && v >= 0 && v <= 1) return EdgeCrossing{t, u, v};
  }
  return std::nullopt;
}

/// Edges of a deforming grid of spacing h and a blade edge of length 4 h that sweeps through: pairs with touching
/// boxes.
std::vector<CrossingQuery> MeshPairs() {
  constexpr double kSpacing = 0.02;
  constexpr size_t kPairs = 2000;
  std::mt19937_64 random(31);
  std::vector<CrossingQuery> pairs;
  const auto real = [&random] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  const auto any = [&] { return Vector3d(real(), real(), real()); };
  while (pairs.size() < kPairs) {
    CrossingQuery query;
    query.b.p_t0 = 0.1 * any();
    query.b.q_t0 = query.b.p_t0 + kSpacing * any();
    query.b.p_t1 = query.b.p_t0 + 0.1 * kSpacing * any();
    query.b.q_t1 = query.b.q_t0 + 0.1 * kSpacing * any();
    query.a.p_t0 = query.b.p_t0 + 2 * kSpacing * any();
    query.a.q_t0 = query.a.p_t0 + 4 * kSpacing * any();
    const Vector3d step = 0.5 * kSpacing * any();
    query.a.p_t1 = query.a.p_t0 + step;
    query.a.q_t1 = query.a.q_t0 + step + 0.05 * kSpacing * any();
    bool overlap = true;
    for (int k = 0; k < 3; ++k) {
      const auto [a_lo, a_hi] = std::minmax({query.a.p_t0[k], query.a.q_t0[k], query.a.p_t1[k], query.a.q_t1[k]});
      const auto [b_lo, b_hi] = std::minmax({query.b.p_t0[k], query.b.q_t0[k], query.b.p_t1[k], query.b.q_t1[k]});
      overlap = overlap && a_lo <= b_hi && b_lo <= a_hi;
    }
    if (overlap) pairs.push_back(query);
  }
  return pairs;
}

template <class Test>
void Run(benchmark::State& state, const std::vector<CrossingQuery>& queries, Test test) {
  size_t i = 0, hits = 0, runs = 0;
  for (auto _ : state) {
    const auto crossing = test(queries[i].a, queries[i].b);
    benchmark::DoNotOptimize(crossing);
    hits += crossing.has_value();
    ++runs;
    i = i + 1 == queries.size() ? 0 : i + 1;
  }
  state.counters["hit_rate"] = static_cast<double>(hits) / static_cast<double>(runs);
}

void MeshPairsCertain(benchmark::State& state) { Run(state, MeshPairs(), FindFirstCrossing); }
BENCHMARK(MeshPairsCertain);
void MeshPairsPlainProvot(benchmark::State& state) { Run(state, MeshPairs(), PlainProvot); }
BENCHMARK(MeshPairsPlainProvot);

/// Both in one loop over the same pairs, so that load on the machine falls on both: what certainty costs.
void MeshPairsRatioToPlainProvot(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  const std::vector<CrossingQuery> queries = MeshPairs();
  std::chrono::duration<double> certain{}, plain{};
  const auto time = [&queries](auto test) {
    const auto begin = Clock::now();
    for (const CrossingQuery& query : queries) {
      const auto crossing = test(query.a, query.b);
      benchmark::DoNotOptimize(crossing);
    }
    return Clock::now() - begin;
  };
  for (auto _ : state) {
    certain += time(FindFirstCrossing);
    plain += time(PlainProvot);
  }
  const double calls = static_cast<double>(state.iterations()) * static_cast<double>(queries.size());
  state.counters["certain_ns"] = certain.count() * 1e9 / calls;
  state.counters["plain_ns"] = plain.count() * 1e9 / calls;
  state.counters["ratio"] = certain / plain;
}
BENCHMARK(MeshPairsRatioToPlainProvot);

void Kind(benchmark::State& state, const std::string& kind) {
  std::mt19937_64 random(32);
  std::vector<CrossingQuery> queries;
  for (int i = 0; i < 500; ++i) queries.push_back(RandomQuery(kind, random));
  Run(state, queries, FindFirstCrossing);
}

const int kRegistered = [] {
  for (const std::string& kind : RandomKinds()) {
    benchmark::RegisterBenchmark(("Kind/" + kind).c_str(), [kind](benchmark::State& state) { Kind(state, kind); });
  }
  return 0;
}();

}  // namespace
}  // namespace meshless_cutting::test

BENCHMARK_MAIN();
