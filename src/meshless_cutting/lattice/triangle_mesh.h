// A triangle soup as it comes from a file, and back into one (assimp).
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <vector>

namespace meshless_cutting {

/// Triangles that need not be closed, oriented or free of intersections.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;      // m
  std::vector<std::array<int, 3>> triangles;  // indices into vertices
};

/// Reads any format that assimp knows, all its meshes under their node transforms, vertices multiplied by `scale`.
/// Throws std::runtime_error, one line with file, what is wrong, what was expected and a remedy: missing, unreadable or
/// empty file, no triangle of non-zero area, non-finite vertex.
TriangleMesh ReadTriangleMesh(const std::filesystem::path& file, double scale);

/// Writes .obj, .ply or .stl by the extension of `file`. Throws std::runtime_error (unknown extension, path not
/// writable).
void WriteTriangleMesh(const TriangleMesh& mesh, const std::filesystem::path& file);

}  // namespace meshless_cutting
