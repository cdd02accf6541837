// Cutting edges from a robot description.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace meshless_cutting {

/// The cutting edge of a link, m, in the frame of the link: the origins of its fixed children named <link>_edge_0,
/// <link>_edge_1,
/// ... if there are at least two; else the longest centre line of the box or cylinder of its collision, or visual,
/// shape. Throws std::runtime_error "expected ...": no or bad URDF, no such link, no such shape.
std::vector<Eigen::Vector3d> EdgeOfLink(const std::string& urdf, const std::string& link);

/// The collision boxes of a link in the frame `frame`, itself a link, where the joints between them are fixed.
/// Throws std::runtime_error "expected ...": no or bad URDF, no such link, a joint that moves, a shape that is no box.
std::vector<BoxObstacle> CollisionBoxes(const std::string& urdf, const std::string& link, const std::string& frame);

}  // namespace meshless_cutting
