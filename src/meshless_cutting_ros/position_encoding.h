// How the coordinates of a surface lie in a message, for who writes and for who reads it.
#pragma once

#include <meshless_cutting/SurfacePositions.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace meshless_cutting {

enum class PositionEncoding { kFloat32, kUint16 };

/// "float32" or "uint16". Throws std::runtime_error that says what was expected; `key` names the value there.
PositionEncoding ParseEncoding(const std::string& key, const std::string& text);

/// Fills the coordinates of `message` from `positions` (m, scene frame). With kUint16 a coordinate is rounded to the
/// nearest of 65536 steps of the bounding box: wrong by box_size / 131070 per axis at most, 1.5 um in 0.2 m. When a
/// position is not finite there is no box: then float32 is sent whatever was asked for.
void Encode(const std::vector<Eigen::Vector3d>& positions, PositionEncoding encoding, SurfacePositions* message);

/// Number of coordinates in the message, 3 per vertex.
std::size_t CoordinateCount(const SurfacePositions& message);

/// The coordinates, x y z per vertex, m. Empty when the encoding is not known.
std::vector<float> Decode(const SurfacePositions& message);

/// The same message as FLOAT32; itself when it is.
SurfacePositionsConstPtr AsFloat32(const SurfacePositionsConstPtr& message);

}  // namespace meshless_cutting
