// The surface as the outside sees it: triangles with their region and fragment, positions at rest and now.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace meshless_cutting {

enum class SurfaceRegion : std::uint8_t { kSkin = 0, kCutFace = 1 };

/// Closed and oriented at every version. A vertex keeps its index for the whole session; new ones are appended.
struct Surface {
  std::uint32_t version = 0;  // +1 whenever triangles, regions, fragments or rest positions change
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise from outside
  std::vector<SurfaceRegion> region;                    // per triangle
  std::vector<std::uint32_t> fragment;  // per triangle: connected piece of material, 0 = largest by volume at rest
  std::vector<Eigen::Vector3d> rest_positions;  // per vertex, m, object frame
  std::vector<Eigen::Vector3d> positions;       // per vertex, m, scene frame
  std::vector<double> fragment_volume_m3;       // per fragment, at rest, largest first
};

}  // namespace meshless_cutting
