// The sections of a scene file, one function each. Errors as in yaml_section.h.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "scene/yaml_section.h"

namespace meshless_cutting {

/// Keys of `object`.
std::vector<std::string> ObjectKeys();

/// `object` but for its mesh, which needs the place of the scene file.
ObjectConfig ReadObject(const YamlValue& value);
ObstacleConfig ReadObstacle(const YamlValue& value);
/// An item of `obstacles` that is {urdf_link: {link: NAME, friction: F}}.
LinkObstacle ReadLinkObstacle(const YamlValue& value);
DampingConfig ReadDamping(const YamlValue& value);
MaterialConfig ReadMaterial(const YamlValue& value);
ProbeConfig ReadProbe(const YamlValue& value);
// Entries of `object`, see region_sections.cpp.
Primitive ReadPrimitive(const YamlValue& value);
Box ReadFixed(const YamlValue& value);
PrescribedRegion ReadPrescribed(const YamlValue& value);
LoadRegion ReadLoad(const YamlValue& value);
/// But for its mesh, as with ReadObject.
MaterialRegion ReadMaterialRegion(const YamlValue& value);
std::vector<std::string> MaterialRegionKeys();
Slit ReadSlit(const YamlValue& value);
ToolConfig ReadTool(const YamlValue& value);
AssessmentConfig ReadAssessment(const YamlValue& value);
SolverConfig ReadSolver(const YamlValue& value);

/// A tf frame id: no leading slash, no space.
std::string ReadFrameId(const YamlValue& value);
/// [x, y, z, w], normalised.
Eigen::Quaterniond ReadOrientation(const YamlValue& value);
/// {position_m: [x, y, z], orientation_xyzw: [x, y, z, w]}, each optional.
Eigen::Isometry3d ReadPose(const YamlValue& value);
/// {min: [x, y, z], max: [x, y, z]}, max above min on each axis. `more_keys` may stand beside them.
Box ReadBox(const YamlValue& value, const std::vector<std::string>& more_keys = {});

}  // namespace meshless_cutting
