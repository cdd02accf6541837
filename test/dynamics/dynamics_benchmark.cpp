// Loops over points, in ns per point, and whole steps. --benchmark_filter=Step for the latter.
#include <benchmark/benchmark.h>

#include <ctime>

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

const MaterialConfig kSoft{MaterialModel::kStableNeoHookean, 5e3, 0.45, 1050};

struct Loop {
  explicit Loop(const benchmark::State& state)
      : Loop(static_cast<int>(state.range(0)), static_cast<int>(state.range(1))) {}
  Loop(int cells, int threads)
      : tissue(MakeBoxTissue(Cube(cells))),
        pool(threads),
        points(kSoft, pool),
        x(tissue.particle_count()),
        y(tissue.particle_count()),
        p(tissue.particle_count()) {
    points.TissueChanged(tissue);
    points.Resize(tangent);
    for (int j = 0; j < tissue.particle_count(); ++j) {
      x[j] = Vector4::From(1.01 * tissue.particle_rest[j]);
      p[j] = Round(x[j]);
    }
    points.Linearise(x, true, tangent);
  }
  void Report(benchmark::State& state) const {
    state.SetComplexityN(tissue.point_count());
    state.counters["points"] = tissue.point_count();
    state.counters["s_per_point"] =
        benchmark::Counter(static_cast<double>(tissue.point_count()),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  }

  Tissue tissue;
  ThreadPool pool;
  ElasticPoints points;
  Field x, y;
  SingleField p;
  SinglePointTangent tangent;
};

void Force(benchmark::State& state) {
  Loop loop(state);
  for (auto _ : state) benchmark::DoNotOptimize(loop.points.Evaluate(loop.x, loop.y));
  loop.Report(state);
}

void Product(benchmark::State& state) {
  Loop loop(state);
  for (auto _ : state) loop.points.ProductInSlots(loop.tangent, loop.p);
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

/// What a generalised-alpha step costs, in evaluations of the forces of the same object in the same run: the swing of
/// the cube's first second, one thread. Solver choice rests on it.
void StepInEvaluations(benchmark::State& state) {
  // Time of the processor: a busy machine stops whole steps more often than single evaluations.
  const auto now = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  Loop loop(static_cast<int>(state.range(0)), 1);
  DynamicsConfig config;
  config.material = kSoft;
  config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  config.solver.threads = 1;
  constexpr int kEvaluations = 40;
  double steps = 0, evaluations = 0;
  for (auto _ : state) {
    Dynamics dynamics(config, loop.tissue);
    TissueState tissue_state = RestState(loop.tissue);
    for (int frame = 0; frame < 60; ++frame) {
      const double start = now();
      dynamics.Advance(loop.tissue, {}, tissue_state);
      const double middle = now();
      for (int n = 0; n < kEvaluations; ++n) benchmark::DoNotOptimize(loop.points.Evaluate(loop.x, loop.y));
      steps += middle - start;
      evaluations += (now() - middle) / kEvaluations;
    }
  }
  state.counters["evaluations"] = steps / evaluations;
}

/// The same swing with and without each optional part: 0 none, 1 gravity, 2 damping by mass, 3 by stiffness, 4 an
/// obstacle far away, 5 none and at rest, asleep, 6 a Prony branch, 7 dead loads.
void Part(benchmark::State& state) {
  const int part = static_cast<int>(state.range(0));
  const BoxTissueConfig cube = Cube(14);
  const Tissue tissue = MakeBoxTissue(cube);
  const SurfacePoints skin = part == 4 ? MakeBoxSkin(cube) : SurfacePoints();
  DynamicsConfig config;
  config.material = kSoft;
  config.solver.threads = 1;
  if (part == 1) config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  if (part == 2 || part == 3) config.damping = DampingConfig{part == 2 ? 0.5 : 0, part == 3 ? 0.002 : 0};
  if (part == 4) {
    config.obstacles.push_back({PlaneObstacle{Eigen::Vector3d(0, 0, -100), Eigen::Vector3d::UnitZ()}, 0.5});
  }
  if (part == 6) config.material.prony = {{0.5, 0.1}};
  Dynamics dynamics(config, tissue);
  if (part == 7) {
    const Eigen::Vector3d load(0, 0, -0.01 / tissue.particle_count());
    dynamics.SetForces(std::vector<Eigen::Vector3d>(static_cast<size_t>(tissue.particle_count()), load));
  }
  TissueState tissue_state = RestState(tissue);
  for (int j = 0; j < tissue.particle_count() && part != 5; ++j) {
    if (!tissue.particle_fixed[j]) tissue_state.velocity[j].z() = -0.5 * tissue.particle_rest[j].x() / 0.091;
  }
  int linear = 0, frames = 0;
  for (auto _ : state) {
    linear += dynamics.Advance(tissue, skin, tissue_state).linear_iterations;
    ++frames;
  }
  state.counters["linear"] = static_cast<double>(linear) / frames;
}

// Cells along an edge, threads[, at rest]: 1k, 3.4k, 10k, 30k, 97k points.
BENCHMARK(Force)->ArgsProduct({{10, 15, 22, 31, 46}, {1}})->UseRealTime()->Complexity();
BENCHMARK(Force)->ArgsProduct({{10, 15, 22, 31, 46}, {2}})->UseRealTime()->Complexity();
BENCHMARK(Product)->ArgsProduct({{10, 15, 22}, {1, 2}})->UseRealTime();
BENCHMARK(TissueChanged)->Arg(10)->Arg(15)->Arg(22)->Unit(benchmark::kMillisecond);
BENCHMARK(StepInEvaluations)->Arg(9)->Arg(14)->Arg(21)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(Part)->DenseRange(0, 7)->Unit(benchmark::kMillisecond)->Iterations(120);
BENCHMARK(Step)
    ->ArgsProduct({{9, 14, 21}, {1, 2}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(120);

}  // namespace
}  // namespace meshless_cutting

BENCHMARK_MAIN();
