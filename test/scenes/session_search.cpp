#include "scenes/session_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <stdexcept>
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

/// Where strokes pass, and by how much of their way they begin before it.
struct Target {
  Eigen::Vector3d middle, spread;  // m, scene frame
  double reach;                    // m
  Eigen::Vector3d edge, tip;       // of the blade at rest, unit, and the middle of it, tool frame, m
};

Target TargetOf(const Scene& scene, const SoftBody& body) {
  const std::vector<Eigen::Vector3d>& blade = scene.tools[0].cutting_edge;
  const Eigen::Vector3d along = blade.back() - blade.front();
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& X : body.lattice().vertices) box.extend(scene.object.T_WO * X);
  return {box.center(), 0.4 * box.sizes(), 0.4 * box.sizes().maxCoeff(), along.normalized(), blade.front() + 0.5 * along};
}

/// In launch/block.yaml: with other numbers its seeds would be other sessions.
const Target kBlock{{0.055, 0.02, 0.02}, {0.045, 0.015, 0.015}, 0.05, Eigen::Vector3d::UnitY(), {0, 0.02, 0}};

std::vector<Stroke> RandomStrokes(std::uint64_t seed, double until_s, const Target& target) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Eigen::Vector3d(uniform(generator), uniform(generator), uniform(generator)); };
  std::vector<Stroke> strokes;
  for (double time_s = 0.05; time_s < until_s;) {
    const double duration_s = 0.4 + 0.3 * (1 + uniform(generator));
    const Eigen::Vector3d middle = target.middle + vector().cwiseProduct(target.spread);
    const Eigen::Vector3d edge = Eigen::Vector3d(0.2 * uniform(generator), 1, 0.2 * uniform(generator)).normalized();
    const Eigen::Vector3d way = (vector() - edge * edge.dot(vector())).normalized();
    Stroke stroke{time_s, time_s + duration_s, {}, {}};
    const Eigen::Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(target.edge, edge).matrix();
    stroke.from.linear() = stroke.to.linear() = turn;
    stroke.from.translation() = middle - target.reach * way - turn * target.tip;
    stroke.to.translation() = middle + (0.4 + 0.6 * (1 + uniform(generator))) * target.reach * way - turn * target.tip;
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

std::string SearchSession(std::uint64_t seed, int frames, SessionCounts& counts, const std::string& scene_file) {
  Scene scene = ReadScene(scene_file.empty() ? MESHLESS_CUTTING_SOURCE_DIR "/launch/block.yaml" : scene_file);
  if (!scene.gravity_m_s2 || scene.tools.empty() || scene.tools[0].cutting_edge.empty()) {
    throw std::runtime_error(scene_file + ": expected a scene with gravity_m_s2 and a tool with cutting_edge_m");
  }
  scene.solver.threads = 1;
  Simulation simulation(scene);
  const Target target = scene_file.empty() ? kBlock : TargetOf(scene, simulation.body());
  const std::vector<Stroke> strokes = RandomStrokes(seed, frames * scene.time_step_s / 2, target);
  double weight = 0;
  for (double m : simulation.body().tissue().particle_mass) weight += m * scene.gravity_m_s2->norm();
  const double most = weight * 0.5;  // J: the whole object falls by half a metre, on a strand
  ++counts.sessions;
  counts.strokes += static_cast<long>(strokes.size());
  const FrameStatistics& frame = simulation.statistics();
  for (int n = 0; n < frames; ++n) {
    Feed(simulation, strokes, frame.time_s, frame.time_s + scene.time_step_s);
    simulation.Step();
    ++counts.frames;
    counts.hard_frames += frame.newton_iterations > 8;
    counts.most_fragments = std::max<long>(counts.most_fragments, frame.fragments);
    const std::string at = "frame " + std::to_string(n) + ": ";
    if (frame.status & kStepFrozen) return at + "a step was given up";
    if (frame.status & kStepRolledBack) return at + "a step was repeated in halves";
    if (!(frame.elastic_j <= most)) {
      return at + "elastic energy " + std::to_string(frame.elastic_j) + " J, at most " + std::to_string(most);
    }
    // Nothing is faster than what fell since the start.
    const double fastest = scene.gravity_m_s2->norm() * frame.time_s + 5;
    for (const Eigen::Vector3d& v : simulation.body().state().velocity) {
      if (!(v.norm() <= fastest)) {
        return at + "a particle moves with " + std::to_string(v.norm()) + " m/s, at most " + std::to_string(fastest);
      }
    }
  }
  return simulation.CheckInvariants();
}

}  // namespace meshless_cutting
