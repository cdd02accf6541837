// One soft object, the tools that cut it, and the frame that brings both forward. No ROS, no clock, no global state:
// the same scene and the same samples give the same bits, whatever the number of threads.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "boundary/driven_regions.h"
#include "boundary/probes.h"
#include "cut/stroke_event.h"
#include "dynamics/dynamics.h"
#include "lattice/lattice_builder.h"
#include "scene/scene.h"
#include "surface/surface.h"
#include "surface/vertex_mapping.h"
#include "tool/tool.h"

namespace meshless_cutting {

class SoftBody;

/// What one frame cost and how good it is. Times are wall times of this run and the only thing here that is not
/// reproducible.
struct FrameStatistics {
  std::uint64_t step = 0;  // frames since load or reset, this one included
  double time_s = 0;       // simulated time at its end
  std::uint32_t status = kStepOk;
  double move_tools_s = 0, find_crossings_s = 0, cut_s = 0, advance_s = 0, map_surface_s = 0, total_s = 0;  // wall
  int newton_iterations = 0, linear_iterations = 0;
  double relative_residual = 0;  // reached
  int particles = 0, integration_points = 0, links = 0, links_cut = 0, vertices = 0, triangles = 0, fragments = 0;
  int contacts = 0;                                    // skin vertices that touch an obstacle
  double kinetic_j = 0, elastic_j = 0, gravity_j = 0;  // energies; gravity relative to the scene origin
};

/// Which parts were built at load. A part that is false costs nothing in any frame.
struct BuiltParts {
  bool gravity = false, damping = false, fixed = false, prescribed = false, loads = false, regions = false, slits = false,
       obstacles = false, tools = false, probes = false;
};

/// Called during a long load: stage in words, share done in [0, 1].
using Progress = std::function<void(const std::string& stage, double share)>;

class Simulation {
 public:
  /// Builds everything. Throws std::runtime_error with one line naming scene file, key, value, expectation.
  explicit Simulation(const Scene& scene, const Progress& progress = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;

  /// Back to the state after the constructor, without the load.
  void Reset();

  /// Hands a sample to tool `tool`; time on the clock that StartAt() set.
  SampleVerdict AddToolSample(int tool, const ToolSample& sample);
  bool SetToolEdge(int tool, const std::vector<Eigen::Vector3d>& points);

  /// What may change at run time: from the next Step() on, and after Reset(). The scene's at first.
  void SetTuning(const Tuning& tuning);
  const Tuning& tuning() const;

  /// Simulated time of the start of the first frame; only before the first Step(). Default 0.
  void StartAt(double time_s);

  /// One frame: move tools, find crossings, cut, advance, map the surface.
  void Step();

  // What the last Step() left; valid until the next one.
  const Surface& surface() const;
  const std::vector<StrokeEvent>& events() const;
  const FrameStatistics& statistics() const;
  const BuiltParts& parts() const;
  /// How the dynamics steps, and why so: one line for a log.
  const std::string& solver_summary() const;
  /// Readings of the scene's probes, in its order. Computed when asked for.
  const std::vector<ProbeReading>& probes() const;
  /// With what the fixed and then the prescribed regions are held. Computed when asked for; a load or Reset() is no frame.
  const std::vector<Reaction>& reactions() const;

  const Scene& scene() const;
  const LatticeReport& lattice_report() const;
  /// Tool pose and blade polyline (scene frame) at the end of the last frame; blade empty while inactive.
  const Tool& tool(int index) const;
  std::vector<Eigen::Vector3d> blade(int index) const;

  /// The paper's Fig. 12: integration points now (scene frame, m), and for each surface vertex the point it is mapped
  /// on.
  std::vector<Eigen::Vector3d> IntegrationPointPositions() const;
  std::vector<int> MappedPoints() const;

  /// The paper's mapping criteria at work: how often each decided, and, after CountPaperCriteria(), what they would
  /// have done without the graph. Both since load or Reset().
  void CountPaperCriteria();
  const MappingStatistics& mapping_statistics() const;
  const PaperCriteriaCounts& paper_criteria() const;

  /// Topology, mapping and state, for tests and studies; another one after Reset().
  const SoftBody& body() const;

  /// All invariants of topology and mapping, for tests; empty when they hold, else the first that does not, in words.
  std::string CheckInvariants() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace meshless_cutting
