// How long frames take that cut.
#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "scene/scene_reader.h"
#include "simulation.h"
#include "study_numbers.h"
#include "study_runs.h"
#include "tools/tool_path.h"

namespace meshless_cutting {
namespace {

constexpr double kRate = 500;  // Hz, samples of the tool

struct CutProblem {
  Scene scene;
  std::optional<ToolPath> path;  // else from above the block to its middle, 40 mm/s
  double end_s = 1.5;

  ToolSample At(double time_s) const {
    ToolSample sample;
    sample.time_s = time_s;
    if (path) {
      const Eigen::Isometry3d pose = path->At(time_s);
      sample.position_m = pose.translation();
      sample.orientation_xyzw = Eigen::Quaterniond(pose.linear()).coeffs();
    } else {
      sample.position_m = Eigen::Vector3d(0.051, 0, 0.06 - 0.04 * std::min(1.0, time_s));
    }
    return sample;
  }
};

CutProblem ProblemOf(const StudyCase& c, const std::filesystem::path& launch) {
  CutProblem problem;
  ObjectConfig& object = problem.scene.object;
  if (c.problem == "cut_liver") {
    problem.scene = ReadScene(launch / "liver.yaml");
    problem.path = ReadToolPath(launch / "liver_strokes.yaml");
    problem.end_s = 4;  // the first stroke, a deep incision along the right lobe
    object.lattice_size_m *= c.cell_size_m / object.cell_size_m;
  } else {
    problem.scene = ReadScene(launch / "block.yaml");
    object.lattice_size_m = 0.8 * c.cell_size_m;
  }
  object.cell_size_m = c.cell_size_m;
  object.material.model = c.model;
  object.material.youngs_modulus_pa = c.youngs_modulus_pa;
  object.material.poisson_ratio = c.poisson_ratio;
  return problem;
}

}  // namespace

void StudyRuns::CutFrames(const StudyCase& c, StudyRow& row) const {
  const CutProblem problem = ProblemOf(c, folder_.parent_path().parent_path());
  Simulation simulation(problem.scene);
  row.particles = simulation.statistics().particles;
  row.integration_points = simulation.statistics().integration_points;
  const int frames = static_cast<int>(std::lround(problem.end_s / problem.scene.time_step_s));
  std::vector<double> find, cut, advance, map, total, all;
  int missed = 0, missed_of_all = 0, sample = 0;
  for (int n = 0; n < frames; ++n) {
    const double end_s = simulation.statistics().time_s + problem.scene.time_step_s;
    for (; sample / kRate <= end_s; ++sample) simulation.AddToolSample(0, problem.At(sample / kRate));
    const int links = simulation.statistics().links_cut;
    simulation.Step();
    const FrameStatistics& s = simulation.statistics();
    if (s.status & kStepFrozen) Fail("a step was given up", row);
    all.push_back(1e3 * s.total_s);
    missed_of_all += all.back() > kDeadlineMs ? 1 : 0;
    if (s.links_cut == links) continue;  // cut frames are what is reported
    find.push_back(1e3 * s.find_crossings_s);
    cut.push_back(1e3 * s.cut_s);
    advance.push_back(1e3 * s.advance_s);
    map.push_back(1e3 * s.map_surface_s);
    total.push_back(all.back());
    missed += total.back() > kDeadlineMs ? 1 : 0;
  }
  if (total.empty()) return Fail("nothing was cut", row);
  row.wall_ms_p50 = Percentile(total, 0.5);
  row.wall_ms_p99 = Percentile(total, 0.99);
  std::ostringstream note;
  note.precision(3);
  note << total.size() << " frames that cut";
  const auto stage = [&](const char* name, const std::vector<double>& ms) {
    note << "; " << name << " p50 " << Percentile(ms, 0.5) << " p99 " << Percentile(ms, 0.99) << " max "
         << *std::max_element(ms.begin(), ms.end());
  };
  stage("crossings", find);
  stage("cut", cut);
  stage("dynamics", advance);
  stage("surface", map);
  stage("total", total);
  note << "; all " << all.size() << " frames p50 " << Percentile(all, 0.5) << " p99 " << Percentile(all, 0.99) << "; deadline missed in "
       << missed << " of those that cut and " << missed_of_all << " of all";
  row.note = note.str();
}

}  // namespace meshless_cutting
