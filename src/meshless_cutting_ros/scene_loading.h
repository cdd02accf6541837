// Scenes as ROS programs name them.
#pragma once

#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace meshless_cutting {

/// Folder of a package through ROS_PACKAGE_PATH; empty when it is not known.
std::filesystem::path RosPackageFolder(const std::string& package);

/// A path as it is, package://name/path resolved. Throws std::runtime_error when the package is not known.
std::filesystem::path ResourcePath(const std::string& resource);

/// `scene` is a path or package://name/path. Packages are those of ROS; the one that holds the scene is found without.
/// Cutting edges that the scene takes from a link are read from `robot_description` (the text of a URDF).
/// Throws std::runtime_error as ReadScene() does.
Scene LoadSceneFile(const std::string& scene, const std::string& robot_description);

}  // namespace meshless_cutting
