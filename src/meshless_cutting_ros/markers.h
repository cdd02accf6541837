// Pictures for a stock rviz: the object, its blades, what holds and what carries it.
#pragma once

#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <vector>

#include "scene_view.h"

namespace meshless_cutting {

/// The surface as a TRIANGLE_LIST. rviz lights triangle lists without normals or, with colours, not at all: the light
/// is in the colours, smooth within skin and cut face, with a crease between them. Needs the topology of these
/// positions.
visualization_msgs::Marker SurfaceMarker(const SurfaceTopology& topology, const SurfacePositions& positions);

/// Dots on the vertices of the skin that lie in one of the scene's fixed boxes. Empty `points` when there are none.
visualization_msgs::Marker FixedMarker(const Scene& scene, const SurfaceTopology& topology,
                                       const SurfacePositions& positions);

/// Per tool its body, where the edge is that of the scalpel mesh, and its blade; grey while inactive.
std::vector<visualization_msgs::Marker> ToolMarkers(const Scene& scene, const std::vector<ToolView>& tools,
                                                    ros::Time stamp);

/// Planes as thin plates, boxes as they are.
std::vector<visualization_msgs::Marker> ObstacleMarkers(const Scene& scene, ros::Time stamp);

/// Removes all markers of the topic: the start of a session.
visualization_msgs::Marker ClearMarker(const Scene& scene, ros::Time stamp);

/// Integration points, and a line from each surface vertex to the one that it follows.
visualization_msgs::MarkerArray MappingMarkers(const MappingView& mapping, const SurfacePositions& positions);

}  // namespace meshless_cutting
