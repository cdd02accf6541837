// study: error against run time of the reference problems, or one scene run to a table.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>

#include "run_scene.h"
#include "scene/scene_reader.h"
#include "study_suite.h"

namespace meshless_cutting {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUsage =
    "study [--quick] [--output study.csv] [--scenes DIR]\n"
    "    Runs the reference problems over resolutions, time steps and solvers; goes on where the table ends. --quick: under\n"
    "    three minutes, exit status 1 where an error leaves its band. scripts/plot_study.py draws the table.\n"
    "study --scene S.yaml --output OUT.csv (--duration SECONDS | --frames N) [--static]\n"
    "    Runs any scene without its tools: one row a frame with energies, residual, probes and reactions. --static: every\n"
    "    frame ends in balance, whatever the scene's integrator.\n";

struct Options {
  std::string scene, output = "study.csv", scenes;
  double duration = 0;
  int frames = 0;
  bool quick = false, is_static = false;
};

double PositiveNumber(const std::string& name, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value > 0) || !std::isfinite(value)) {
    throw std::runtime_error(name + " " + text + ": expected a number above 0");
  }
  return value;
}

Options ReadOptions(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    const auto value = [&]() -> std::string {
      if (i + 1 >= argc) throw std::runtime_error(name + ": expected a value behind it");
      return argv[++i];
    };
    if (name == "--quick") {
      options.quick = true;
    } else if (name == "--static") {
      options.is_static = true;
    } else if (name == "--scene") {
      options.scene = value();
    } else if (name == "--output") {
      options.output = value();
    } else if (name == "--scenes") {
      options.scenes = value();
    } else if (name == "--duration") {
      options.duration = PositiveNumber(name, value());
    } else if (name == "--frames") {
      options.frames = static_cast<int>(std::lround(PositiveNumber(name, value())));
    } else if (name == "--help" || name == "-h") {
      std::fputs(kUsage, stdout);
      std::exit(0);
    } else {
      throw std::runtime_error(name + ": unknown; expected\n" + kUsage);
    }
  }
  if (options.scene.empty() && (options.duration > 0 || options.frames > 0 || options.is_static)) {
    throw std::runtime_error("--duration, --frames and --static belong to --scene");
  }
  if (!options.scene.empty() && (options.duration > 0) == (options.frames > 0)) {
    throw std::runtime_error("--scene: expected either --duration or --frames beside it");
  }
  return options;
}

/// On a terminal alone, one line that is drawn over.
void ShowProgress(double share, const std::string& what) {
  constexpr int kWidth = 30;
  if (!isatty(STDERR_FILENO)) return;
  const int filled = static_cast<int>(std::clamp(share, 0.0, 1.0) * kWidth);
  std::fprintf(stderr, "\r[%s%s] %3.0f %%  %s\033[K", std::string(filled, '#').c_str(),
               std::string(kWidth - filled, ' ').c_str(), 100 * share, what.c_str());
  std::fflush(stderr);
}

/// The scenes of this source tree, else those installed beside the program (lib/meshless_cutting/study).
fs::path FindScenes(const Options& options) {
  if (!options.scenes.empty()) return options.scenes;
  const fs::path inside = fs::path("launch") / "scenes" / "reference";
  const fs::path source = fs::path(MESHLESS_CUTTING_SOURCE_DIR) / inside;
  if (fs::is_directory(source)) return source;
  return fs::read_symlink("/proc/self/exe").parent_path() / ".." / ".." / "share" / "meshless_cutting" / inside;
}

int RunSuite(const Options& options) {
  StudyRuns runs(FindScenes(options));
  CsvTable table(options.output, RunHeader());
  const std::vector<StudyTask> tasks = StudySuite(runs, options.quick);
  int outside = 0;
  for (std::size_t n = 0; n < tasks.size(); ++n) {
    StudyRow row = tasks[n].row;
    ShowProgress(static_cast<double>(n) / static_cast<double>(tasks.size()), row.Key());
    if (table.Has(row)) continue;
    tasks[n].run(runs, row);
    table.Append(row);
    if (tasks[n].band > 0 && !(row.error_discretisation <= tasks[n].band && !row.failed)) {
      ++outside;
      std::fprintf(stderr, "\n%s: error %.4g, expected at most %.4g %s\n", row.Key().c_str(), row.error_discretisation,
                   tasks[n].band, row.note.c_str());
    }
  }
  ShowProgress(1, options.output + "\n");
  if (outside > 0) std::fprintf(stderr, "%d of %zu runs outside their band\n", outside, tasks.size());
  return outside > 0 ? 1 : 0;
}

void RunOneScene(const Options& options) {
  Scene scene = ReadScene(options.scene);
  scene.tools.clear();
  if (options.is_static) {
    scene.solver.integrator = Integrator::kQuasiStatic;
    scene.solver.relative_tolerance = std::min(scene.solver.relative_tolerance, 1e-7);
    scene.solver.newton_iterations = std::max(scene.solver.newton_iterations, 100);
  }
  const int frames =
      options.frames > 0 ? options.frames : static_cast<int>(std::ceil(options.duration / scene.time_step_s - 1e-9));
  std::ofstream csv(options.output);
  if (!csv) throw std::runtime_error(options.output + ": cannot be written; expected a path in a folder that exists");
  RunScene(scene, frames, csv, [&](double share) { ShowProgress(share, options.scene); });
  if (!csv.flush()) throw std::runtime_error(options.output + ": cannot be written; the disk may be full");
}

}  // namespace
}  // namespace meshless_cutting

int main(int argc, char** argv) {
  try {
    const meshless_cutting::Options options = meshless_cutting::ReadOptions(argc, argv);
    if (options.scene.empty()) return meshless_cutting::RunSuite(options);
    meshless_cutting::RunOneScene(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "study: %s\n", error.what());
    return 1;
  }
  return 0;
}
