#include "study_runs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "scene/scene_reader.h"
#include "simulation.h"
#include "study_numbers.h"

namespace meshless_cutting {
namespace {

constexpr double kPi = 3.14159265358979323846;

const std::map<MaterialModel, std::string> kModelNames = {{MaterialModel::kStableNeoHookean, "stable_neo_hookean"},
                                                          {MaterialModel::kNeoHookean, "neo_hookean"},
                                                          {MaterialModel::kStVenantKirchhoff, "st_venant_kirchhoff"},
                                                          {MaterialModel::kLinear, "linear"}};

const ProbeReading& ProbeOf(const Simulation& simulation, const std::string& name) {
  for (const ProbeReading& probe : simulation.probes()) {
    if (probe.name == name) return probe;
  }
  throw std::runtime_error("the scene has no probe `" + name + "`");
}

const Reaction& ReactionOf(const Simulation& simulation, const std::string& name) {
  for (const Reaction& reaction : simulation.reactions()) {
    if (reaction.name == name) return reaction;
  }
  throw std::runtime_error("the scene has no held region `" + name + "`");
}

/// The number that a problem is judged by, and that of the reference.
void Judge(const std::string& problem, const Simulation& simulation, const ReferenceSolution& reference, StudyRow& row) {
  if (problem == "cantilever") {  // the tip, as a vector
    const Eigen::Vector3d tip = ProbeOf(simulation, "tip").displacement;
    const Eigen::Vector3d expected(reference.Value("tip_x"), 0, reference.Value("tip_z"));
    row.value = tip.z();
    row.reference = expected.z();
    row.error_discretisation = (tip - expected).norm() / expected.norm();
    return;
  }
  row.reference = reference.Value("value");
  if (problem == "cook") row.value = ProbeOf(simulation, "top").displacement.z();
  if (problem == "stretch" || problem == "squeeze") row.value = ReactionOf(simulation, "grip").force_n.z();
  if (problem == "torsion" || problem == "torsion_half_turn") row.value = ReactionOf(simulation, "grip").torque_nm.z();
  if (problem == "slit_beam") {
    row.value = (ProbeOf(simulation, "mouth_right").position - ProbeOf(simulation, "mouth_left").position).x();
  }
  if (problem == "slit_block") {
    row.value = (ProbeOf(simulation, "mouth_upper").position - ProbeOf(simulation, "mouth_lower").position).z();
  }
  row.error_discretisation = std::abs(row.value / row.reference - 1);
}

/// When the motion of all regions has ended, s.
double EndOfMotion(const Scene& scene) {
  double end = 0;
  for (const PrescribedRegion& region : scene.object.prescribed) {
    end = std::max({end, region.displacement_m.time_s.back(), region.angle_rad.time_s.back()});
  }
  return end;
}

void Count(const Simulation& simulation, StudyRow& row) {
  row.particles = simulation.statistics().particles;
  row.integration_points = simulation.statistics().integration_points;
}

struct Times {
  std::vector<double> ms;
  void Fill(StudyRow& row) const {
    row.wall_ms_p50 = Percentile(ms, 0.5);
    row.wall_ms_p99 = Percentile(ms, 0.99);
  }
};

/// z of the tip of a swinging beam after each frame; stops where it is not finite.
std::vector<double> TipPath(const Scene& scene, int frames, Times& times, StudyRow& row) {
  Simulation simulation(scene);
  Count(simulation, row);
  std::vector<double> path{0};
  for (int n = 0; n < frames; ++n) {
    simulation.Step();
    times.ms.push_back(1e3 * simulation.statistics().total_s);
    if (simulation.statistics().status & kStepFrozen) Fail("a step was given up", row);
    path.push_back(ProbeOf(simulation, "tip").displacement.z());
    if (!std::isfinite(path.back())) {
      Fail("not finite", row);
      break;
    }
    if (row.failed) break;
  }
  return path;
}

/// Size of the part of `signal` that swings with frequency f, under a Hann window.
double Amplitude(const std::vector<double>& signal, double time_step_s, double f) {
  double mean = 0, cosine = 0, sine = 0;
  for (double value : signal) mean += value / static_cast<double>(signal.size());
  for (std::size_t n = 0; n < signal.size(); ++n) {
    const double window = 1 - std::cos(2 * kPi * static_cast<double>(n) / static_cast<double>(signal.size()));
    const double phase = 2 * kPi * f * time_step_s * static_cast<double>(n);
    cosine += window * (signal[n] - mean) * std::cos(phase);
    sine += window * (signal[n] - mean) * std::sin(phase);
  }
  return std::hypot(cosine, sine);
}

/// The frequency within 15 % of `expected` that the signal has most of.
double Peak(const std::vector<double>& signal, double time_step_s, double expected) {
  double best = expected, most = -1;
  for (double width : {0.15, 0.005}) {
    const double centre = best;
    for (int n = -40; n <= 40; ++n) {
      const double f = centre + expected * width * n / 40, amplitude = Amplitude(signal, time_step_s, f);
      if (amplitude > most) {
        most = amplitude;
        best = f;
      }
    }
  }
  return best;
}

}  // namespace

StudyRuns::StudyRuns(const std::filesystem::path& folder)
    : folder_(folder), references_(ReadReferences(folder / "references.yaml")) {}

StudyRow StudyRuns::Label(const StudyCase& c, const std::string& solver) const {
  StudyRow row;
  row.problem = c.problem;
  row.material = kModelNames.at(c.model);
  row.youngs_modulus_pa = c.youngs_modulus_pa;
  row.poisson_ratio = c.poisson_ratio;
  row.solver = solver;
  row.time_step_s = c.time_step_s;
  row.cell_size_m = c.cell_size_m;
  row.wall_ms_p50 = row.wall_ms_p99 = row.error_discretisation = row.error_solver = kNotMeasured;
  row.error_field = row.value = row.reference = kNotMeasured;
  return row;
}

Scene StudyRuns::SceneOf(const StudyCase& c) const {
  const std::string name = c.problem == "swing" ? "cantilever" : c.problem;
  Scene scene = ReadScene(folder_ / (name + ".yaml"));
  ObjectConfig& object = scene.object;
  object.material.model = c.model;
  object.material.youngs_modulus_pa = c.youngs_modulus_pa;
  object.material.poisson_ratio = c.poisson_ratio;
  if (c.cell_size_m > 0) {
    object.lattice_size_m *= c.cell_size_m / object.cell_size_m;
    object.cell_size_m = c.cell_size_m;
  }
  scene.time_step_s = c.time_step_s;
  return scene;
}

const ReferenceSolution& StudyRuns::ReferenceOf(const StudyCase& c) const {
  std::ostringstream key;
  key << c.problem << '_';
  char modulus[16];
  std::snprintf(modulus, sizeof modulus, "%.0e", c.youngs_modulus_pa);
  key << modulus << '_' << c.poisson_ratio << '_' << kModelNames.at(c.model);
  const auto found = references_.find(key.str());
  if (found == references_.end()) throw std::runtime_error("references.yaml has no `" + key.str() + "`");
  return found->second;
}

void StudyRuns::Balance(const StudyCase& c, StudyRow& row) const {
  Scene scene = SceneOf(c);
  const ReferenceSolution& reference = ReferenceOf(c);
  const std::size_t own_probes = scene.probes.size();
  for (std::size_t i = 0; i < reference.points.size(); ++i) {
    scene.probes.push_back({"sample" + std::to_string(i), reference.points[i], Eigen::Vector3d::Zero()});
  }
  Simulation simulation(scene);
  Count(simulation, row);
  const int frames = static_cast<int>(std::ceil(EndOfMotion(scene) / scene.time_step_s)) + 3;
  for (int n = 0; n < frames; ++n) {
    simulation.Step();
    if (simulation.statistics().status & kStepFrozen) return Fail("no balance found", row);
  }
  if (simulation.statistics().relative_residual > 1e-4) Fail("residual above 1e-4", row);
  Judge(c.problem, simulation, reference, row);
  if (!std::isfinite(row.value)) return Fail("not finite", row);
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < reference.points.size(); ++i) {
    const Eigen::Vector3d& u = simulation.probes()[own_probes + i].displacement;
    difference += (u - reference.displacements[i]).squaredNorm();
    size += reference.displacements[i].squaredNorm();
  }
  row.error_field = std::sqrt(difference / size);

