#include "simulation.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <utility>

#include "boundary/dead_loads.h"
#include "crossing/find_crossings.h"
#include "cut/soft_body.h"
#include "cut/stroke_log.h"
#include "lattice/primitives.h"
#include "simulation_checks.h"
#include "tool/blade_rim.h"

namespace meshless_cutting {
namespace {

/// Width of the rim of a slit and of a blade, in lattice sizes: see WithRim. Many times what a vertex stands off its place, and microns.
constexpr double kSlitRim = 1e-3;
constexpr double kBladeRim = 1e-5;

using Clock = std::chrono::steady_clock;

/// Seconds since the last call, or since it was made.
class Stopwatch {
 public:
  double Lap() {
    const Clock::time_point now = Clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  Clock::time_point last_ = Clock::now();
};

FilledLattice Fill(const Scene& scene) {
  TriangleMesh mesh;
  try {
    mesh = scene.object.primitive ? MeshOf(*scene.object.primitive)
                                  : ReadTriangleMesh(scene.object.mesh, scene.object.scale);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(SceneMessage(scene, "object.mesh", "", error.what()));
  }
  Eigen::Vector3d low = mesh.vertices[0], high = low;
  for (const Eigen::Vector3d& X : mesh.vertices) {
    low = low.cwiseMin(X);
    high = high.cwiseMax(X);
  }
  const double extent = (high - low).maxCoeff();
  auto too_large = [&](const char* key, double value) {
    if (value > extent)
      throw std::runtime_error(SceneMessage(scene, key, std::to_string(value),
                                            "expected at most the extent of the object, " + std::to_string(extent) +
                                                " m; check object.scale, or choose a smaller size"));
  };
  too_large("object.cell_size_m", scene.object.cell_size_m);
  too_large("object.lattice_size_m", scene.object.lattice_size_m);
  try {
    return FillWithLattice(mesh, scene.object.lattice_size_m);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(SceneMessage(scene, scene.object.primitive ? "object.primitive" : "object.mesh",
                                          scene.object.mesh.string(), error.what()));
  }
}

/// The part that a scene without tools does not have.
struct Cutting {
  struct ToolState {
    Tool tool;
    StrokeLog strokes;
    BladeMotion motion;
    FrameCut cut;
  };
  std::vector<ToolState> tools;
  CrossingFinder finder;

  Cutting(const Scene& scene, const SoftBody& body) : finder(body.lattice(), body.graph()) {
    for (size_t i = 0; i < scene.tools.size(); ++i)
      tools.push_back({Tool(scene.tools[i]), StrokeLog(static_cast<int>(i), scene.time_step_s), {}, {}});
  }
};

DynamicsConfig MakeDynamicsConfig(const Scene& scene) {
  DynamicsConfig config{scene.time_step_s,  scene.object.material, scene.solver,
                        scene.gravity_m_s2, scene.damping,         scene.obstacles};
  for (const MaterialRegion& region : scene.object.regions) config.region_materials.push_back(region.material);
  config.stabilisation = scene.object.stabilisation;
  return config;
}

Tuning TuningOf(const Scene& scene) {
  return {scene.gravity_m_s2.value_or(Eigen::Vector3d::Zero()), scene.damping.value_or(DampingConfig()),
          scene.solver.newton_iterations};
}

}  // namespace

struct Simulation::Parts {
  Parts(const Scene& s, const Progress& progress) : scene(s) {
    auto report = [&](const char* stage, double share) {
      if (progress) progress(stage, share);
    };
    report("filling the mesh with its lattice", 0);
    FilledLattice filled = Fill(scene);
    lattice = std::move(filled.lattice);
    lattice_report = filled.report;
    for (const LinkObstacle& obstacle : scene.link_obstacles) {
      throw std::runtime_error(SceneMessage(scene, obstacle.key, obstacle.link,
                                            "expected a robot description: only the ROS programs have one; give the "
                                            "obstacle as box_m"));
    }
    tuning = TuningOf(scene);
    built.gravity = scene.gravity_m_s2.has_value();
    built.damping = scene.damping.has_value();
    built.fixed = !scene.object.fixed.empty();
    built.obstacles = !scene.obstacles.empty();
    built.tools = !scene.tools.empty();
    built.prescribed = !scene.object.prescribed.empty();
    built.loads = !scene.object.loads.empty();
    built.regions = !scene.object.regions.empty();
    built.slits = !scene.object.slits.empty();
    built.probes = !scene.probes.empty();
    report("placing integration points and particles", 0.6);
    Build();
    for (size_t i = 0; i < scene.object.fixed.size(); ++i) {
      CheckHeld(scene.object.fixed[i], "object.fixed[" + std::to_string(i) + "]");
    }
    for (size_t i = 0; i < scene.object.prescribed.size(); ++i) {
      CheckHeld(scene.object.prescribed[i].box, "object.prescribed[" + std::to_string(i) + "]");
    }
    report("ready", 1);
  }

