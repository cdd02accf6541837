// The surface and its held part as markers.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "markers.h"

namespace meshless_cutting {
namespace {

using Color = Eigen::Vector3f;

const Color kSkinColor(0.50f, 0.13f, 0.10f);     // capsule of a liver
const Color kCutFaceColor(0.98f, 0.55f, 0.52f);  // fresh parenchyma
constexpr float kSkinAmbient = 0.30f;
constexpr float kCutFaceAmbient = 0.50f;  // lips that face each other light each other
const Color kHeldColor(0.25f, 0.55f, 0.85f);

Eigen::Vector3f Vertex(const std::vector<float>& xyz, std::size_t i) {
  return {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
}

// Daylight from above, a lamp at the surgeon's left shoulder, a weak fill from behind, and the gloss of a wet surface.
Color Lit(const Color& color, float ambient, const Eigen::Vector3f& normal) {
  static const Eigen::Vector3f lamp = Eigen::Vector3f(-0.45f, -0.55f, 0.75f).normalized();
  static const Eigen::Vector3f fill = Eigen::Vector3f(0.7f, 0.5f, 0.1f).normalized();
  static const Eigen::Vector3f half = (lamp + Eigen::Vector3f(0.1f, -0.75f, 0.65f).normalized()).normalized();
  const float sky = ambient + 0.14f * normal.z();
  const float diffuse = 0.85f * std::max(0.0f, normal.dot(lamp)) + 0.22f * std::max(0.0f, normal.dot(fill));
  const float gloss = 0.30f * std::pow(std::max(0.0f, normal.dot(half)), 40.0f);
  return ((sky + diffuse) * color + Color::Constant(gloss)).cwiseMin(1.0f).cwiseMax(0.0f);
}

visualization_msgs::Marker NewMarker(const SurfacePositions& positions, const std::string& name, int type) {
  visualization_msgs::Marker marker;
  marker.header = positions.header;
  marker.ns = name;
  marker.id = 0;
  marker.type = type;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1;
  marker.scale.x = marker.scale.y = marker.scale.z = 1;
  marker.color.a = 1;
  return marker;
}

std_msgs::ColorRGBA ToColor(const Color& color) {
  std_msgs::ColorRGBA message;
  message.r = color[0];
  message.g = color[1];
  message.b = color[2];
  message.a = 1;
  return message;
}

geometry_msgs::Point PointAt(const std::vector<float>& xyz, std::size_t i) {
  return ToPoint(Vertex(xyz, i).cast<double>());
}

}  // namespace

visualization_msgs::Marker SurfaceMarker(const SurfaceTopology& topology, const SurfacePositions& positions) {
  const std::size_t vertices = positions.positions.size() / 3;
  const std::size_t triangles = topology.region.size();
  // A vertex where the cut meets the skin has a normal on either.
  std::array<std::vector<Eigen::Vector3f>, 2> normals;
  for (auto& of_region : normals) of_region.assign(vertices, Eigen::Vector3f::Zero());
  for (std::size_t t = 0; t < triangles; ++t) {
    const std::uint32_t* v = &topology.triangles[3 * t];
    const Eigen::Vector3f a = Vertex(positions.positions, v[0]);
    const Eigen::Vector3f normal =
        (Vertex(positions.positions, v[1]) - a).cross(Vertex(positions.positions, v[2]) - a);  // weighted by area
    for (int i = 0; i < 3; ++i) normals[topology.region[t] ? 1 : 0][v[i]] += normal;
  }
  std::array<std::vector<std_msgs::ColorRGBA>, 2> colors;
  for (int region = 0; region < 2; ++region) {
    colors[region].resize(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
      colors[region][v] = ToColor(Lit(region == 0 ? kSkinColor : kCutFaceColor,
                                      region == 0 ? kSkinAmbient : kCutFaceAmbient, normals[region][v].normalized()));
    }
  }
  visualization_msgs::Marker marker = NewMarker(positions, "surface", visualization_msgs::Marker::TRIANGLE_LIST);
  marker.points.resize(3 * triangles);
  marker.colors.resize(3 * triangles);
  for (std::size_t i = 0; i < 3 * triangles; ++i) {
    const std::uint32_t v = topology.triangles[i];
    marker.points[i] = PointAt(positions.positions, v);
    marker.colors[i] = colors[topology.region[i / 3] ? 1 : 0][v];
  }
  return marker;
}

visualization_msgs::Marker FixedMarker(const Scene& scene, const SurfaceTopology& topology,
                                       const SurfacePositions& positions) {
  visualization_msgs::Marker marker = NewMarker(positions, "held", visualization_msgs::Marker::SPHERE_LIST);
  marker.scale.x = marker.scale.y = marker.scale.z = 0.4 * scene.object.lattice_size_m;
  marker.color = ToColor(kHeldColor);
  for (std::size_t v = 0; v < topology.rest_positions.size() / 3 && 3 * v + 2 < positions.positions.size(); ++v) {
    const Eigen::Array3d rest = Vertex(topology.rest_positions, v).cast<double>().array();
    for (const Box& box : scene.object.fixed) {
      if ((rest >= box.min.array()).all() && (rest <= box.max.array()).all()) {
        marker.points.push_back(PointAt(positions.positions, v));
        break;
      }
    }
  }
  return marker;
}

visualization_msgs::MarkerArray MappingMarkers(const MappingView& mapping, const SurfacePositions& positions) {
  visualization_msgs::Marker points = NewMarker(positions, "integration_points", visualization_msgs::Marker::POINTS);
  points.scale.x = points.scale.y = 0.0008;
  points.color = ToColor(Color(0.1f, 0.35f, 0.8f));
  for (const Eigen::Vector3d& point : mapping.points) points.points.push_back(ToPoint(point));
  visualization_msgs::Marker lines = NewMarker(positions, "mapping", visualization_msgs::Marker::LINE_LIST);
  lines.scale.x = 0.0003;
  lines.color = ToColor(Color(0.95f, 0.6f, 0.1f));
  const std::size_t vertices = std::min(mapping.mapped.size(), positions.positions.size() / 3);
  for (std::size_t v = 0; v < vertices; ++v) {
    const int point = mapping.mapped[v];
    if (point < 0 || point >= static_cast<int>(mapping.points.size())) continue;
    lines.points.push_back(PointAt(positions.positions, v));
    lines.points.push_back(ToPoint(mapping.points[point]));
  }
  visualization_msgs::MarkerArray array;
  array.markers = {points, lines};
  return array;
}

}  // namespace meshless_cutting
