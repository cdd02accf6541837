// What a frame that cuts costs before its time step: the crossing search, the cut itself (graph, surface, integration
// points, particles, mapping), and the update of the physics. A blade of 20 edges and 30 mm goes through a liver, or a
// brain, that moves. All times are of the processor, for one thread.
//
// Every search has a window of its own: the body moves in between. BM_Search holds the search against the time to read
// the code of every link of the object once; its argument is the lattice size in micrometres, so that the object has
// more and more links while what is near the blade stays.
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include "crossing/find_crossings.h"
#include "cut/soft_body.h"
#include "dynamics/dynamics.h"
#include "lattice/lattice_builder.h"

namespace meshless_cutting {
namespace {

/// Of the processor, for this thread.
double ThreadSeconds() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double Percentile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const size_t at = std::min(values.size() - 1, static_cast<size_t>(share * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

/// A slice of a body: a blade on its way from front to back, 2.5 mm a frame, while the body sways.
class Slice {
 public:
  Slice(const Lattice& lattice, double cell_size_m, double offset_m)
      : body_(lattice, Config(cell_size_m), true), dynamics_(Physics(), body_.tissue()) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& x : body_.surface().positions) box.extend(x);
    end_ = box.max()[1] + 0.005;
    for (int i = 0; i <= 20; ++i)
      blade_.emplace_back(box.center()[0] + offset_m + 0.002 * std::sin(0.3 * i), box.min()[1] - 0.005,
                          box.center()[2] + 0.03 * (i / 20.0 - 0.5));
  }

  static ObjectConfig Config(double cell_size_m) {
    ObjectConfig config;
    config.cell_size_m = cell_size_m;
    config.material.density_kg_m3 = 1000;
    return config;
  }

  static DynamicsConfig Physics() {
    DynamicsConfig config;
    config.material = Config(1).material;
    config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
    config.damping = DampingConfig();
    return config;
  }

  bool done() const { return blade_[0][1] > end_; }
  SoftBody& body() { return body_; }
  /// What a cut gives the dynamics to do before the next step: new particles, points, free particles, loads.
  void UpdatePhysics() { dynamics_.TissueChanged(body_.tissue()); }

  BladeMotion MoveBlade() {
    BladeMotion motion = {{0, 1, blade_, blade_}};
    for (Eigen::Vector3d& p : blade_) p += Eigen::Vector3d(0.0003 * std::sin(0.1 * frame_), 0.0025, 0);
    motion[0].points_t1 = blade_;
    return motion;
  }

  /// Up to 0.1 mm a frame along each of two axes, every part its own way, and the whole to and fro.
  void MoveBody(double swing_m = 0) {
    body_.BeginAdvance();
    for (Eigen::Vector3d& x : body_.mutable_state().position)
      x += Eigen::Vector3d(1e-4 * std::sin(30 * x[1] + 0.2 * frame_),
                           1e-4 * std::cos(20 * x[0] + 0.3 * frame_) + swing_m * std::cos(0.2 * frame_), 0);
    body_.EndAdvance();
    ++frame_;
  }

 private:
  SoftBody body_;
  Dynamics dynamics_;
  std::vector<Eigen::Vector3d> blade_;
  double end_ = 0;
  int frame_ = 0;
};

Lattice Fill(const std::string& mesh, double lattice_size_m) {
  return FillWithLattice(ReadTriangleMesh(MESHLESS_CUTTING_SOURCE_DIR "/meshes/" + mesh + ".obj", 1), lattice_size_m)
      .lattice;
}

std::vector<LinkCut> CutsOf(const std::vector<Crossing>& crossings) {
  std::vector<LinkCut> cuts;
  for (const Crossing& c : crossings) cuts.push_back(c.cut);
  return cuts;
}

void BM_Search(benchmark::State& state, double swing_m) {
  const double size = 1e-6 * static_cast<double>(state.range(0));
  const Lattice lattice = Fill("liver", size);
  Slice slice(lattice, 2 * size, 0);
  CrossingFinder finder(slice.body().lattice(), slice.body().graph());
  // To the middle of the body, cutting on the way.
  BladeMotion motion;
  std::vector<Crossing> crossings;
  for (int frame = 0; frame < 25; ++frame) {
    motion = slice.MoveBlade();
    crossings = finder.Find(motion, slice.body().motion());
    slice.body().CloseWindow();
    if (frame < 24 && !crossings.empty()) slice.body().Cut(CutsOf(crossings));
    if (frame < 24) slice.MoveBody();
  }
  for (auto _ : state) {
    const double start = ThreadSeconds();
    benchmark::DoNotOptimize(finder.Find(motion, slice.body().motion()).data());
    state.SetIterationTime(ThreadSeconds() - start);
    slice.body().CloseWindow();
    slice.MoveBody(swing_m);
  }
  state.counters["links"] = static_cast<double>(lattice.links.size());
  state.counters["found"] = static_cast<double>(crossings.size());
}
BENCHMARK_CAPTURE(BM_Search, swaying, 0)
    ->Arg(9000)
    ->Arg(5600)
    ->Arg(4000)
    ->Arg(3000)
    ->Unit(benchmark::kMicrosecond)
    ->UseManualTime();
/// Up to 5 mm a frame.
BENCHMARK_CAPTURE(BM_Search, swinging, 0.005)->Arg(5600)->Arg(3000)->Unit(benchmark::kMicrosecond)->UseManualTime();

/// The limit: one pass over all links with a code per vertex that is already there.
void BM_ReadEveryLink(benchmark::State& state) {
  const Lattice lattice = Fill("liver", 1e-6 * static_cast<double>(state.range(0)));
  std::vector<std::uint8_t> codes(lattice.vertices.size(), 1);
  for (auto _ : state) {
    int near = 0;
    for (const auto& [a, b] : lattice.links) near += (codes[a] & codes[b]) == 0;
    benchmark::DoNotOptimize(near);
  }
  state.counters["links"] = static_cast<double>(lattice.links.size());
}
BENCHMARK(BM_ReadEveryLink)->Arg(5600)->Arg(4000)->Arg(3000)->Unit(benchmark::kMicrosecond);

/// Whole slices; counters hold the percentiles over the frames that cut.
void BM_CutSlices(benchmark::State& state, const std::string& mesh) {
  const double size = 1e-6 * static_cast<double>(state.range(0));
  const Lattice lattice = Fill(mesh, size);
  std::vector<double> search_us, cut_ms, physics_ms, sum_ms;
  double links = 0;
  for (auto _ : state) {
    for (const double offset : {-0.03, 0.0, 0.03}) {
      state.PauseTiming();
      Slice slice(lattice, 2 * size, offset);
      CrossingFinder finder(slice.body().lattice(), slice.body().graph());
      state.ResumeTiming();
      while (!slice.done()) {
        const BladeMotion motion = slice.MoveBlade();
        const double start = ThreadSeconds();
        const std::vector<LinkCut> cuts = CutsOf(finder.Find(motion, slice.body().motion()));
        slice.body().CloseWindow();
        const double searched = ThreadSeconds();
        if (!cuts.empty()) {
          slice.body().Cut(cuts);
          const double cut = ThreadSeconds();
          slice.UpdatePhysics();
          const double updated = ThreadSeconds();
          search_us.push_back(1e6 * (searched - start));
          cut_ms.push_back(1e3 * (cut - searched));
          physics_ms.push_back(1e3 * (updated - cut));
          sum_ms.push_back(1e3 * (updated - searched));
          links += static_cast<double>(cuts.size());
        }
        slice.MoveBody();
      }
    }
  }
  state.counters["lattice_vertices"] = static_cast<double>(lattice.vertices.size());
  state.counters["links_a_frame"] = links / static_cast<double>(cut_ms.size());
  auto report = [&](const std::string& name, std::vector<double>& values) {
    state.counters[name + "_p50"] = Percentile(values, 0.5);
    state.counters[name + "_p99"] = Percentile(values, 0.99);
  };
  report("search_us", search_us);
  report("cut_ms", cut_ms);
  report("physics_ms", physics_ms);
  report("sum_ms", sum_ms);
}
BENCHMARK_CAPTURE(BM_CutSlices, liver, "liver")
    ->Arg(5600)
    ->Arg(4300)
    ->Arg(3000)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3);
BENCHMARK_CAPTURE(BM_CutSlices, brain, "brain")->Arg(4300)->Arg(3500)->Unit(benchmark::kMillisecond)->Iterations(3);

}  // namespace
}  // namespace meshless_cutting

BENCHMARK_MAIN();
