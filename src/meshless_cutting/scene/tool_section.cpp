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

std::variant<TopicPoseSource, TfPoseSource, FixedPoseSource> ReadPoseSource(const YamlValue& value) {
  const YamlSection section(value, {"topic", "tf", "fixed"});
  const std::string kind = section.ExactlyOneOf({"topic", "tf", "fixed"});
  const YamlValue source = section.Get(kind);
  if (kind == "fixed") return FixedPoseSource{ReadPose(source)};
  if (kind == "tf") return TfPoseSource{ReadFrameId(source)};
  const std::string topic = source.Text();
  if (!IsGraphName(topic, "/~")) source.Fail("a topic name of letters, digits, `_` and `/`, e.g. scalpel/measured_cp");
  return TopicPoseSource{topic};
}

}  // namespace

ToolConfig ReadTool(const YamlValue& value) {
  const YamlSection section(value,
                            {"name", "cutting_edge_m", "urdf_link", "pose_source", "max_speed_m_s", "timeout_s"});
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
  return tool;
}

}  // namespace meshless_cutting
