// The loops over points against what the machine can do, all measured in the same run: share of the peak of one thread
// and of its bandwidth, speed-up by a second thread, growth with the number of points.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <vector>

#include "dynamics/elastic_points.h"
#include "dynamics/instruction_sets.h"
#include "support/box_tissue.h"

namespace meshless_cutting {
namespace {

// Operations and least bytes from memory per point of a full cell, stable neo-Hookean, counted in point_kernels.inl:
// two fast Hadamard transforms 144, gradient and its transpose 18, stabilisation 38, the law 123 (forces) or 261
// (product), scaling by volume 9, gathered sums 24. Indices of slots 16, of their particles 6, volume, box and
// stabilisation 40, field and result 64; product, in single precision: field and result 32, tangent 56.
constexpr double kForceFlops = 356, kProductFlops = 494;
constexpr double kForceBytes = 126, kProductBytes = 150;

/// Time of this process's processors: neighbours on a busy machine do not count.
double ProcessorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
double WallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The least of several times of `work`, s.
template <class Clock, class Work>
double BestOf(int tries, Clock clock, const Work& work) {
  double best = 1e300;
  for (int n = 0; n < tries; ++n) {
    const double start = clock();
    work();
    best = std::min(best, clock() - start);
  }
  return best;
}

constexpr int kSums = 96, kRounds = 200000;

/// Multiplications and additions on sums that all stay in registers or the nearest cache; not fused, as in the loops.
MESHLESS_CUTTING_CLONES double MultiplyAndAdd(double factor) {
  double sums[kSums];
  for (int i = 0; i < kSums; ++i) sums[i] = i;
  for (int n = 0; n < kRounds; ++n) {
    for (int i = 0; i < kSums; ++i) sums[i] = sums[i] * factor + factor;
  }
  double sum = 0;
  for (int i = 0; i < kSums; ++i) sum += sums[i];
  return sum;
}
MESHLESS_CUTTING_CLONES float SingleMultiplyAndAdd(float factor) {
  float sums[2 * kSums];
  for (int i = 0; i < 2 * kSums; ++i) sums[i] = static_cast<float>(i);
  for (int n = 0; n < kRounds; ++n) {
    for (int i = 0; i < 2 * kSums; ++i) sums[i] = sums[i] * factor + factor;
  }
  float sum = 0;
  for (int i = 0; i < 2 * kSums; ++i) sum += sums[i];
  return sum;
}

MESHLESS_CUTTING_CLONES void Triad(const double* a, const double* b, double factor, int count, double* c) {
  for (int i = 0; i < count; ++i) c[i] = a[i] + factor * b[i];
}

struct Machine {
  double flops, single_flops, bytes_per_s;  // one thread
};

Machine MeasureMachine() {
  constexpr int kCount = 1 << 23;  // three arrays of 64 MB
  const std::vector<double> a(kCount, 1.0), b(kCount, 2.0);
  std::vector<double> c(kCount);
  const double peak = BestOf(5, ProcessorSeconds, [] { benchmark::DoNotOptimize(MultiplyAndAdd(0.999)); });
  const double single_peak =
      BestOf(5, ProcessorSeconds, [] { benchmark::DoNotOptimize(SingleMultiplyAndAdd(0.999F)); });
  const double triad = BestOf(5, ProcessorSeconds, [&] {
    Triad(a.data(), b.data(), 3, kCount, c.data());
    benchmark::DoNotOptimize(c.data());
    benchmark::ClobberMemory();
  });
  return {2.0 * kSums * kRounds / peak, 4.0 * kSums * kRounds / single_peak, 3.0 * sizeof(double) * kCount / triad};
}

/// A cube of n^3 full cells, slightly stretched.
struct Cube {
  Cube(int n, int threads) : pool(threads), points({MaterialModel::kStableNeoHookean, 5e3, 0.45, 1050}, pool) {
    BoxTissueConfig config;
    config.cells = {n, n, n};
    config.size = Eigen::Vector3d::Constant(0.0065 * n);
    tissue = MakeBoxTissue(config);
    points.TissueChanged(tissue);
    points.Resize(tangent);
    for (const Eigen::Vector3d& X : tissue.particle_rest) {
      x.push_back(Vector4::From(1.01 * X));
      p.push_back(Round(x.back()));
    }
    y.resize(x.size());
    q.resize(x.size());
    ones.assign(x.size(), 1);
    points.Linearise(x, true, tangent);
  }
  void Forces() { benchmark::DoNotOptimize(points.Evaluate(x, y)); }
  void Product() {
    points.ProductInSlots(tangent, p);
    const int count = static_cast<int>(p.size());
    pool.ForEach(ChunkCount(count, kParticlesPerChunk), [&](int c) {
      GatherProduct(ParticleRange(c, count), points.single_slot_sums(), 1, ones.data(), ones.data(), p.data(),
                    q.data());
    });
  }

