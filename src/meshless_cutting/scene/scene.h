// What a scene file says, as plain values: read by scene_reader.h, built by simulation.cpp.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace meshless_cutting {

/// Axis-aligned box, closed, in the frame that its owner names.
struct Box {
  Eigen::Vector3d min = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d max = Eigen::Vector3d::Zero();  // m
  std::string name = {};                          // for reports; may be empty

  /// Whether X is inside or within `slack` (m) of it.
  bool Holds(const Eigen::Vector3d& X, double slack) const {
    return (X.array() >= min.array() - slack).all() && (X.array() <= max.array() + slack).all();
  }
};

/// A quantity over simulated time: through the given values, the first before and the last after them.
template <class T>
struct TimeTable {
  std::vector<double> time_s;  // rising
  std::vector<T> values;       // one per time, at least one
  bool smooth = false;         // come to rest at every value (cubic); else straight lines

  T At(double time) const {
    std::size_t next = 0;
    while (next < time_s.size() && time_s[next] <= time) ++next;
    if (next == 0) return values.front();
    if (next == time_s.size()) return values.back();
    double share = (time - time_s[next - 1]) / (time_s[next] - time_s[next - 1]);
    if (smooth) share *= share * (3 - 2 * share);
    return (1 - share) * values[next - 1] + share * values[next];
  }
};

enum class MaterialModel { kStableNeoHookean, kNeoHookean, kStVenantKirchhoff, kLinear };

/// One Maxwell branch of a Prony series.
struct PronyBranch {
  double modulus_ratio = 0;      // its shear modulus over that of the material, which is what remains when it has relaxed
  double relaxation_time_s = 0;
};

struct MaterialConfig {
  MaterialModel model = MaterialModel::kStableNeoHookean;
  double youngs_modulus_pa = 0;
  double poisson_ratio = 0;
  double density_kg_m3 = 0;
  std::vector<PronyBranch> prony = {};  // viscoelasticity; empty: none
};

/// Shapes that need no mesh file. All in the object frame.
struct CylinderPrimitive {
  Eigen::Vector3d start = Eigen::Vector3d::Zero(), end = Eigen::Vector3d::UnitZ();  // m, centres of the two faces
  double radius = 0;                                                                // m
};
/// The outline, a simple polygon in the two axes that follow `axis` (x: y, z; y: z, x; z: x, y), drawn out along it.
struct PrismPrimitive {
  int axis = 2;
  std::vector<Eigen::Vector2d> outline;  // m
  double from = 0, to = 0;               // m, along the axis
};
using Primitive = std::variant<Box, CylinderPrimitive, PrismPrimitive>;

/// Particles in a box are held and moved: X goes to c + R(angle) (X - c) + displacement, in the object frame.
struct PrescribedRegion {
  Box box;
  TimeTable<Eigen::Vector3d> displacement_m;
  Eigen::Vector3d axis_point = Eigen::Vector3d::Zero();  // c, m
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();       // unit
  TimeTable<double> angle_rad;
};

/// A dead load on the skin that lies in a box: its direction and size do not follow the tissue.
struct LoadRegion {
  Box box;
  bool is_traction = false;         // values are Pa of area at rest, else N in total
  TimeTable<Eigen::Vector3d> load;  // object frame
};

/// Another material in a part of the object. Where regions overlap the last one counts.
struct MaterialRegion {
  std::optional<Box> box;
  std::filesystem::path mesh;  // or inside this, scaled as the object's
  MaterialConfig material;
};

/// A cut that is there from the start: the parallelogram corner + u edges[0] + v edges[1], object frame, m.
struct Slit {
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();
  Eigen::Vector3d edges[2] = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};
};

/// A point of the tissue whose displacement is recorded.
struct ProbeConfig {
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m, at rest, object frame
  Eigen::Vector3d side = Eigen::Vector3d::Zero();      // where it lies on a cut: it belongs to the lip on this side
};

/// The tissue. The *object frame* is the mesh's own frame after scaling; rest positions, `fixed` and everything that is
/// called "rest" are in it. `T_WO` places the object frame in the scene frame W at the start.
struct ObjectConfig {
  std::string name;
  std::filesystem::path mesh;  // resolved, absolute; empty where there is a primitive
  std::optional<Primitive> primitive;
  double scale = 1;            // mesh units to metres
  Eigen::Isometry3d T_WO = Eigen::Isometry3d::Identity();
  double cell_size_m = 0;     // background grid
  double lattice_size_m = 0;  // resolution of cuts and of the skin
  MaterialConfig material;
  std::vector<Box> fixed;             // object frame; empty: nothing is held
  double support_radius_cells = 0.9;  // MLS support about the centre of a cell
  double stabilisation = 1.75;        // weight of the term against zero-energy modes
  std::vector<PrescribedRegion> prescribed;
  std::vector<LoadRegion> loads;
  std::vector<MaterialRegion> regions;
  std::vector<Slit> slits;
};

struct PlaneObstacle {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    // m, scene frame
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, points to where tissue may be
};
struct BoxObstacle {
  Eigen::Vector3d half_extents = Eigen::Vector3d::Zero();  // m
  Eigen::Isometry3d T_WB = Eigen::Isometry3d::Identity();  // centre of the box in the scene frame
};
struct ObstacleConfig {
  std::variant<PlaneObstacle, BoxObstacle> shape;
  double friction = 0;  // Coulomb coefficient
};

