#include "lattice/triangle_mesh.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>

#include "lattice/weld.h"

namespace meshless_cutting {
namespace {

[[noreturn]] void Fail(const std::filesystem::path& file, std::string what) {
  std::replace(what.begin(), what.end(), '\n', ' ');
  throw std::runtime_error("mesh " + file.string() + ": " + what);
}

/// assimp keeps single precision. The shortest decimal that rounds to `value` is what the file said (up to 7 digits),
/// so that 0.1 in a file is 0.1 here and boxes keep their exact size.
double AsWritten(float value) {
  char text[32];
  for (int digits = 6; digits <= 9; ++digits) {
    std::snprintf(text, sizeof(text), "%.*g", digits, static_cast<double>(value));
    if (std::strtof(text, nullptr) == value) return std::strtod(text, nullptr);
  }
  return value;  // not finite
}

[[maybe_unused]] double AsWritten(double value) { return value; }

void Append(const aiMesh& part, const aiMatrix4x4& T_WN, double scale, TriangleMesh* mesh) {
  const int first = static_cast<int>(mesh->vertices.size());
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& source = part.mVertices[i];
    const Eigen::Vector3d p(AsWritten(source.x), AsWritten(source.y), AsWritten(source.z));
    Eigen::Vector3d p_W;
    for (int row = 0; row < 3; ++row) {
      const ai_real* m = T_WN[row];
      p_W[row] = m[0] * p.x() + m[1] * p.y() + m[2] * p.z() + m[3];
    }
    mesh->vertices.push_back(scale * p_W);
  }
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines have no area
    mesh->triangles.push_back({first + static_cast<int>(face.mIndices[0]), first + static_cast<int>(face.mIndices[1]),
                               first + static_cast<int>(face.mIndices[2])});
  }
}

void AppendNode(const aiScene& scene, const aiNode& node, const aiMatrix4x4& T_WP, double scale, TriangleMesh* mesh) {
  const aiMatrix4x4 T_WN = T_WP * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) Append(*scene.mMeshes[node.mMeshes[i]], T_WN, scale, mesh);
  for (unsigned i = 0; i < node.mNumChildren; ++i) AppendNode(scene, *node.mChildren[i], T_WN, scale, mesh);
}

double Area(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const Eigen::Vector3d& a = mesh.vertices[t[0]];
  return 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
}

std::string LowerExtension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// One mesh, one material, one node: the least that the exporters accept. With `flat` each triangle has its own three
/// vertices and its face normal, as STL wants; else vertices are shared and normals left out.
std::unique_ptr<aiScene> MakeScene(const TriangleMesh& mesh, bool flat) {
  auto scene = std::make_unique<aiScene>();
  scene->mMaterials = new aiMaterial* [1] { new aiMaterial };
  scene->mNumMaterials = 1;
  scene->mMeshes = new aiMesh* [1] { new aiMesh };
  scene->mNumMeshes = 1;
  scene->mRootNode = new aiNode;
  scene->mRootNode->mMeshes = new unsigned[1]{0};
  scene->mRootNode->mNumMeshes = 1;
  aiMesh& part = *scene->mMeshes[0];
  part.mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  const auto to_assimp = [](const Eigen::Vector3d& p) {
    return aiVector3D(static_cast<ai_real>(p.x()), static_cast<ai_real>(p.y()), static_cast<ai_real>(p.z()));
  };
  part.mNumFaces = static_cast<unsigned>(mesh.triangles.size());
  part.mFaces = new aiFace[part.mNumFaces];
  part.mNumVertices = static_cast<unsigned>(flat ? 3 * mesh.triangles.size() : mesh.vertices.size());
  part.mVertices = new aiVector3D[part.mNumVertices];
  if (flat) part.mNormals = new aiVector3D[part.mNumVertices];
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const auto& t = mesh.triangles[i];
    aiFace& face = part.mFaces[i];
    face.mNumIndices = 3;
    face.mIndices = new unsigned[3];
    const Eigen::Vector3d& a = mesh.vertices[t[0]];
    const Eigen::Vector3d normal = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).stableNormalized();
    for (unsigned k = 0; k < 3; ++k) {
      face.mIndices[k] = flat ? 3 * i + k : static_cast<unsigned>(t[k]);
      if (!flat) continue;
      part.mVertices[3 * i + k] = to_assimp(mesh.vertices[t[k]]);
      part.mNormals[3 * i + k] = to_assimp(normal);
    }
  }
  if (!flat) std::transform(mesh.vertices.begin(), mesh.vertices.end(), part.mVertices, to_assimp);
  return scene;
}

}  // namespace

TriangleMesh ReadTriangleMesh(const std::filesystem::path& file, double scale) {
  if (!(scale > 0) || !std::isfinite(scale)) {
    Fail(file, "scale is " + std::to_string(scale) + "; expected a finite number > 0 (mesh units to metres)");
  }
  std::error_code error;
  if (!std::filesystem::exists(file, error)) Fail(file, "no such file; check the path and the package name");
  if (!std::filesystem::is_regular_file(file, error)) Fail(file, "not a regular file; expected a mesh file");
  if (std::filesystem::file_size(file, error) == 0) Fail(file, "the file is empty; export the mesh again");

  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate);
  if (scene == nullptr) {
    Fail(file, std::string("cannot be read: ") + importer.GetErrorString() +
                   "; expected a mesh in a format that assimp reads (.obj .stl .ply .dae ...)");
  }
  TriangleMesh mesh;
  if (scene->mRootNode != nullptr) AppendNode(*scene, *scene->mRootNode, aiMatrix4x4(), scale, &mesh);
  if (mesh.triangles.empty()) Fail(file, "contains no triangle; expected a surface of triangles or polygons");
  for (const auto& t : mesh.triangles) {
    for (const int v : t) {
      if (v < 0 || v >= static_cast<int>(mesh.vertices.size()))
        Fail(file, "a face refers to a vertex that is not there");
      if (!mesh.vertices[v].allFinite()) {
        Fail(file,
             "vertex " + std::to_string(v) + " is not finite; expected finite coordinates, export the mesh again");
      }
    }
  }
  mesh = WeldEqualVertices(mesh);
  if (std::none_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) { return Area(mesh, t) > 0; })) {
    Fail(file, "every triangle has zero area; expected a surface that encloses a volume");
  }
  return mesh;
}

void WriteTriangleMesh(const TriangleMesh& mesh, const std::filesystem::path& file) {
  const std::string extension = LowerExtension(file);
  const char* format = extension == ".obj"   ? "objnomtl"
                       : extension == ".ply" ? "plyb"
                       : extension == ".stl" ? "stlb"
                                             : "";
  if (*format == '\0')
    Fail(file, "cannot be written: unknown extension '" + extension + "'; expected .obj, .ply or .stl");
  if (mesh.triangles.empty()) Fail(file, "cannot be written: the surface has no triangle");

  const std::unique_ptr<aiScene> scene = MakeScene(mesh, extension == ".stl");
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(scene.get(), format, 0);
  if (blob == nullptr) Fail(file, std::string("cannot be written: ") + exporter.GetErrorString());

  // A reader never sees half a file: written beside it, then renamed.
  const std::filesystem::path part = file.string() + ".part";
  std::ofstream stream(part, std::ios::binary | std::ios::trunc);
  stream.write(static_cast<const char*>(blob->data), static_cast<std::streamsize>(blob->size));
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(part, file, error);
  if (!stream || error) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    Fail(file, "cannot be written; check that the folder exists, is writable and has space left");
  }
}

}  // namespace meshless_cutting
