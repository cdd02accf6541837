#include "scenes/session_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <sstream>
#include <vector>

#include "cut/soft_body.h"
#include "scene/scene_reader.h"
#include "simulation.h"

namespace meshless_cutting {
namespace {

constexpr double kRate = 500;  // samples of the tool, 1/s

/// A straight stroke that passes through the block.
struct Stroke {
  double start_s, end_s;
  Eigen::Isometry3d from, to;
};

std::vector<Stroke> RandomStrokes(std::uint64_t seed, double until_s) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Eigen::Vector3d(uniform(generator), uniform(generator), uniform(generator)); };
  std::vector<Stroke> strokes;
  for (double time_s = 0.05; time_s < until_s;) {
    const double duration_s = 0.4 + 0.3 * (1 + uniform(generator));
    const Eigen::Vector3d middle = Eigen::Vector3d(0.055, 0.02, 0.02) + vector().cwiseProduct(Eigen::Vector3d(0.045, 0.015, 0.015));
    const Eigen::Vector3d edge = Eigen::Vector3d(0.2 * uniform(generator), 1, 0.2 * uniform(generator)).normalized();
    const Eigen::Vector3d way = (vector() - edge * edge.dot(vector())).normalized();
    Stroke stroke{time_s, time_s + duration_s, {}, {}};
    stroke.from.linear() = stroke.to.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitY(), edge).matrix();
    stroke.from.translation() = middle - 0.05 * way - 0.02 * edge;
    stroke.to.translation() = middle + (0.02 + 0.03 * (1 + uniform(generator))) * way - 0.02 * edge;
    stroke.from.makeAffine();
    stroke.to.makeAffine();
    strokes.push_back(stroke);
    time_s += duration_s + 0.2;  // out of sight in between: longer than the tool's timeout
  }
  return strokes;
}

void Feed(Simulation& simulation, const std::vector<Stroke>& strokes, double from_s, double to_s) {
  for (const Stroke& stroke : strokes) {
    for (long n = static_cast<long>(from_s * kRate) + 1; static_cast<double>(n) / kRate <= to_s; ++n) {
      ToolSample sample;
      sample.time_s = static_cast<double>(n) / kRate;
      if (sample.time_s < stroke.start_s || sample.time_s > stroke.end_s) continue;
      const double share = (sample.time_s - stroke.start_s) / (stroke.end_s - stroke.start_s);
      sample.position_m = (1 - share) * stroke.from.translation() + share * stroke.to.translation();
      sample.orientation_xyzw = Eigen::Quaterniond(stroke.from.rotation()).coeffs();
      simulation.AddToolSample(0, sample);
    }
  }
}

}  // namespace

std::string SearchSession(std::uint64_t seed, int frames, SessionCounts& counts, bool go_on) {
  Scene scene = ReadScene(MESHLESS_CUTTING_SOURCE_DIR "/launch/block.yaml");
  scene.solver.threads = 1;
  Simulation simulation(scene);
  const std::vector<Stroke> strokes = RandomStrokes(seed, frames * scene.time_step_s / 2);
  double weight = 0;
  for (double m : simulation.body().tissue().particle_mass) weight += m * scene.gravity_m_s2->norm();
  const double most = weight * 0.5;  // J: the whole block falls by five times its length, on a strand
  ++counts.sessions;
  counts.strokes += static_cast<long>(strokes.size());
  const FrameStatistics& frame = simulation.statistics();
  std::string last;
  long given_up = 0;
  for (int n = 0; n < frames; ++n) {
    Feed(simulation, strokes, frame.time_s, frame.time_s + scene.time_step_s);
    simulation.Step();
    ++counts.frames;
    counts.hard_frames += frame.newton_iterations > 8;
    counts.most_fragments = std::max<long>(counts.most_fragments, frame.fragments);
    given_up = frame.status & kStepFrozen ? given_up + 1 : 0;
    counts.given_up = std::max(counts.given_up, given_up);
    std::ostringstream failure;
    if (frame.status & kStepFrozen) failure << "a step was given up";
    if (frame.status & kStepRolledBack) failure << "a step was repeated in halves";
    if (!(frame.elastic_j <= most)) failure << "elastic energy " << frame.elastic_j << " J, at most " << most;
    // Nothing is faster than what fell since the start.
    const double fastest = scene.gravity_m_s2->norm() * frame.time_s + 5;
    for (const Eigen::Vector3d& v : simulation.body().state().velocity) {
      if (!(v.norm() <= fastest)) {
        failure << "a particle moves with " << v.norm() << " m/s, at most " << fastest;
        break;
      }
    }
    if (failure.str().empty()) continue;
    last = "frame " + std::to_string(n) + ": " + failure.str();
    if (!go_on) break;
  }
  return last;
}

}  // namespace meshless_cutting
