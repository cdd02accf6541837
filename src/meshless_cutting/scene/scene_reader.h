// Reads a scene file. Strict: what is not understood to the last key is an error.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "scene/scene.h"

namespace meshless_cutting {

/// Folder of the package of that name, or empty when it is not known.
using PackageResolver = std::function<std::filesystem::path(const std::string& package)>;

/// Finds a package without ROS: the nearest folder at or above `start` whose package.xml carries that name.
PackageResolver FindPackageAbove(const std::filesystem::path& start);

/// Reads `file` (YAML, the format of README.md, "Scene file"). Angles do not occur; lengths in m; quaternions are
/// normalised. Paths of meshes become absolute: `package://name/...` through `resolver`, others relative to the scene
/// file. Throws std::runtime_error with one line "file:line: key `a.b`: value: expected ...; remedy": file missing or
/// not YAML; a key that is unknown, unused, misspelt, missing or there twice; a wrong type; a value out of range; a
/// mesh that is not there. What only the loaded mesh can tell (a cell larger than the object) is left to the build.
Scene ReadScene(const std::filesystem::path& file, const PackageResolver& resolver);

/// The same with FindPackageAbove(file).
Scene ReadScene(const std::filesystem::path& file);

}  // namespace meshless_cutting