  // The same object in real time.
  scene = SceneOf(c);
  scene.solver = SolverConfig();
  Simulation real_time(scene);
  Times times;
  for (int n = 0; n < 20; ++n) {
    real_time.Step();
    times.ms.push_back(1e3 * real_time.statistics().total_s);
  }
  times.Fill(row);
  row.note += (row.note.empty() ? "" : "; ") + std::string("error in balance; time of frames of 1/60 s on the way");
}

void StudyRuns::SolverError(const StudyCase& c, StudyRow& row) {
  const int kFrames = c.frames;
  Scene scene = SceneOf(c);
  scene.solver = c.solver;
  Times times, unused;
  const std::vector<double> path = TipPath(scene, kFrames, times, row);
  times.Fill(row);
  if (row.failed) return;
  std::ostringstream key;
  key << kModelNames.at(c.model) << ' ' << c.youngs_modulus_pa << ' ' << c.poisson_ratio << ' ' << c.cell_size_m << ' '
      << c.time_step_s << ' ' << static_cast<int>(c.solver.integrator);
  std::vector<double>& converged = converged_[key.str()];
  if (converged.empty()) {
    scene.solver.relative_tolerance = 1e-8;
    scene.solver.newton_iterations = 100;
    converged = TipPath(scene, kFrames, unused, row);
  }
  if (converged.size() != path.size()) return;
  double difference = 0, size = 0;
  for (std::size_t n = 0; n < path.size(); ++n) {
    difference += std::pow(path[n] - converged[n], 2);
    size += std::pow(converged[n], 2);
  }
  row.error_solver = std::sqrt(difference / size);
  row.note = std::to_string(kFrames) + " frames";
}