  void CheckHeld(const Box& box, const std::string& key) const {
    const double slack = 1e-9 * body->grid().spacing().maxCoeff();
    for (const Eigen::Vector3d& X : body->tissue().particle_rest)
      if (box.Holds(X, slack)) return;
    throw std::runtime_error(SceneMessage(scene, key, "",
                                          "holds no particle; expected a box in the object frame that reaches at least "
                                          "one node of the background grid; enlarge it"));
  }

  /// Everything that changes while the simulation runs.
  void Build() {
    cutting.reset();
    probes.reset();
    dynamics.reset();  // two bodies at once would need twice the memory
    body.reset();
    body = std::make_unique<SoftBody>(lattice, scene.object, built.tools || built.slits);
    if (built.slits) OpenSlits();
    dynamics = std::make_unique<Dynamics>(MakeDynamicsConfig(scene), body->tissue());
    if (tuning != TuningOf(scene)) dynamics->Tune(tuning, body->tissue());
    if (built.tools) cutting.emplace(scene, *body);
    if (built.fixed || built.prescribed) driven.emplace(scene);
    if (built.loads) loads.emplace(scene);
    if (built.probes) probes.emplace(scene, lattice, body->points(), body->shape(), body->tissue());
    TissueChanged();
    events.clear();
    statistics = FrameStatistics();
    statistics.time_s = start_s;
    Count();
  }

  void OpenSlits();
  void TissueChanged();
  void MoveTools(double t0_s, double t1_s);
  void FindCrossings();
  void Cut();
  void Advance(double t1_s);
  void Count();

  Scene scene;
  Tuning tuning;
  BuiltParts built;
  Lattice lattice;
  LatticeReport lattice_report;
  double start_s = 0;

