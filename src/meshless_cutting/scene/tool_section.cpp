// The `tools` of a scene file.
#include <cctype>

#include "scene/scene_sections.h"

namespace meshless_cutting {
namespace {

// A name that is also a part of topic names.
bool IsGraphName(const std::string& name, const std::string& more) {
  if (name.empty()) return false;
  for (const char c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && more.find(c) == std::string::npos) return false;
  }
  const char first = name.front();
  return std::isalpha(static_cast<unsigned char>(first)) || more.find(first) != std::string::npos;
}

std::vector<Eigen::Vector3d> ReadEdge(const YamlValue& value) {
  const std::vector<YamlValue> items = value.List();
  if (items.size() < 2) value.Fail("at least two points [x, y, z], in metres, tool frame");
  std::vector<Eigen::Vector3d> edge;
  for (const YamlValue& item : items) {
    edge.push_back(item.Vector3());
    const bool repeated = edge.size() > 1 && (edge.back() - edge[edge.size() - 2]).norm() < 1e-9;
    if (repeated) item.Fail("a point that differs from the one before it");
  }
  return edge;
}

std::string ReadTopic(const YamlValue& value) {
  const std::string topic = value.Text();
  if (!IsGraphName(topic, "/~")) value.Fail("a topic name of letters, digits, `_` and `/`, e.g. scalpel/measured_cp");
  return topic;
}

std::variant<TopicPoseSource, TfPoseSource, FixedPoseSource> ReadPoseSource(const YamlValue& value) {
  const YamlSection section(value, {"topic", "tf", "fixed"});
  const std::string kind = section.ExactlyOneOf({"topic", "tf", "fixed"});
  const YamlValue source = section.Get(kind);
  if (kind == "fixed") return FixedPoseSource{ReadPose(source)};
  if (kind == "tf") return TfPoseSource{ReadFrameId(source)};
  return TopicPoseSource{ReadTopic(source)};
}

const std::vector<std::string> kDriverKeys = {"stamp_policy", "frame_id", "position_scale", "position_only",
                                              "orientation_xyzw"};

// How the messages of the tool's driver are read.
void ReadDriver(const YamlSection& section, ToolConfig* tool) {
  for (const std::string& key : kDriverKeys) {
    const bool topic = std::holds_alternative<TopicPoseSource>(tool->pose_source);
    if (!topic && section.Has(key)) section.Get(key).Fail("this key only with pose_source: {topic: ...}");
  }
  if (const auto policy = section.Find("stamp_policy")) {
    const std::string name = policy->Text();
    if (name != "header" && name != "receipt") policy->Fail("header, or receipt for drivers with a clock of their own");
    tool->stamp_policy = name == "receipt" ? StampPolicy::kReceipt : StampPolicy::kHeader;
  }
  if (const auto frame = section.Find("frame_id")) tool->frame_id = ReadFrameId(*frame);
  if (const auto scale = section.Find("position_scale")) {
    tool->position_scale = scale->Number({1e-9, 1e9, false, false}, "metres per unit of the driver, 0.001 for mm");
  }
  if (const auto position_only = section.Find("position_only")) tool->position_only = position_only->Flag();
  if (const auto orientation = section.Find("orientation_xyzw")) {
    if (!tool->position_only) orientation->Fail("this key only with position_only: true");
    tool->orientation = ReadOrientation(*orientation);
  }
}

BladeButton ReadButton(const YamlValue& value) {
  const YamlSection section(value, {"topic", "index"});
  return {ReadTopic(section.Get("topic")), section.Get("index").Integer(0, 63)};
}

ForceConfig ReadForce(const YamlValue& value) {
  const YamlSection section(
      value, {"toughness_j_m2", "flat_normal", "stiffness_n_m2", "relaxation_s", "max_force_n", "max_slope_n_s"});
  ForceConfig force;
  const auto number = [&section](const char* key, const NumberRange& range, const char* remedy, double* target) {
    if (const auto found = section.Find(key)) *target = found->Number(range, remedy);
  };
  number("toughness_j_m2", NumberRange::Closed(0, 1e5), "in J/m^2: soft tissue has 50 to 500", &force.toughness_j_m2);
  number("stiffness_n_m2", NumberRange::Closed(0, 1e8), "in N/m^2: about Young's modulus", &force.stiffness_n_m2);
  number("relaxation_s", {0.001, 1000, false, false}, "in seconds", &force.relaxation_s);
  number("max_force_n", {0, 100, true, false}, "in N: a haptic device gives 3", &force.max_force_n);
  number("max_slope_n_s", {0, 1e5, true, false}, "in N/s", &force.max_slope_n_s);
  if (const auto normal = section.Find("flat_normal")) {
    force.flat_normal = normal->Vector3();
    if (!(force.flat_normal->norm() > 1e-6)) normal->Fail("a direction that is not zero, in the tool frame");
    force.flat_normal->normalize();
  }
  return force;
}

}  // namespace

ToolConfig ReadTool(const YamlValue& value) {
  std::vector<std::string> keys = {"name",          "cutting_edge_m", "urdf_link",   "pose_source",
                                   "max_speed_m_s", "timeout_s",      "blade_button", "force"};
  keys.insert(keys.end(), kDriverKeys.begin(), kDriverKeys.end());
  const YamlSection section(value, keys);
  ToolConfig tool;
  const YamlValue name = section.Get("name");
  tool.name = name.Text();
  if (!IsGraphName(tool.name, "")) name.Fail("letters, digits and `_`, a letter first: it becomes part of topic names");
  if (section.ExactlyOneOf({"cutting_edge_m", "urdf_link"}) == "urdf_link") {
    tool.urdf_link = section.Get("urdf_link").Text();
  } else {
    tool.cutting_edge = ReadEdge(section.Get("cutting_edge_m"));
  }
  tool.pose_source = ReadPoseSource(section.Get("pose_source"));
  if (const auto speed = section.Find("max_speed_m_s")) {
    tool.max_speed_m_s = speed->Number({0, 1e4, true, false}, "in m/s: a hand moves below 2");
  }
  if (const auto timeout = section.Find("timeout_s"))
    tool.timeout_s = timeout->Number({0, 3600, true, false}, "in seconds");
  ReadDriver(section, &tool);
  if (const auto button = section.Find("blade_button")) tool.blade_button = ReadButton(*button);
  if (const auto force = section.Find("force")) tool.force = ReadForce(*force);
  return tool;
}

}  // namespace meshless_cutting
