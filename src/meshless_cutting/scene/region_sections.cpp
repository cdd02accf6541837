// Sections of `object` that shape it, hold it, load it; and the probes.
#include <cmath>

#include "scene/scene_sections.h"

namespace meshless_cutting {
namespace {

/// Names become columns of tables.
std::string ReadName(const YamlValue& value) {
  const std::string name = value.Text();
  for (const char c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_') value.Fail("letters, digits and underscores");
  }
  return name;
}

/// {name, box_m} of a region, its other keys known to the caller.
Box ReadRegionBox(const YamlSection& section) {
  Box box = ReadBox(section.Get("box_m"));
  if (const auto name = section.Find("name")) box.name = ReadName(*name);
  return box;
}

template <class T>
T ReadValue(const YamlValue& value);
template <>
double ReadValue<double>(const YamlValue& value) {
  return value.Number(NumberRange::Closed(-1e9, 1e9));
}
template <>
Eigen::Vector3d ReadValue<Eigen::Vector3d>(const YamlValue& value) {
  return value.Vector3();
}

/// A constant, or {time_s: [...], values: [...], interpolation: linear | smooth}.
template <class T>
TimeTable<T> ReadTimeTable(const YamlValue& value) {
  TimeTable<T> table;
  if (!value.node().IsMap()) {
    table.time_s = {0};
    table.values = {ReadValue<T>(value)};
    return table;
  }
  const YamlSection section(value, {"time_s", "values", "interpolation"});
  const YamlValue times = section.Get("time_s");
  for (const YamlValue& item : times.List()) {
    table.time_s.push_back(item.Number(NumberRange::AtLeast(0), "seconds from the start of the scene"));
    const std::size_t n = table.time_s.size();
    if (n > 1 && !(table.time_s[n - 1] > table.time_s[n - 2])) item.Fail("a time after the one before it");
  }
  if (table.time_s.empty()) times.Fail("at least one time");
  const YamlValue values = section.Get("values");
  for (const YamlValue& item : values.List()) table.values.push_back(ReadValue<T>(item));
  if (table.values.size() != table.time_s.size()) {
    values.Fail("as many values as there are times, " + std::to_string(table.time_s.size()));
  }
  if (const auto interpolation = section.Find("interpolation")) {
    const std::string name = interpolation->Text();
    if (name != "linear" && name != "smooth") interpolation->Fail("linear or smooth");
    table.smooth = name == "smooth";
  }
  return table;
}

Eigen::Vector3d ReadDirection(const YamlValue& value) {
  const Eigen::Vector3d direction = value.Vector3();
  if (!(direction.norm() > 1e-6)) value.Fail("a direction that is not zero");
  return direction.normalized();
}

int ReadAxis(const YamlValue& value) {
  const std::string axis = value.Text();
  if (axis != "x" && axis != "y" && axis != "z") value.Fail("x, y or z");
  return axis[0] - 'x';
}

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

bool EdgesCross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, const Eigen::Vector2d& d) {
  return Cross(b - a, c - a) * Cross(b - a, d - a) < 0 && Cross(d - c, a - c) * Cross(d - c, b - c) < 0;
}

PrismPrimitive ReadPrism(const YamlValue& value) {
  const YamlSection section(value, {"axis", "outline", "from", "to"});
  PrismPrimitive prism;
  prism.axis = ReadAxis(section.Get("axis"));
  const YamlValue outline = section.Get("outline");
  for (const YamlValue& item : outline.List()) {
    const std::vector<double> point = item.Numbers(2, "along the two axes that follow `axis`");
    prism.outline.emplace_back(point[0], point[1]);
  }
  const std::size_t n = prism.outline.size();
  if (n < 3) outline.Fail("at least three corners");
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (EdgesCross(prism.outline[i], prism.outline[i + 1], prism.outline[j], prism.outline[(j + 1) % n])) {
        outline.Fail("a polygon that does not cross itself");
      }
    }
  }
  double area = 0;
  for (std::size_t i = 0; i < n; ++i) area += 0.5 * Cross(prism.outline[i], prism.outline[(i + 1) % n]);
  if (!(std::abs(area) > 1e-12)) outline.Fail("a polygon with an area");
  prism.from = section.Get("from").Number(NumberRange::Any());
  const YamlValue to = section.Get("to");
  prism.to = to.Number(NumberRange::Any());
  if (!(prism.to > prism.from)) to.Fail("a number above `from`, " + Quote(section.Get("from").node()));
  return prism;
}

}  // namespace

