// scene_report SCENE [--strokes FILE] [--frames N] [--check]: runs a scene without ROS and prints what the paper's
// methods do in it: links cut and what a discrete scheme would have found, how often each mapping criterion decided, and
// what cuts cost. --frames: stretches the strokes in time to N frames; without strokes, how many frames to run (60).
// --check: all invariants after every frame.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "cut/soft_body.h"
#include "scene/scene_reader.h"
#include "support/discrete_sweep.h"
#include "support/tool_player.h"

namespace meshless_cutting {
namespace {

double Percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<size_t>(share * static_cast<double>(values.size())))];
}

struct Options {
  std::string scene, strokes;
  int frames = 0;
  bool check = false;
};

int Report(const Options& options) {
  Simulation simulation(ReadScene(options.scene));
  simulation.CountPaperCriteria();
  const double dt = simulation.scene().time_step_s;
  std::unique_ptr<ToolPlayer> player;
  int frame_count = options.frames > 0 ? options.frames : 60;
  if (!options.strokes.empty()) {
    const double natural = ToolPlayer(options.strokes).end_s() / dt;
    if (options.frames == 0) frame_count = static_cast<int>(natural);
    player = std::make_unique<ToolPlayer>(options.strokes, options.frames > 0 ? options.frames / natural : 1);
  }
  const FrameStatistics& frame = simulation.statistics();
  std::printf("%s: %zu lattice vertices, %d links, %d points, %d particles, %d triangles\n", options.scene.c_str(),
              simulation.body().lattice().vertices.size(), frame.links, frame.integration_points, frame.particles,
              frame.triangles);
  DiscreteSweep discrete;
  std::vector<double> find, cut, total;
  int broken = 0;
  while (frame.step < static_cast<std::uint64_t>(frame_count)) {
    if (player) player->FeedUntil(simulation, 0, frame.time_s + dt);
    const int links_before = frame.links_cut;
    discrete.Before(simulation);
    simulation.Step();
    discrete.After(simulation);
    if (frame.status & ~kStepNotConverged)
      std::printf("  frame %llu: status %u\n", static_cast<unsigned long long>(frame.step), frame.status);
    if (options.check)
      if (const std::string error = simulation.CheckInvariants(); !error.empty()) {
        ++broken;
        std::printf("  frame %llu: %s\n", static_cast<unsigned long long>(frame.step), error.c_str());
      }
    if (frame.links_cut == links_before) continue;
    find.push_back(1e6 * frame.find_crossings_s);
    cut.push_back(1e3 * frame.cut_s);
    total.push_back(1e3 * frame.total_s);
  }
  const auto& fragments = simulation.surface().fragment_volume_m3;
  std::printf("  %d frames, %zu of them cut: %d links; %zu fragments:", frame_count, cut.size(), frame.links_cut,
              fragments.size());
  for (double volume : fragments) std::printf(" %.3f", 1e6 * volume);
  std::printf(" ml\n");
  std::printf("  a discrete scheme finds %d of these links, misses %d, and finds %d that are not touched\n",
              discrete.found_by_both(), discrete.missed(), discrete.found_wrongly());
  const MappingStatistics& m = simulation.mapping_statistics();
  const PaperCriteriaCounts& p = simulation.paper_criteria();
  auto share = [](std::uint64_t part, std::uint64_t whole) {
    return whole ? 100 * static_cast<double>(part) / static_cast<double>(whole) : 0;
  };
  std::printf("  mapping: %llu choices; tangent plane decided %.1f %%, cut plane %.2f %%, shared particle %.1f %%, "
              "relaxed %.2f %%\n",
              static_cast<unsigned long long>(m.mapped), share(m.tangent_plane, m.mapped), share(m.cut_plane, m.mapped),
              share(m.shared_particle, m.mapped), share(m.relaxed, m.mapped));
  std::printf("  without the graph: %llu choices during cuts; across a cut or fold: nearest %.1f %%, + tangent plane "
              "%.2f %%, + cut plane %.2f %%, + shared particle %.3f %% (%llu); no point %.2f %%\n",
              static_cast<unsigned long long>(p.mapped), share(p.nearest, p.mapped), share(p.tangent_plane, p.mapped),
              share(p.cut_plane, p.mapped), share(p.shared_particle, p.mapped),
              static_cast<unsigned long long>(p.shared_particle), share(p.none, p.mapped));
  std::printf("  frames that cut: search p50 %.0f p99 %.0f us; cut p50 %.2f p99 %.2f ms; whole frame p50 %.1f p99 %.1f "
              "ms\n",
              Percentile(find, 0.5), Percentile(find, 0.99), Percentile(cut, 0.5), Percentile(cut, 0.99),
              Percentile(total, 0.5), Percentile(total, 0.99));
  if (options.check) std::printf("  invariants broken in %d frames\n", broken);
  return broken == 0 ? 0 : 1;
}

}  // namespace
}  // namespace meshless_cutting

int main(int argc, char** argv) {
  meshless_cutting::Options options;
  bool understood = argc > 1;
  for (int i = 1; i < argc; ++i) {
    const std::string key = argv[i];
    if (key == "--check")
      options.check = true;
    else if (key == "--strokes" && i + 1 < argc)
      options.strokes = argv[++i];
    else if (key == "--frames" && i + 1 < argc)
      understood = (options.frames = std::atoi(argv[++i])) > 0 && understood;
    else if (key[0] != '-' && options.scene.empty())
      options.scene = key;
    else
      understood = false;
  }
  if (!understood || options.scene.empty()) {
    std::fprintf(stderr, "usage: scene_report SCENE [--strokes FILE] [--frames N] [--check]\n");
    return 1;
  }
  try {
    return meshless_cutting::Report(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
