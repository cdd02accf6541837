// scene_report SCENE [STROKES] [SECONDS]: runs a scene without ROS and prints what the paper's methods do in it: links
// cut and what a discrete scheme would have found, how often each mapping criterion decided, and what cuts cost.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>

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

void Report(const char* scene_file, const char* strokes, double seconds) {
  Simulation simulation(ReadScene(scene_file));
  simulation.CountPaperCriteria();
  std::unique_ptr<ToolPlayer> player;
  if (strokes) player = std::make_unique<ToolPlayer>(strokes);
  if (seconds <= 0) seconds = player ? player->end_s() : 1;
  const FrameStatistics& frame = simulation.statistics();
  std::printf("%s: %zu lattice vertices, %d links, %d points, %d particles, %d triangles\n", scene_file,
              simulation.body().lattice().vertices.size(), frame.links, frame.integration_points, frame.particles,
              frame.triangles);
  DiscreteSweep discrete;
  std::vector<double> find, cut, total;
  int frames = 0;
  while (frame.time_s < seconds) {
    if (player) player->FeedUntil(simulation, 0, frame.time_s + simulation.scene().time_step_s);
    const int links_before = frame.links_cut;
    discrete.Before(simulation);
    simulation.Step();
    discrete.After(simulation);
    ++frames;
    if (frame.status & ~kStepNotConverged) std::printf("  frame %d: status %u\n", frames, frame.status);
    if (frame.links_cut == links_before) continue;
    find.push_back(1e6 * frame.find_crossings_s);
    cut.push_back(1e3 * frame.cut_s);
    total.push_back(1e3 * frame.total_s);
  }
  const auto& fragments = simulation.surface().fragment_volume_m3;
  std::printf("  %d frames, %zu of them cut: %d links; %zu fragments:", frames, cut.size(), frame.links_cut,
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
}

}  // namespace
}  // namespace meshless_cutting

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: scene_report SCENE [STROKES] [SECONDS]\n");
    return 1;
  }
  try {
    const bool has_strokes = argc > 2 && std::atof(argv[argc - 1]) == 0;
    const char* strokes = argc > 2 && (has_strokes || argc > 3) ? argv[2] : nullptr;
    meshless_cutting::Report(argv[1], strokes, argc > 2 ? std::atof(argv[argc - 1]) : 0);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
