// Tools and obstacles as markers.
#include <cmath>

#include "markers.h"

namespace meshless_cutting {
namespace {

constexpr double kScalpelEdge = 0.03;  // m, the edge of meshes/scalpel.stl: from the tool's origin along its +z
constexpr double kPlateSize = 0.6;     // m, how much is drawn of a plane
constexpr double kPlateThickness = 0.002;

visualization_msgs::Marker NewMarker(const Scene& scene, ros::Time stamp, const std::string& name, int id, int type) {
  visualization_msgs::Marker marker;
  marker.header.stamp = stamp;
  marker.header.frame_id = scene.frame;
  marker.ns = name;
  marker.id = id;
  marker.type = type;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1;
  marker.scale.x = marker.scale.y = marker.scale.z = 1;
  return marker;
}

void SetColor(visualization_msgs::Marker* marker, float r, float g, float b, float a = 1) {
  marker->color.r = r;
  marker->color.g = g;
  marker->color.b = b;
  marker->color.a = a;
}

// Whether the tool is drawn as a scalpel: a straight edge along +z from the origin.
bool HasScalpelEdge(const ToolConfig& tool) {
  if (tool.cutting_edge.empty() || tool.cutting_edge.front().norm() > 1e-6) return false;
  const Eigen::Vector3d& tip = tool.cutting_edge.back();
  return tip.head<2>().norm() < 1e-6 && tip.z() > 0;
}

}  // namespace

std::vector<visualization_msgs::Marker> ToolMarkers(const Scene& scene, const std::vector<ToolView>& tools,
                                                    ros::Time stamp) {
  std::vector<visualization_msgs::Marker> markers;
  for (int i = 0; i < static_cast<int>(tools.size()); ++i) {
    if (!tools[i].T_WT) continue;
    const ToolConfig& config = scene.tools[i];
    const bool active = !tools[i].blade.empty();
    if (HasScalpelEdge(config)) {
      auto body = NewMarker(scene, stamp, "tool", i, visualization_msgs::Marker::MESH_RESOURCE);
      body.mesh_resource = "package://meshless_cutting/meshes/scalpel.stl";
      body.pose = ToPose(*tools[i].T_WT);
      body.scale.x = body.scale.y = body.scale.z = config.cutting_edge.back().z() / kScalpelEdge;
      SetColor(&body, 0.93f, 0.94f, 0.96f);
      markers.push_back(body);
    }
    auto blade = NewMarker(scene, stamp, "blade", i, visualization_msgs::Marker::LINE_STRIP);
    blade.scale.x = active ? 0.0012 : 0.0006;
    if (active) {
      SetColor(&blade, 1.0f, 0.85f, 0.2f);
      for (const Eigen::Vector3d& point : tools[i].blade) blade.points.push_back(ToPoint(point));
    } else {
      SetColor(&blade, 0.5f, 0.5f, 0.5f);
      for (const Eigen::Vector3d& point : config.cutting_edge) blade.points.push_back(ToPoint(*tools[i].T_WT * point));
    }
    markers.push_back(blade);
  }
  return markers;
}

std::vector<visualization_msgs::Marker> ObstacleMarkers(const Scene& scene, ros::Time stamp) {
  std::vector<visualization_msgs::Marker> markers;
  for (int i = 0; i < static_cast<int>(scene.obstacles.size()); ++i) {
    auto marker = NewMarker(scene, stamp, "obstacle", i, visualization_msgs::Marker::CUBE);
    SetColor(&marker, 0.90f, 0.93f, 0.96f);
    if (const auto* plane = std::get_if<PlaneObstacle>(&scene.obstacles[i].shape)) {
      Eigen::Isometry3d T_WP = Eigen::Isometry3d::Identity();
      T_WP.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), plane->normal).toRotationMatrix();
      T_WP.translation() = plane->point - 0.5 * kPlateThickness * plane->normal;
      marker.pose = ToPose(T_WP);
      marker.scale.x = marker.scale.y = kPlateSize;
      marker.scale.z = kPlateThickness;
    } else {
      const auto& box = std::get<BoxObstacle>(scene.obstacles[i].shape);
      marker.pose = ToPose(box.T_WB);
      marker.scale.x = 2 * box.half_extents.x();
      marker.scale.y = 2 * box.half_extents.y();
      marker.scale.z = 2 * box.half_extents.z();
    }
    markers.push_back(marker);
  }
  return markers;
}

visualization_msgs::Marker ClearMarker(const Scene& scene, ros::Time stamp) {
  auto marker = NewMarker(scene, stamp, "", 0, visualization_msgs::Marker::CUBE);
  marker.action = visualization_msgs::Marker::DELETEALL;
  return marker;
}

}  // namespace meshless_cutting
