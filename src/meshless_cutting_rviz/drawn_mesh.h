// The surface as a graphics card wants it: one vertex per normal.
#pragma once

#include <meshless_cutting/SurfaceTopology.h>

#include <array>
#include <cstdint>
#include <vector>

namespace meshless_cutting {

/// A surface whose vertices are split where it has a crease: between skin and cut face, and along edges of the skin
/// that are sharp at rest. Around each drawn vertex the surface is smooth.
class DrawnMesh {
 public:
  DrawnMesh() = default;
  /// `topology` must have passed CheckTopology(). Skin is creased where its normals differ by more than
  /// `crease_angle` (rad) at rest.
  DrawnMesh(const SurfaceTopology& topology, float crease_angle);

  const std::vector<std::uint32_t>& triangles() const { return triangles_; }  // drawn vertices
  const std::vector<std::uint32_t>& vertex() const { return vertex_; }        // per drawn vertex: that of the message
  const std::vector<std::uint8_t>& region() const { return region_; }         // per drawn vertex
  const std::vector<std::uint32_t>& fragment() const { return fragment_; }    // per drawn vertex

  /// Unit normals per drawn vertex, weighted by area; positions x y z per vertex of the message, m. A vertex whose
  /// triangles have no area gets z.
  void Normals(const std::vector<float>& positions, std::vector<std::array<float, 3>>* normals) const;

 private:
  std::vector<std::uint32_t> triangles_, vertex_, fragment_;
  std::vector<std::uint8_t> region_;
};

}  // namespace meshless_cutting
