#include "message_conversions.h"

#include <algorithm>
#include <boost/make_shared.hpp>

namespace meshless_cutting {
namespace {

std_msgs::Header Header(const Scene& scene, const FrameTag& tag) {
  std_msgs::Header header;
  header.stamp = ToTime(tag.stamp_ns);
  header.frame_id = scene.frame;
  return header;
}

std::vector<float> ToFloats(const std::vector<Eigen::Vector3d>& points) {
  std::vector<float> floats(3 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) floats[3 * i + axis] = static_cast<float>(points[i][axis]);
  }
  return floats;
}

std::vector<geometry_msgs::Point> ToPointList(const std::vector<Eigen::Vector3d>& points) {
  std::vector<geometry_msgs::Point> list(points.size());
  std::transform(points.begin(), points.end(), list.begin(), ToPoint);
  return list;
}

std::string Build() {
  std::string build = "C++ ";
#ifdef __VERSION__
  build += __VERSION__;
#endif
  build += ", Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
           std::to_string(EIGEN_MINOR_VERSION);
  return build;
}

}  // namespace

ros::Time ToTime(std::int64_t nanoseconds) {
  ros::Time time;
  return time.fromNSec(static_cast<std::uint64_t>(std::max<std::int64_t>(nanoseconds, 0)));
}

geometry_msgs::Point ToPoint(const Eigen::Vector3d& point) {
  geometry_msgs::Point message;
  message.x = point.x();
  message.y = point.y();
  message.z = point.z();
  return message;
}

geometry_msgs::Pose ToPose(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  geometry_msgs::Pose message;
  message.position = ToPoint(pose.translation());
  message.orientation.x = q.x();
  message.orientation.y = q.y();
  message.orientation.z = q.z();
  message.orientation.w = q.w();
  return message;
}

std::vector<Eigen::Vector3d> ToPoints(const geometry_msgs::Polygon& polygon) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(polygon.points.size());
  for (const auto& p : polygon.points) points.emplace_back(p.x, p.y, p.z);
  return points;
}

SurfaceTopologyPtr ToTopology(const Scene& scene, const Surface& surface, const FrameTag& tag) {
  auto message = boost::make_shared<SurfaceTopology>();
  message->header = Header(scene, tag);
  message->object = scene.object.name;
  message->session = tag.session;
  message->version = surface.version;
  message->step = tag.step;
  message->triangles.reserve(3 * surface.triangles.size());
  for (const auto& triangle : surface.triangles) {
    message->triangles.insert(message->triangles.end(), triangle.begin(), triangle.end());
  }
  message->region.reserve(surface.region.size());
  for (const SurfaceRegion region : surface.region) message->region.push_back(static_cast<std::uint8_t>(region));
  message->fragment = surface.fragment;
  message->rest_positions = ToFloats(surface.rest_positions);
  message->rest_pose = ToPose(scene.object.T_WO);
  return message;
}

SurfacePositionsPtr ToPositions(const Scene& scene, const Surface& surface, const FrameTag& tag,
                                PositionEncoding encoding, int* not_finite) {
  auto message = boost::make_shared<SurfacePositions>();
  message->header = Header(scene, tag);
  message->object = scene.object.name;
  message->session = tag.session;
  message->version = surface.version;
  message->step = tag.step;
  Encode(surface.positions, encoding, message.get());
  if (not_finite) {
    *not_finite = static_cast<int>(std::count_if(surface.positions.begin(), surface.positions.end(),
                                                 [](const Eigen::Vector3d& p) { return !p.allFinite(); }));
  }
  return message;
}

CutEventPtr ToCutEvent(const Scene& scene, const StrokeEvent& event, const FrameTag& tag) {
  auto message = boost::make_shared<CutEvent>();
  message->header = Header(scene, tag);
  message->object = scene.object.name;
  if (event.tool >= 0 && event.tool < static_cast<int>(scene.tools.size()))
    message->tool = scene.tools[event.tool].name;
  message->session = tag.session;
  message->step = tag.step;
  message->event = static_cast<std::uint8_t>(event.type);
  message->stroke = static_cast<std::uint32_t>(event.stroke);
  message->links_cut = static_cast<std::uint32_t>(event.links_cut);
  message->area_m2 = event.area_m2;
  message->length_m = event.length_m;
  message->depth_m = event.depth_m;
  message->points = ToPointList(event.points);
  message->rest_points = ToPointList(event.rest_points);
  message->fragments = static_cast<std::uint32_t>(event.fragment_volume_m3.size());
  message->fragment_volume_m3 = event.fragment_volume_m3;
  return message;
}

