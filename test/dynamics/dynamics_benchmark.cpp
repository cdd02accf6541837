// Loops over points, in ns per point, and whole steps. --benchmark_filter=Step for the latter.
#include <benchmark/benchmark.h>

#include "dynamics/dynamics.h"
#include "dynamics/elastic_points.h"
#include "support/box_tissue.h"

namespace meshless_cutting {
namespace {

/// A cube of n^3 cells of 6.5 mm of soft tissue, clamped at one side.
BoxTissueConfig Cube(int n) {
  BoxTissueConfig config;
  config.cells = {n, n, n};
  config.size = Eigen::Vector3d::Constant(0.0065 * n);
  config.density_kg_m3 = 1050;
  config.clamp_x0 = true;
  return config;
}

constexpr MaterialConfig kSoft{MaterialModel::kStableNeoHookean, 5e3, 0.45, 1050};

struct Loop {
  explicit Loop(const benchmark::State& state)
      : tissue(MakeBoxTissue(Cube(static_cast<int>(state.range(0))))),
        pool(static_cast<int>(state.range(1))),
        points(kSoft, pool),
        x(tissue.particle_count()),
        y(tissue.particle_count()) {
    points.TissueChanged(tissue);
    points.Resize(tangent);
    for (int j = 0; j < tissue.particle_count(); ++j) x[j] = Vector4::From(1.01 * tissue.particle_rest[j]);
    points.Linearise(x, tangent);
  }
  void Report(benchmark::State& state) const {
    state.counters["points"] = tissue.point_count();
    state.counters["s_per_point"] =
        benchmark::Counter(static_cast<double>(tissue.point_count()),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  }

  Tissue tissue;
  ThreadPool pool;
  ElasticPoints points;
  Field x, y;
  PointTangent tangent;
};

void Force(benchmark::State& state) {
  Loop loop(state);
  for (auto _ : state) benchmark::DoNotOptimize(loop.points.Evaluate(loop.x, loop.y));
  loop.Report(state);
}

void Product(benchmark::State& state) {
  Loop loop(state);
  for (auto _ : state) loop.points.AddProduct(loop.tangent, 1, loop.x, loop.y);
  loop.Report(state);
}

/// Rebuilds everything that depends on the links, as after a cut.
void TissueChanged(benchmark::State& state) {
  const Tissue tissue = MakeBoxTissue(Cube(static_cast<int>(state.range(0))));
  DynamicsConfig config;
  config.material = kSoft;
  config.solver.threads = 1;
  Dynamics dynamics(config, tissue);
  for (auto _ : state) dynamics.TissueChanged(tissue);
}

/// The cube sags, swings and settles: the mean over the first two seconds. Then at rest.
void Step(benchmark::State& state) {
  const Tissue tissue = MakeBoxTissue(Cube(static_cast<int>(state.range(0))));
  const bool at_rest = state.range(2) != 0;
  DynamicsConfig config;
  config.material = kSoft;
  config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  config.damping = DampingConfig{0.5, 0.01};
  config.solver.threads = static_cast<int>(state.range(1));
  Dynamics dynamics(config, tissue);
  TissueState tissue_state = RestState(tissue);
  int frame = 0, newton = 0, linear = 0, frames = 0;
  for (; at_rest && frame < 600; ++frame) dynamics.Advance(tissue, {}, tissue_state);
  for (auto _ : state) {
    if (!at_rest && frame++ == 120) {
      tissue_state = RestState(tissue);
      frame = 0;
    }
    const AdvanceResult result = dynamics.Advance(tissue, {}, tissue_state);
    newton += result.newton_iterations;
    linear += result.linear_iterations;
    ++frames;
  }
  state.counters["particles"] = tissue.particle_count();
  state.counters["newton"] = static_cast<double>(newton) / frames;
  state.counters["linear"] = static_cast<double>(linear) / frames;
}

// Cells along an edge, threads[, at rest]: 1k, 3.4k, 10k points.
BENCHMARK(Force)->ArgsProduct({{10, 15, 22}, {1, 2}})->UseRealTime();
BENCHMARK(Product)->ArgsProduct({{10, 15, 22}, {1, 2}})->UseRealTime();
BENCHMARK(TissueChanged)->Arg(10)->Arg(15)->Arg(22)->Unit(benchmark::kMillisecond);
BENCHMARK(Step)->ArgsProduct({{9, 14, 21}, {1, 2}, {0, 1}})->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(120);

}  // namespace
}  // namespace meshless_cutting

BENCHMARK_MAIN();