Primitive ReadPrimitive(const YamlValue& value) {
  const YamlSection section(value, {"box_m", "cylinder_m", "prism_m"});
  const std::string kind = section.ExactlyOneOf({"box_m", "cylinder_m", "prism_m"});
  if (kind == "box_m") return ReadBox(section.Get("box_m"));
  if (kind == "prism_m") return ReadPrism(section.Get("prism_m"));
  const YamlSection keys(section.Get("cylinder_m"), {"start", "end", "radius"});
  CylinderPrimitive cylinder;
  cylinder.start = keys.Get("start").Vector3();
  cylinder.end = keys.Get("end").Vector3();
  cylinder.radius = keys.Get("radius").Number({1e-5, 10, false, false}, "in metres");
  if (!((cylinder.end - cylinder.start).norm() > 1e-5)) keys.Get("end").Fail("a point that differs from `start`");
  return cylinder;
}

Box ReadFixed(const YamlValue& value) { return ReadRegionBox(YamlSection(value, {"name", "box_m"})); }

PrescribedRegion ReadPrescribed(const YamlValue& value) {
  const YamlSection section(value, {"name", "box_m", "displacement_m", "rotation"});
  PrescribedRegion region;
  region.box = ReadRegionBox(section);
  if (!section.Has("displacement_m") && !section.Has("rotation")) {
    section.Fail("`displacement_m`, `rotation` or both; what does not move belongs in `object.fixed`");
  }
  region.displacement_m = {{0}, {Eigen::Vector3d::Zero()}};
  region.angle_rad = {{0}, {0.0}};
  if (const auto displacement = section.Find("displacement_m")) {
    region.displacement_m = ReadTimeTable<Eigen::Vector3d>(*displacement);
  }
  if (const auto rotation = section.Find("rotation")) {
    const YamlSection keys(*rotation, {"axis_point_m", "axis", "angle_rad"});
    region.axis_point = keys.Get("axis_point_m").Vector3();
    region.axis = ReadDirection(keys.Get("axis"));
    region.angle_rad = ReadTimeTable<double>(keys.Get("angle_rad"));
  }
  return region;
}

LoadRegion ReadLoad(const YamlValue& value) {
  const YamlSection section(value, {"name", "box_m", "force_n", "traction_pa"});
  LoadRegion load;
  load.box = ReadRegionBox(section);
  const std::string kind = section.ExactlyOneOf({"force_n", "traction_pa"});
  load.is_traction = kind == "traction_pa";
  load.load = ReadTimeTable<Eigen::Vector3d>(section.Get(kind));
  return load;
}

std::vector<std::string> MaterialRegionKeys() { return {"box_m", "mesh", "material"}; }

MaterialRegion ReadMaterialRegion(const YamlValue& value) {
  const YamlSection section(value, MaterialRegionKeys());
  MaterialRegion region;
  if (section.ExactlyOneOf({"box_m", "mesh"}) == "box_m") region.box = ReadBox(section.Get("box_m"));
  region.material = ReadMaterial(section.Get("material"));
  return region;
}

Slit ReadSlit(const YamlValue& value) {
  const YamlSection section(value, {"corner_m", "edges_m"});
  Slit slit;
  slit.corner = section.Get("corner_m").Vector3();
  const YamlValue edges = section.Get("edges_m");
  const std::vector<YamlValue> list = edges.List();
  if (list.size() != 2) edges.Fail("two vectors from the corner along the edges of the slit");
  for (int i = 0; i < 2; ++i) slit.edges[i] = list[i].Vector3();
  if (!(slit.edges[0].cross(slit.edges[1]).norm() > 1e-12)) edges.Fail("two vectors that span an area");
  return slit;
}

ProbeConfig ReadProbe(const YamlValue& value) {
  const YamlSection section(value, {"name", "position_m", "side"});
  ProbeConfig probe;
  probe.name = ReadName(section.Get("name"));
  probe.position = section.Get("position_m").Vector3();
  if (const auto side = section.Find("side")) probe.side = ReadDirection(*side);
  return probe;
}

}  // namespace meshless_cutting