void StudyRuns::Swing(const StudyCase& c, StudyRow& row) const {
  Scene scene = SceneOf(c);
  scene.solver = c.solver;
  const ReferenceSolution& reference = ReferenceOf(c);
  Times times;
  const std::vector<double> z = TipPath(scene, static_cast<int>(0.5 / c.time_step_s), times, row);
  times.Fill(row);
  if (row.failed) return;
  std::vector<std::pair<double, double>> troughs;  // by a parabola through three samples
  for (std::size_t n = 1; n + 1 < z.size(); ++n) {
    if (!(z[n] < z[n - 1] && z[n] <= z[n + 1])) continue;
    const double curvature = z[n - 1] - 2 * z[n] + z[n + 1], shift = 0.5 * (z[n - 1] - z[n + 1]) / curvature;
    troughs.emplace_back((static_cast<double>(n) + shift) * c.time_step_s,
                         z[n] - 0.125 * std::pow(z[n + 1] - z[n - 1], 2) / curvature);
  }
  if (troughs.size() < 2) return Fail("less than two troughs", row);
  // The period between the downward passages of half the first trough: troughs themselves are moved by higher modes.
  std::vector<double> passages;
  const double level = 0.5 * reference.Value("first_trough_m");
  for (std::size_t n = 1; n < z.size(); ++n) {
    if (!(z[n - 1] > level && z[n] <= level)) continue;
    passages.push_back((static_cast<double>(n - 1) + (level - z[n - 1]) / (z[n] - z[n - 1])) * c.time_step_s);
  }
  if (passages.size() < 2) return Fail("less than two passages", row);
  row.value = passages[1] - passages[0];
  row.reference = reference.Value("period_s");
  row.error_discretisation = std::abs(row.value / row.reference - 1);
  std::ostringstream note;
  note << "period; second trough " << 100 * (troughs[1].second / reference.Value("second_trough_m") - 1) << " % off";
  row.note = note.str();
  row.error_field = std::abs(troughs[1].second / reference.Value("second_trough_m") - 1);
}

void StudyRuns::Frequency(const StudyCase& c, const std::string& mode, StudyRow& row) {
  const std::string key = Label(c, "").Key();
  const ReferenceSolution& reference = ReferenceOf(c);
  if (frequencies_.count(key) == 0) {
    constexpr double kSeconds = 1.5;
    const Scene scene = SceneOf(c);
    Simulation simulation(scene);
    std::vector<double> bending, axial, torsion;
    const int frames = static_cast<int>(kSeconds / scene.time_step_s);
    for (int n = 0; n < frames; ++n) {
      simulation.Step();
      const Eigen::Vector3d tip = ProbeOf(simulation, "tip").displacement;
      bending.push_back(tip.z());
      axial.push_back(tip.x());
      torsion.push_back(ProbeOf(simulation, "top").displacement.y());
    }
    auto& found = frequencies_[key];
    found["particles"] = simulation.statistics().particles;
    found["points"] = simulation.statistics().integration_points;
    for (const char* name : {"bending", "bending_2", "torsion", "axial"}) {
      const std::string n = name;
      const auto& signal = n == "torsion" ? torsion : n == "axial" ? axial : bending;
      found[n] = Peak(signal, scene.time_step_s, reference.Value(n));
    }
  }
  const auto& found = frequencies_.at(key);
  row.particles = static_cast<int>(found.at("particles"));
  row.integration_points = static_cast<int>(found.at("points"));
  row.value = found.at(mode);
  row.reference = reference.Value(mode);
  row.error_discretisation = std::abs(row.value / row.reference - 1);
}

}  // namespace meshless_cutting
