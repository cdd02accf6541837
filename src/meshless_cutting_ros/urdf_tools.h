// Cutting edges from a robot description.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace meshless_cutting {

/// The cutting edge of a link, m, in the frame of the link: the origins of its fixed children named <link>_edge_0,
/// <link>_edge_1,
/// ... if there are at least two; else the longest centre line of the box or cylinder of its collision, or visual,
/// shape. Throws std::runtime_error "expected ...": no or bad URDF, no such link, no such shape.
std::vector<Eigen::Vector3d> EdgeOfLink(const std::string& urdf, const std::string& link);

}  // namespace meshless_cutting