  std::unique_ptr<SoftBody> body;
  std::unique_ptr<Dynamics> dynamics;
  std::optional<Cutting> cutting;
  std::optional<DrivenRegions> driven;
  std::optional<DeadLoads> loads;
  std::optional<Probes> probes;
  std::vector<StrokeEvent> events;
  FrameStatistics statistics;
};

// ---- One frame, in the order of the paper's section 2.3
// -------------------------------------------------------------------

void Simulation::Step() {
  Parts& p = *parts_;
  FrameStatistics& s = p.statistics;
  const double t0_s = p.start_s + static_cast<double>(s.step) * p.scene.time_step_s;
  const double t1_s = p.start_s + static_cast<double>(s.step + 1) * p.scene.time_step_s;
  Stopwatch watch;
  p.events.clear();
  s.move_tools_s = s.find_crossings_s = s.cut_s = 0;
  if (p.cutting) {
    p.MoveTools(t0_s, t1_s);  // 1. move the blades along the samples of this frame
    s.move_tools_s = watch.Lap();
    p.FindCrossings();  // 2. links that they cross while the object moves as it did last
    s.find_crossings_s = watch.Lap();
    p.Cut();  // 3. graph, surface, integration points, twins, mapping
    s.cut_s = watch.Lap();
  }
  p.body->BeginAdvance();
  p.Advance(t1_s);  // 4. elastic dynamics
  s.advance_s = watch.Lap();
  p.body->EndAdvance();  //    and the surface after it
  s.map_surface_s = watch.Lap();
  s.total_s = s.move_tools_s + s.find_crossings_s + s.cut_s + s.advance_s + s.map_surface_s;
  ++s.step;
  s.time_s = t1_s;
  p.Count();
}

void Simulation::Parts::MoveTools(double t0_s, double t1_s) {
  for (auto& state : cutting->tools) {
    state.motion = state.tool.Move(t0_s, t1_s);
    state.cut = FrameCut();
    state.cut.active = !state.motion.empty();
    state.cut.jumps = state.tool.jumps();
  }
}

void Simulation::Parts::FindCrossings() {
  const double rim = kBladeRim * scene.object.lattice_size_m;
  for (auto& state : cutting->tools) state.cut.crossings = cutting->finder.Find(WithRim(state.motion, rim), body->motion());
  body->CloseWindow();
  // A link that several blades cross in this frame belongs to the first.
  auto& tools = cutting->tools;
  for (size_t i = 0; i < tools.size(); ++i)
    for (size_t j = 0; j < tools.size(); ++j) {
      if (i == j) continue;
      auto& mine = tools[i].cut.crossings;
      const auto& other = tools[j].cut.crossings;
      mine.erase(std::remove_if(mine.begin(), mine.end(),
                                [&](const Crossing& c) {
                                  const auto at =
                                      std::lower_bound(other.begin(), other.end(), c.cut.link,
                                                       [](const Crossing& o, int link) { return o.cut.link < link; });
                                  if (at == other.end() || at->cut.link != c.cut.link) return false;
                                  return at->t < c.t || (at->t == c.t && j < i);
                                }),
                 mine.end());
    }
}

void Simulation::Parts::Cut() {
  std::vector<LinkCut> cuts;
  for (const auto& state : cutting->tools)
    for (const Crossing& crossing : state.cut.crossings) cuts.push_back(crossing.cut);
  const size_t fragments_before = body->surface().fragment_volume_m3.size();
  if (!cuts.empty()) {
    const double area_before = body->cut_surface().cut_area();
    body->CutMaterial(cuts);
    dynamics->TissueChanged(body->tissue(), [&] { body->Redraw(cuts); });
    TissueChanged();
    const double area = body->cut_surface().cut_area() - area_before;
    for (auto& state : cutting->tools) {
      state.cut.area_m2 = area * static_cast<double>(state.cut.crossings.size()) / static_cast<double>(cuts.size());
      for (const Crossing& crossing : state.cut.crossings)
        state.cut.rest_points.push_back(body->graph().CutPoint(crossing.cut.link));
    }
  }
  for (auto& state : cutting->tools) state.strokes.Record(state.cut, events);
  if (body->surface().fragment_volume_m3.size() > fragments_before) {
    StrokeEvent event;
    event.type = StrokeEventType::kSeparated;
    for (const StrokeEvent& cause : events)
      if (cause.links_cut > 0 && event.tool < 0) {
        event.tool = cause.tool;
        event.stroke = cause.stroke;
      }
    event.fragment_volume_m3 = body->surface().fragment_volume_m3;
    events.push_back(event);
  }
}

/// Boundary conditions and probes after a load or a cut.
void Simulation::Parts::TissueChanged() {
  if (driven) driven->TissueChanged(body->tissue());
  if (probes) probes->TissueChanged();
  if (!loads) return;
  const int missed = loads->TissueChanged(body->tissue(), body->surface(), body->mapping().links());
  if (missed < 0 || statistics.step > 0) return;
  throw std::runtime_error(SceneMessage(scene, "object.loads[" + std::to_string(missed) + "].box_m", "",
                                        "holds no triangle of the skin; expected a box in the object frame that holds a part "
                                        "of the skin; enlarge it"));
}

/// Draws a blade through each slit before the first frame. A slit is closed: what its rim touches is cut, so that one which ends on
/// a layer of lattice vertices, which stand a millionth of the lattice off their place, ends there and not somewhere below.
void Simulation::Parts::OpenSlits() {
  CrossingFinder finder(body->lattice(), body->graph());
  for (const Slit& slit : scene.object.slits) {
    const double rim = kSlitRim * scene.object.lattice_size_m;
    const Eigen::Vector3d a = slit.edges[0].normalized() * rim, b = slit.edges[1].normalized() * rim;
    BladeWindow window;
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector3d start = slit.corner - a - b + i * (slit.edges[0] + 2 * a);
      window.points_t0.push_back(scene.object.T_WO * start);
      window.points_t1.push_back(scene.object.T_WO * Eigen::Vector3d(start + slit.edges[1] + 2 * b));
    }
    std::vector<LinkCut> cuts;
    for (const Crossing& crossing : finder.Find({window}, body->motion())) cuts.push_back(crossing.cut);
    body->CloseWindow();
    body->Cut(cuts);
    body->BeginAdvance();
    body->EndAdvance();
  }
}

void Simulation::Parts::Advance(double t1_s) {
  const double time_s = t1_s - start_s;  // schedules begin with the scene, whatever the clock says
  if (built.prescribed) driven->Drive(body->tissue(), time_s, *dynamics);
  if (loads) dynamics->SetForces(loads->At(time_s));
  const AdvanceResult result = dynamics->Advance(body->tissue(), body->mapping().links(), body->mutable_state());
  statistics.status = result.status;
  statistics.newton_iterations = result.newton_iterations;
  statistics.linear_iterations = result.linear_iterations;
  statistics.relative_residual = result.relative_residual;
  statistics.contacts = result.contacts;
  statistics.kinetic_j = result.kinetic_j;
  statistics.elastic_j = result.elastic_j;
  statistics.gravity_j = result.gravity_j;
}

void Simulation::Parts::Count() {
  statistics.particles = body->tissue().particle_count();
  statistics.integration_points = body->tissue().point_count();
  statistics.links = static_cast<int>(lattice.links.size());
  statistics.links_cut = body->graph().cut_count();
  statistics.vertices = static_cast<int>(body->surface().positions.size());
  statistics.triangles = static_cast<int>(body->surface().triangles.size());
  statistics.fragments = static_cast<int>(body->surface().fragment_volume_m3.size());
}

// ---- The rest of the interface
// -----------------------------------------------------------------------------------------------

Simulation::Simulation(const Scene& scene, const Progress& progress)
    : parts_(std::make_unique<Parts>(scene, progress)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;

void Simulation::Reset() {
  parts_->start_s = 0;
  parts_->Build();
}

SampleVerdict Simulation::AddToolSample(int tool, const ToolSample& sample) {
  return parts_->cutting->tools.at(static_cast<size_t>(tool)).tool.Add(sample);
}

bool Simulation::SetToolEdge(int tool, const std::vector<Eigen::Vector3d>& points) {
  return parts_->cutting->tools.at(static_cast<size_t>(tool)).tool.SetEdge(points);
}

void Simulation::SetTuning(const Tuning& tuning) {
  parts_->tuning = tuning;
  parts_->dynamics->Tune(tuning, parts_->body->tissue());
}
const Tuning& Simulation::tuning() const { return parts_->tuning; }

void Simulation::StartAt(double time_s) { parts_->start_s = parts_->statistics.time_s = time_s; }

const Surface& Simulation::surface() const { return parts_->body->surface(); }
const std::vector<StrokeEvent>& Simulation::events() const { return parts_->events; }
const FrameStatistics& Simulation::statistics() const { return parts_->statistics; }
const BuiltParts& Simulation::parts() const { return parts_->built; }
const std::string& Simulation::solver_summary() const { return parts_->dynamics->solver_summary(); }
const std::vector<ProbeReading>& Simulation::probes() const {
  static const std::vector<ProbeReading> kNone;
  return parts_->probes ? parts_->probes->Read(parts_->body->state()) : kNone;
}

const std::vector<Reaction>& Simulation::reactions() const {
  static const std::vector<Reaction> kNone;
  static const std::vector<Eigen::Vector3d> kNoForces;
  if (!parts_->driven) return kNone;
  return parts_->driven->Reactions(parts_->body->tissue(), parts_->body->state(), *parts_->dynamics,
                                   parts_->loads ? parts_->loads->forces() : kNoForces);
}

const Scene& Simulation::scene() const { return parts_->scene; }
const LatticeReport& Simulation::lattice_report() const { return parts_->lattice_report; }

const Tool& Simulation::tool(int index) const { return parts_->cutting->tools.at(static_cast<size_t>(index)).tool; }

std::vector<Eigen::Vector3d> Simulation::blade(int index) const {
  const BladeMotion& motion = parts_->cutting->tools.at(static_cast<size_t>(index)).motion;
  return motion.empty() ? std::vector<Eigen::Vector3d>() : motion.back().points_t1;
}

std::vector<Eigen::Vector3d> Simulation::IntegrationPointPositions() const {
  const SoftBody& body = *parts_->body;
  const size_t K = static_cast<size_t>(body.tissue().support_size);
  std::vector<double> phi(K);
  std::vector<Eigen::Vector3d> positions(body.points().points().size(), Eigen::Vector3d::Zero());
  for (size_t p = 0; p < positions.size(); ++p) {
    body.shape().Values(body.points().points()[p].cell, body.points().points()[p].centroid, phi.data());
    for (size_t k = 0; k < K; ++k)
      positions[p] += phi[k] * body.state().position[body.tissue().point_particles[p * K + k]];
  }
  return positions;
}

std::vector<int> Simulation::MappedPoints() const {
  std::vector<int> points;
  for (int v = 0; v < parts_->body->mapping().size(); ++v) points.push_back(parts_->body->mapping().point(v));
  return points;
}

void Simulation::CountPaperCriteria() { parts_->body->CountPaperCriteria(); }
const MappingStatistics& Simulation::mapping_statistics() const { return parts_->body->mapping().statistics(); }
const PaperCriteriaCounts& Simulation::paper_criteria() const {
  static const PaperCriteriaCounts none;
  const PaperCriteria* counted = parts_->body->mapping().paper_criteria();
  return counted ? counted->counts() : none;
}

const SoftBody& Simulation::body() const { return *parts_->body; }

std::string Simulation::CheckInvariants() const { return CheckBody(*parts_->body); }

}  // namespace meshless_cutting
