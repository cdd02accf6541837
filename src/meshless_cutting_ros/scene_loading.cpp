#include "scene_loading.h"

#include <ros/package.h>

#include <algorithm>
#include <stdexcept>

#include "scene/scene_reader.h"
#include "urdf_tools.h"

namespace meshless_cutting {
std::filesystem::path RosPackageFolder(const std::string& package) { return ros::package::getPath(package); }

std::filesystem::path ResourcePath(const std::string& resource) {
  const std::string scheme = "package://";
  if (resource.compare(0, scheme.size(), scheme) != 0) return resource;
  const std::string rest = resource.substr(scheme.size());
  const std::string package = rest.substr(0, rest.find('/'));
  const std::filesystem::path folder = RosPackageFolder(package);
  if (folder.empty()) {
    throw std::runtime_error(resource + ": no package `" + package +
                             "`; expected one in ROS_PACKAGE_PATH: source its setup file");
  }
  return folder / rest.substr(std::min(rest.size(), package.size() + 1));
}

Scene LoadSceneFile(const std::string& scene_name, const std::string& robot_description) {
  const std::filesystem::path file = ResourcePath(scene_name);
  const PackageResolver above = FindPackageAbove(file);
  Scene scene = ReadScene(file, [&above](const std::string& package) {
    const std::filesystem::path folder = above(package);
    return folder.empty() ? RosPackageFolder(package) : folder;
  });
  for (std::size_t i = 0; i < scene.tools.size(); ++i) {
    ToolConfig& tool = scene.tools[i];
    if (tool.urdf_link.empty()) continue;
    try {
      tool.cutting_edge = EdgeOfLink(robot_description, tool.urdf_link);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(
          SceneMessage(scene, "tools[" + std::to_string(i) + "].urdf_link", tool.urdf_link, error.what()));
    }
  }
  for (const LinkObstacle& obstacle : scene.link_obstacles) {
    try {
      for (const BoxObstacle& box : CollisionBoxes(robot_description, obstacle.link, scene.frame)) {
        scene.obstacles.push_back({box, obstacle.friction});
      }
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(SceneMessage(scene, obstacle.key, obstacle.link, error.what()));
    }
  }
  scene.link_obstacles.clear();
  return scene;
}

}  // namespace meshless_cutting