  ThreadPool pool;
  ElasticPoints points;
  Tissue tissue;
  Field x, y;
  SingleField p, q;
  std::vector<double> ones;
  SinglePointTangent tangent;
};

/// Seconds of one call, the best of some stretches of about as many point evaluations each.
template <class Clock, class Work>
double SecondsOf(int points, Clock clock, const Work& work) {
  const int calls = std::max(1, 400000 / points);
  return BestOf(7, clock,
                [&] {
                  for (int n = 0; n < calls; ++n) work();
                }) /
         calls;
}

void ShareOfMachine(benchmark::State& state) {
  Machine machine{};
  double force = 0, product = 0;
  Cube cube(static_cast<int>(state.range(0)), 1);
  const int points = cube.tissue.point_count();
  for (auto _ : state) {
    machine = MeasureMachine();
    force = SecondsOf(points, ProcessorSeconds, [&] { cube.Forces(); }) / points;
    product = SecondsOf(points, ProcessorSeconds, [&] { cube.Product(); }) / points;
  }
  state.counters["points"] = points;
  state.counters["peak_gflops"] = 1e-9 * machine.flops;
  state.counters["single_peak_gflops"] = 1e-9 * machine.single_flops;
  state.counters["triad_gb_s"] = 1e-9 * machine.bytes_per_s;
  state.counters["force_ns"] = 1e9 * force;
  state.counters["force_of_peak"] = kForceFlops / force / machine.flops;
  state.counters["force_of_triad"] = kForceBytes / force / machine.bytes_per_s;
  state.counters["product_ns"] = 1e9 * product;
  state.counters["product_of_peak"] = kProductFlops / product / machine.single_flops;
  state.counters["product_of_triad"] = kProductBytes / product / machine.bytes_per_s;
}

/// One thread against two, in turns; wall time.
void SpeedUpOfTwoThreads(benchmark::State& state) {
  Cube one(static_cast<int>(state.range(0)), 1), two(static_cast<int>(state.range(0)), 2);
  const int points = one.tissue.point_count();
  double force[2] = {1e300, 1e300}, product[2] = {1e300, 1e300};
  for (auto _ : state) {
    for (int turn = 0; turn < 4; ++turn) {
      for (int n = 0; n < 2; ++n) {
        Cube& cube = n == 0 ? one : two;
        force[n] = std::min(force[n], SecondsOf(points, WallSeconds, [&] { cube.Forces(); }));
        product[n] = std::min(product[n], SecondsOf(points, WallSeconds, [&] { cube.Product(); }));
      }
    }
  }
  state.counters["points"] = points;
  state.counters["force"] = force[0] / force[1];
  state.counters["product"] = product[0] / product[1];
}

/// The exponent of time over points from 1k to 97k, least squares of the logarithms.
void Growth(benchmark::State& state) {
  double slope[2] = {};
  for (auto _ : state) {
    double n = 0, sx = 0, sxx = 0, sy[2] = {}, sxy[2] = {};
    for (const int cells : {10, 15, 22, 31, 46}) {
      Cube cube(cells, 1);
      const int points = cube.tissue.point_count();
      const double x = std::log(points);
      const double y[2] = {std::log(SecondsOf(points, ProcessorSeconds, [&] { cube.Forces(); })),
                           std::log(SecondsOf(points, ProcessorSeconds, [&] { cube.Product(); }))};
      n += 1;
      sx += x;
      sxx += x * x;
      for (int i = 0; i < 2; ++i) {
        sy[i] += y[i];
        sxy[i] += x * y[i];
      }
    }
    for (int i = 0; i < 2; ++i) slope[i] = (n * sxy[i] - sx * sy[i]) / (n * sxx - sx * sx);
  }
  state.counters["force"] = slope[0];
  state.counters["product"] = slope[1];
}

BENCHMARK(ShareOfMachine)->Arg(10)->Arg(15)->Arg(22)->Arg(31)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(SpeedUpOfTwoThreads)->Arg(10)->Arg(22)->Arg(31)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(Growth)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace meshless_cutting
