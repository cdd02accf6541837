#include "scene/scene_reader.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

#include "scene/scene_sections.h"
#include "scene/yaml_section.h"

namespace meshless_cutting {
namespace {

namespace fs = std::filesystem;

fs::path ResolveMesh(const YamlValue& value, const fs::path& scene_file, const PackageResolver& resolver) {
  const std::string text = value.Text();
  const std::string scheme = "package://";
  fs::path mesh = text;
  if (text.compare(0, scheme.size(), scheme) == 0) {
    const std::string rest = text.substr(scheme.size());
    const std::string package = rest.substr(0, rest.find('/'));
    const fs::path folder = resolver ? resolver(package) : fs::path();
    if (folder.empty()) {
      value.Fail("a package that can be found: source the setup file of the workspace with `" + package +
                 "`, or give a path instead of package://");
    }
    mesh = folder / rest.substr(std::min(rest.size(), package.size() + 1));
  } else if (mesh.is_relative()) {
    mesh = fs::absolute(scene_file).parent_path() / mesh;
  }
  mesh = mesh.lexically_normal();
  std::error_code error;
  if (!fs::is_regular_file(mesh, error)) value.Fail("a mesh file; there is none at " + mesh.string());
  return mesh;
}

// The name in a package.xml, without a parser for XML: the text of its first <name>.
std::string PackageName(const fs::path& package_xml) {
  std::ifstream stream(package_xml);
  std::ostringstream text;
  text << stream.rdbuf();
  const std::string content = text.str();
  const auto begin = content.find("<name>");
  const auto end = content.find("</name>");
  if (begin == std::string::npos || end == std::string::npos || end < begin + 6) return {};
  const std::string name = content.substr(begin + 6, end - begin - 6);
  const auto first = name.find_first_not_of(" \t\r\n");
  return first == std::string::npos ? "" : name.substr(first, name.find_last_not_of(" \t\r\n") - first + 1);
}

/// Rows and columns of reports go by these names.
void CheckNames(const Scene& scene) {
  std::set<std::string> regions, probes;
  const auto check = [&](std::set<std::string>& names, const std::string& name, const std::string& key) {
    if (name.empty() || names.insert(name).second) return;
    throw std::runtime_error(SceneMessage(scene, key + ".name", name, "expected a name that is not taken yet"));
  };
  for (std::size_t i = 0; i < scene.object.fixed.size(); ++i) {
    check(regions, scene.object.fixed[i].name, "object.fixed[" + std::to_string(i) + "]");
  }
  for (std::size_t i = 0; i < scene.object.prescribed.size(); ++i) {
    check(regions, scene.object.prescribed[i].box.name, "object.prescribed[" + std::to_string(i) + "]");
  }
  for (std::size_t i = 0; i < scene.probes.size(); ++i) {
    check(probes, scene.probes[i].name, "probes[" + std::to_string(i) + "]");
  }
}

}  // namespace

PackageResolver FindPackageAbove(const fs::path& start) {
  return [start](const std::string& package) -> fs::path {
    fs::path folder = fs::absolute(start).lexically_normal();
    while (true) {
      std::error_code error;
      if (fs::is_regular_file(folder / "package.xml", error) && PackageName(folder / "package.xml") == package)
        return folder;
      if (folder == folder.parent_path()) return {};
      folder = folder.parent_path();
    }
  };
}

Scene ReadScene(const fs::path& file, const PackageResolver& resolver) {
  Scene scene;
  const YAML::Node tree =
      LoadYaml(file, "a scene file (YAML) that starts with `scene_version: 1`, e.g. launch/liver.yaml", &scene);
  const YamlSection top(YamlValue(tree, "", &scene), {"scene_version", "frame", "time_step_s", "object", "gravity_m_s2",
                                                      "obstacles", "damping", "tools", "probes", "solver",
                                                      "assessment"});
  top.Get("scene_version").Integer(1, 1);
  if (const auto frame = top.Find("frame")) scene.frame = ReadFrameId(*frame);
  if (const auto step = top.Find("time_step_s")) scene.time_step_s = step->Number(NumberRange::Closed(0.0005, 0.1));
  scene.object = ReadObject(top.Get("object"));
  const YamlSection object(top.Get("object"), ObjectKeys());
  if (!scene.object.primitive) scene.object.mesh = ResolveMesh(object.Get("mesh"), file, resolver);
  for (std::size_t i = 0; i < scene.object.regions.size(); ++i) {
    const YamlSection region(object.Get("regions").List()[i], MaterialRegionKeys());
    if (const auto mesh = region.Find("mesh")) scene.object.regions[i].mesh = ResolveMesh(*mesh, file, resolver);
  }
  if (const auto gravity = top.Find("gravity_m_s2")) scene.gravity_m_s2 = gravity->Vector3();
  if (const auto obstacles = top.Find("obstacles")) {
    for (const YamlValue& item : obstacles->List()) {
      const bool is_link = item.node().IsMap() && item.node().size() == 1 && item.node()["urdf_link"].IsDefined();
      if (is_link) {
        scene.link_obstacles.push_back(ReadLinkObstacle(item));
      } else {
        scene.obstacles.push_back(ReadObstacle(item));
      }
    }
  }
  if (const auto damping = top.Find("damping")) scene.damping = ReadDamping(*damping);
  if (const auto tools = top.Find("tools")) {
    std::set<std::string> names;
    for (const YamlValue& item : tools->List()) {
      scene.tools.push_back(ReadTool(item));
      if (!names.insert(scene.tools.back().name).second) {
        throw std::runtime_error(SceneMessage(scene, item.key() + ".name", scene.tools.back().name,
                                              "expected a name that no other tool has"));
      }
    }
  }
  if (const auto probes = top.Find("probes")) {
    for (const YamlValue& item : probes->List()) scene.probes.push_back(ReadProbe(item));
  }
  CheckNames(scene);
  if (const auto assessment = top.Find("assessment")) {
    scene.assessment = ReadAssessment(*assessment);
    for (std::size_t i = 0; i < scene.assessment.planned.size(); ++i) {
      const std::string& tool = scene.assessment.planned[i].tool;
      const bool known = std::any_of(scene.tools.begin(), scene.tools.end(),
                                     [&](const ToolConfig& config) { return config.name == tool; });
      if (tool.empty() || known) continue;
      throw std::runtime_error(SceneMessage(scene, "assessment.planned[" + std::to_string(i) + "].tool", tool,
                                            "expected the name of a tool of this scene"));
    }
  }
  if (const auto solver = top.Find("solver")) scene.solver = ReadSolver(*solver);
  return scene;
}

Scene ReadScene(const fs::path& file) { return ReadScene(file, FindPackageAbove(file)); }

}  // namespace meshless_cutting
