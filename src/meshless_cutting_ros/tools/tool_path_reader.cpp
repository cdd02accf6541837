// Way-points from YAML.
#include <cmath>

#include "scene/scene_sections.h"
#include "scene/yaml_section.h"
#include "tools/tool_path.h"

namespace meshless_cutting {
namespace {

Eigen::Quaterniond ReadOrientation(const YamlSection& section) {
  if (section.ExactlyOneOf({"orientation_xyzw", "z_axis"}) == "orientation_xyzw") {
    const YamlValue value = section.Get("orientation_xyzw");
    const std::vector<double> xyzw = value.Numbers(4, "x, y, z, w");
    const Eigen::Quaterniond q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
    if (!(std::abs(q.norm() - 1) < 0.1)) value.Fail("a unit quaternion x, y, z, w; [0, 0, 0, 1] is no rotation");
    return q.normalized();
  }
  const YamlValue z_value = section.Get("z_axis");
  const YamlValue x_value = section.Get("x_axis");
  const Eigen::Vector3d z = z_value.Vector3();
  if (!(z.norm() > 1e-6)) z_value.Fail("a direction that is not zero");
  const Eigen::Vector3d x = x_value.Vector3();
  const Eigen::Vector3d across = z.cross(x);
  if (!(across.norm() > 1e-3 * z.norm() * x.norm()) || x.isZero()) x_value.Fail("a direction across z_axis");
  Eigen::Matrix3d rotation;
  rotation.col(2) = z.normalized();
  rotation.col(1) = across.normalized();
  rotation.col(0) = rotation.col(1).cross(rotation.col(2));
  return Eigen::Quaterniond(rotation);
}

}  // namespace

ToolPath ReadToolPath(const std::filesystem::path& file) {
  SourceFile source;
  const YAML::Node tree = LoadYaml(
      file, "way-points of a tool (YAML) that start with `tool_path_version: 1`, e.g. launch/liver_strokes.yaml",
      &source);
  const YamlSection top(YamlValue(tree, "", &source), {"tool_path_version", "frame", "waypoints"});
  top.Get("tool_path_version").Integer(1, 1);
  const auto frame = top.Find("frame");
  std::vector<WayPoint> points;
  const YamlValue list = top.Get("waypoints");
  for (const YamlValue& item : list.List()) {
    const YamlSection section(item, {"time_s", "position_m", "orientation_xyzw", "z_axis", "x_axis"});
    WayPoint point;
    const YamlValue time = section.Get("time_s");
    point.time_s = time.Number(NumberRange::AtLeast(0));
    if (!points.empty() && !(point.time_s > points.back().time_s))
      time.Fail("a time after that of the way-point before");
    point.position_m = section.Get("position_m").Vector3();
    point.orientation = ReadOrientation(section);
    points.push_back(point);
  }
  if (points.size() < 2) list.Fail("at least two way-points");
  return ToolPath(frame ? ReadFrameId(*frame) : "world", points);
}

}  // namespace meshless_cutting
