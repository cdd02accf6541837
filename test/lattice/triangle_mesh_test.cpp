// Files in and out through assimp, and one clear line for each kind of bad file.
#include "lattice/triangle_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>

#include "lattice/lattice_quality.h"
#include "lattice/meshes.h"

namespace meshless_cutting {
namespace {

class TriangleMeshTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / ("meshless_cutting_" + std::string(info->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  /// The message must be one line that names the file and contains `part`.
  void ExpectRefused(const std::filesystem::path& file, const std::string& part, double scale = 1) const {
    try {
      ReadTriangleMesh(file, scale);
      ADD_FAILURE() << file << " was read";
    } catch (const std::runtime_error& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(file.string()), std::string::npos) << message;
      EXPECT_NE(message.find(part), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }

  std::filesystem::path folder_;
};

constexpr char kTriangle[] = "v 0.1 0.04 0\nv 1 0 0\nv 0 1 0\n";

TEST_F(TriangleMeshTest, MissingFile) { ExpectRefused(folder_ / "nothing.obj", "no such file"); }
TEST_F(TriangleMeshTest, Folder) { ExpectRefused(folder_, "not a regular file"); }
TEST_F(TriangleMeshTest, EmptyFile) { ExpectRefused(Write("empty.obj", ""), "empty"); }
TEST_F(TriangleMeshTest, UnknownFormat) { ExpectRefused(Write("mesh.xyzzy", "hello"), "cannot be read"); }
TEST_F(TriangleMeshTest, BrokenFile) { ExpectRefused(Write("broken.stl", std::string(200, 'x')), ""); }
TEST_F(TriangleMeshTest, NoFaces) { ExpectRefused(Write("points.obj", kTriangle), ""); }
TEST_F(TriangleMeshTest, LinesOnly) {
  ExpectRefused(Write("lines.obj", std::string(kTriangle) + "l 1 2\n"), "no triangle");
}
TEST_F(TriangleMeshTest, ZeroArea) {
  ExpectRefused(Write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 2\n"), "zero area");
}
TEST_F(TriangleMeshTest, NotFinite) {
  TriangleMesh mesh = meshes::Box({0, 0, 0}, {1, 1, 1});
  mesh.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  WriteTriangleMesh(mesh, folder_ / "nan.stl");
  ExpectRefused(folder_ / "nan.stl", "not finite");
}
TEST_F(TriangleMeshTest, BadScale) {
  const auto file = Write("good.obj", std::string(kTriangle) + "f 1 2 3\n");
  ExpectRefused(file, "scale", 0);
  ExpectRefused(file, "scale", -1);
  ExpectRefused(file, "scale", std::numeric_limits<double>::infinity());
}

TEST_F(TriangleMeshTest, DecimalsAreWhatTheFileSays) {
  const TriangleMesh mesh = ReadTriangleMesh(Write("good.obj", std::string(kTriangle) + "f 1 2 3\n"), 1);
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[0], Eigen::Vector3d(0.1, 0.04, 0)) << "not 0.100000001490116 of single precision";
}

TEST_F(TriangleMeshTest, PolygonsScaleAndSeveralObjects) {
  const auto file = Write("two.obj",
                          "o a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"
                          "o b\nv 0 0 1\nv 1 0 1\nv 1 1 1\nf 5 6 7\n");
  const TriangleMesh mesh = ReadTriangleMesh(file, 0.001);
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(mesh.vertices.size(), 7u);
  double highest = 0;
  for (const Eigen::Vector3d& p : mesh.vertices) highest = std::max(highest, p.cwiseAbs().maxCoeff());
  EXPECT_EQ(highest, 0.001);
}

TEST_F(TriangleMeshTest, NodeTransformsApply) {
  // A COLLADA file whose node moves a triangle by 10 along x and doubles it.
  const auto file = Write("moved.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <asset><unit name="meter" meter="1"/><up_axis>Y_UP</up_axis></asset>
 <library_geometries><geometry id="g"><mesh>
  <source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array>
   <technique_common><accessor source="#pa" count="3" stride="3">
    <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
 </mesh></geometry></library_geometries>
 <library_visual_scenes><visual_scene id="s"><node>
  <matrix>2 0 0 10 0 2 0 0 0 0 2 0 0 0 0 1</matrix><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
 <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>)");
  const TriangleMesh mesh = ReadTriangleMesh(file, 1);
  ASSERT_EQ(mesh.vertices.size(), 3u);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : mesh.vertices) box.extend(p);
  EXPECT_TRUE(box.min().isApprox(Eigen::Vector3d(10, 0, 0))) << box.min().transpose();
  EXPECT_TRUE(box.max().isApprox(Eigen::Vector3d(12, 2, 0))) << box.max().transpose();
}

TEST_F(TriangleMeshTest, WrittenFilesReadBack) {
  const TriangleMesh torus = meshes::Torus(0.1, 0.03, 24, 12);
  for (const std::string extension : {".obj", ".ply", ".stl", ".STL"}) {
    const auto file = folder_ / ("torus" + extension);
    WriteTriangleMesh(torus, file);
    const TriangleMesh read = ReadTriangleMesh(file, 1);
    EXPECT_EQ(read.vertices.size(), torus.vertices.size()) << extension;
    EXPECT_EQ(read.triangles.size(), torus.triangles.size()) << extension;
    EXPECT_NEAR(EnclosedVolume(read) / EnclosedVolume(torus), 1, 1e-6) << extension;
    EXPECT_FALSE(std::filesystem::exists(file.string() + ".part"));
  }
}

TEST_F(TriangleMeshTest, TextFilesShareVertices) {
  WriteTriangleMesh(meshes::Box({0, 0, 0}, {1, 1, 1}), folder_ / "box.obj");
  std::ifstream stream(folder_ / "box.obj");
  const std::string text((std::istreambuf_iterator<char>(stream)), {});
  EXPECT_EQ(text.find("nan"), std::string::npos);
  int vertices = 0;
  for (size_t at = text.find("\nv "); at != std::string::npos; at = text.find("\nv ", at + 1)) ++vertices;
  EXPECT_EQ(vertices, 8);
}

TEST_F(TriangleMeshTest, ZeroAreaTrianglesWriteFiniteNormals) {
  TriangleMesh mesh = meshes::Box({0, 0, 0}, {1, 1, 1});
  mesh.vertices.emplace_back(0.5, 0, 0);
  mesh.triangles.push_back({0, 8, 1});
  WriteTriangleMesh(mesh, folder_ / "flat.stl");
  EXPECT_EQ(ReadTriangleMesh(folder_ / "flat.stl", 1).triangles.size(), 13u);
}

TEST_F(TriangleMeshTest, RefusesToWrite) {
  const TriangleMesh box = meshes::Box({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(WriteTriangleMesh(box, folder_ / "box.xyz"), std::runtime_error);
  EXPECT_THROW(WriteTriangleMesh(box, folder_ / "no_such_folder" / "box.obj"), std::runtime_error);
  EXPECT_THROW(WriteTriangleMesh({}, folder_ / "box.obj"), std::runtime_error);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace meshless_cutting