/// The collision boxes of a link of robot_description; the ROS layer puts them among the obstacles.
struct LinkObstacle {
  std::string link;
  double friction = 0;  // Coulomb coefficient
  std::string key;      // in the scene file
};

struct DampingConfig {
  double mass_per_s = 0;   // Rayleigh, proportional to mass
  double stiffness_s = 0;  // Rayleigh, proportional to stiffness
};

enum class Integrator { kGeneralizedAlpha, kImplicitEuler, kQuasiStatic, kExplicit, kAuto };

struct SolverConfig {
  Integrator integrator = Integrator::kGeneralizedAlpha;
  double relative_tolerance = 1e-2;  // Newton stops when the residual has fallen to this share of the step's loads
  int newton_iterations = 4;         // at most, per step
  int threads = 2;                   // the result does not depend on it
  int sub_steps = 1;                 // steps per frame, of time_step_s / sub_steps
};

struct TopicPoseSource {
  std::string topic;
};
struct TfPoseSource {
  std::string frame;
};
struct FixedPoseSource {
  Eigen::Isometry3d T_WT = Eigen::Isometry3d::Identity();
};

/// Which clock stamps the samples of a tool.
enum class StampPolicy {
  kHeader,   // that of the message; where it is 0, the time of receipt
  kReceipt,  // the time of receipt, whatever the message says: drivers whose clock is not ours
};

/// The blade cuts only while a button of a sensor_msgs/Joy is pressed.
struct BladeButton {
  std::string topic;
  int index = 0;  // of Joy.buttons
};

/// An estimate of the force on a tool, for a haptic device; see force_estimate.h.
struct ForceConfig {
  double toughness_j_m2 = 200;                 // work per cut face, one lip
  std::optional<Eigen::Vector3d> flat_normal;  // of the blade's flat, unit, tool frame; absent: it has none
  double stiffness_n_m2 = 5000;                // of the lips: force per length inside and per displacement
  double relaxation_s = 0.3;                   // in which the lips give way
  double max_force_n = 3;
  double max_slope_n_s = 30;
};

struct ToolConfig {
  std::string name;
  std::vector<Eigen::Vector3d> cutting_edge;  // m, polyline in the tool frame, >= 2 points; empty when urdf_link is set
  std::string urdf_link;                      // take the edge from this link of robot_description
  std::variant<TopicPoseSource, TfPoseSource, FixedPoseSource> pose_source;
  double max_speed_m_s = 2.0;  // faster between two samples: a jump, not a motion
  double timeout_s = 0.1;      // no sample for this long: the blade is inactive
  // How the messages of a driver are read; only with TopicPoseSource.
  StampPolicy stamp_policy = StampPolicy::kHeader;
  std::string frame_id;        // of the samples, instead of what their header says; empty: the header's
  double position_scale = 1;   // units of the driver to metres
  bool position_only = false;  // the driver's orientation is not used: the tool keeps `orientation`
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // with position_only, in the frame of the samples
  std::optional<BladeButton> blade_button;                          // absent: the blade always cuts
  std::optional<ForceConfig> force;                                 // absent: no force is estimated
};

/// A cut that a trainee shall make.
struct PlannedCut {
  std::string tool;                          // empty: any
  std::vector<Eigen::Vector3d> points;       // m, polyline at rest, object frame
  std::optional<Eigen::Vector3d> direction;  // deviation is seen along it, so that depth does not count; object frame
};

/// Where nothing shall be cut: a vessel, a nerve.
struct ForbiddenZone {
  std::string name;
  Box box;  // at rest, object frame
};

/// What `bag_report` judges a session by; the simulation does not use it.
struct AssessmentConfig {
  std::vector<PlannedCut> planned;
  std::vector<ForbiddenZone> forbidden;
};

/// The file that a configuration was read from, for messages and for the record.
struct SourceFile {
  std::filesystem::path file;
  std::string text;                  // as read
  std::map<std::string, int> lines;  // line, from 1, of each key, e.g. "object.mesh" or "tools[0].name"
};

/// The one line that reports a value of a file: "file:line: key `key`: value: expected ...". A key that the file does
/// not name is reported at the nearest section above it. Empty `value`: left out.
std::string SceneMessage(const SourceFile& source, const std::string& key, const std::string& value,
                         const std::string& expected);

/// A whole scene. A part that is absent here is never built.
struct Scene : SourceFile {
  std::string frame = "world";
  double time_step_s = 1.0 / 60;
  ObjectConfig object;
  std::optional<Eigen::Vector3d> gravity_m_s2;  // scene frame
  std::vector<ObstacleConfig> obstacles;        // scene frame
  std::vector<LinkObstacle> link_obstacles;     // empty once they are among `obstacles`
  std::optional<DampingConfig> damping;
  std::vector<ToolConfig> tools;
  std::vector<ProbeConfig> probes;
  SolverConfig solver;
  AssessmentConfig assessment;
};

}  // namespace meshless_cutting