StepStatisticsPtr ToStatistics(const Scene& scene, const FrameStatistics& statistics, const FrameTag& tag,
                               std::int64_t input_until_ns, bool with_wall_times) {
  auto message = boost::make_shared<StepStatistics>();
  message->header = Header(scene, tag);
  message->session = tag.session;
  message->step = tag.step;
  message->status = statistics.status;
  message->input_until = ToTime(input_until_ns);
  if (with_wall_times) {
    message->move_tools_s = statistics.move_tools_s;
    message->find_crossings_s = statistics.find_crossings_s;
    message->cut_s = statistics.cut_s;
    message->advance_s = statistics.advance_s;
    message->map_surface_s = statistics.map_surface_s;
    message->total_s = statistics.total_s;
    message->missed = statistics.total_s > scene.time_step_s;
  }
  message->deadline_s = scene.time_step_s;
  message->newton_iterations = static_cast<std::uint32_t>(statistics.newton_iterations);
  message->linear_iterations = static_cast<std::uint32_t>(statistics.linear_iterations);
  message->relative_residual = statistics.relative_residual;
  message->particles = static_cast<std::uint32_t>(statistics.particles);
  message->integration_points = static_cast<std::uint32_t>(statistics.integration_points);
  message->links = static_cast<std::uint32_t>(statistics.links);
  message->links_cut = static_cast<std::uint32_t>(statistics.links_cut);
  message->vertices = static_cast<std::uint32_t>(statistics.vertices);
  message->triangles = static_cast<std::uint32_t>(statistics.triangles);
  message->fragments = static_cast<std::uint32_t>(statistics.fragments);
  message->contacts = static_cast<std::uint32_t>(statistics.contacts);
  message->kinetic_j = statistics.kinetic_j;
  message->elastic_j = statistics.elastic_j;
  message->gravity_j = statistics.gravity_j;
  return message;
}

SessionInfoPtr ToSessionInfo(const Simulation& simulation, const FrameTag& tag) {
  const Scene& scene = simulation.scene();
  const BuiltParts& parts = simulation.parts();
  const LatticeReport& lattice = simulation.lattice_report();
  const FrameStatistics& sizes = simulation.statistics();
  auto message = boost::make_shared<SessionInfo>();
  message->header = Header(scene, tag);
  message->session = tag.session;
  message->object = scene.object.name;
  message->scene_file = scene.file.string();
  message->scene_text = scene.text;
  message->version = MESHLESS_CUTTING_VERSION;
  message->build = Build();
  message->time_step_s = scene.time_step_s;
  for (const ToolConfig& tool : scene.tools) message->tools.push_back(tool.name);
  message->has_gravity = parts.gravity;
  message->has_damping = parts.damping;
  message->has_fixed = parts.fixed;
  message->has_obstacles = parts.obstacles;
  message->has_tools = parts.tools;
  message->particles = static_cast<std::uint32_t>(sizes.particles);
  message->integration_points = static_cast<std::uint32_t>(sizes.integration_points);
  message->links = static_cast<std::uint32_t>(sizes.links);
  message->vertices = static_cast<std::uint32_t>(simulation.surface().rest_positions.size());
  message->triangles = static_cast<std::uint32_t>(simulation.surface().triangles.size());
  message->volume_m3 = lattice.volume_m3;
  message->lattice_spacing.x = lattice.spacing.x();
  message->lattice_spacing.y = lattice.spacing.y();
  message->lattice_spacing.z = lattice.spacing.z();
  message->input_to_skin_max_m = lattice.input_to_skin_max_m;
  message->input_to_skin_mean_m = lattice.input_to_skin_mean_m;
  message->skin_to_input_max_m = lattice.skin_to_input_max_m;
  return message;
}

}  // namespace meshless_cutting
