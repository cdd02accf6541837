// What a good scene file becomes.
#include "scene/scene_reader.h"

#include "scene/scene_file.h"

namespace meshless_cutting {
namespace {

class SceneReaderTest : public SceneFileTest {};

TEST_F(SceneReaderTest, ReadsEveryKey) {
  const Scene scene = Read(kGoodScene);
  EXPECT_EQ(scene.text, kGoodScene);
  EXPECT_EQ(scene.frame, "cell");
  EXPECT_EQ(scene.time_step_s, 0.01);

  const ObjectConfig& object = scene.object;
  EXPECT_EQ(object.name, "block");
  EXPECT_EQ(object.mesh, folder_ / "box.obj");
  EXPECT_EQ(object.scale, 0.5);
  EXPECT_TRUE((object.T_WO * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3)));
  EXPECT_EQ(object.cell_size_m, 0.008);
  EXPECT_EQ(object.lattice_size_m, 0.004);
  EXPECT_EQ(object.material.model, MaterialModel::kNeoHookean);
  EXPECT_EQ(object.material.youngs_modulus_pa, 5000);
  EXPECT_EQ(object.material.poisson_ratio, 0.45);
  EXPECT_EQ(object.material.density_kg_m3, 1050);
  ASSERT_EQ(object.fixed.size(), 1u);
  EXPECT_EQ(object.fixed[0].max, Eigen::Vector3d(1, 1, 0.01));
  EXPECT_EQ(object.support_radius_cells, 0.95);

  EXPECT_EQ(scene.gravity_m_s2.value(), Eigen::Vector3d(0, 0, -9.81));
  EXPECT_EQ(scene.damping.value().mass_per_s, 0.5);
  EXPECT_EQ(scene.damping.value().stiffness_s, 0.002);
  EXPECT_EQ(scene.solver.integrator, Integrator::kImplicitEuler);
  EXPECT_EQ(scene.solver.relative_tolerance, 1e-4);
  EXPECT_EQ(scene.solver.newton_iterations, 7);
  EXPECT_EQ(scene.solver.threads, 3);
}

TEST_F(SceneReaderTest, PlacesObstacles) {
  const Scene scene = Read(kGoodScene);
  ASSERT_EQ(scene.obstacles.size(), 2u);
  const auto& plane = std::get<PlaneObstacle>(scene.obstacles[0].shape);
  EXPECT_EQ(plane.point, Eigen::Vector3d(0, 0, -0.12));
  EXPECT_EQ(plane.normal, Eigen::Vector3d(0, 0, 1)) << "normalised";
  EXPECT_EQ(scene.obstacles[0].friction, 0.4);
  const auto& box = std::get<BoxObstacle>(scene.obstacles[1].shape);
  EXPECT_EQ(box.half_extents, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(box.T_WB.translation(), Eigen::Vector3d(11, 2, 3)) << "centre of the box, after its pose";
  EXPECT_EQ(scene.obstacles[1].friction, 0.1);
}

TEST_F(SceneReaderTest, ReadsEachPoseSource) {
  const Scene scene = Read(kGoodScene);
  ASSERT_EQ(scene.tools.size(), 3u);
  EXPECT_EQ(scene.tools[0].name, "scalpel");
  EXPECT_EQ(scene.tools[0].cutting_edge[1], Eigen::Vector3d(0, 0, 0.03));
  EXPECT_EQ(std::get<TopicPoseSource>(scene.tools[0].pose_source).topic, "scalpel/measured_cp");
  EXPECT_EQ(scene.tools[0].max_speed_m_s, 3);
  EXPECT_EQ(scene.tools[0].timeout_s, 0.2);
  EXPECT_EQ(scene.tools[1].urdf_link, "blade");
  EXPECT_TRUE(scene.tools[1].cutting_edge.empty());
  EXPECT_EQ(std::get<TfPoseSource>(scene.tools[1].pose_source).frame, "probe_tip");
  EXPECT_EQ(std::get<FixedPoseSource>(scene.tools[2].pose_source).T_WT.translation(), Eigen::Vector3d(0, 1, 0));
}

TEST_F(SceneReaderTest, AbsentSectionsStayAbsent) {
  const Scene scene = Read(
      "scene_version: 1\n"
      "object:\n"
      "  {name: a, mesh: box.obj, cell_size_m: 0.1, lattice_size_m: 0.1,\n"
      "   material: {youngs_modulus_pa: 1000, poisson_ratio: 0, density_kg_m3: 1000}}\n");
  EXPECT_FALSE(scene.gravity_m_s2);
  EXPECT_FALSE(scene.damping);
  EXPECT_TRUE(scene.obstacles.empty());
  EXPECT_TRUE(scene.tools.empty());
  EXPECT_TRUE(scene.object.fixed.empty());
  EXPECT_EQ(scene.frame, "world");
  EXPECT_EQ(scene.object.material.model, MaterialModel::kStableNeoHookean);
  EXPECT_EQ(scene.object.T_WO.matrix(), Eigen::Matrix4d::Identity());
}

TEST_F(SceneReaderTest, ReadsHowToStep) {
  const auto solver = [&](const std::string& text) {
    return Read(
               "scene_version: 1\n"
               "object:\n"
               "  {name: a, mesh: box.obj, cell_size_m: 0.1, lattice_size_m: 0.1,\n"
               "   material: {youngs_modulus_pa: 1000, poisson_ratio: 0, density_kg_m3: 1000}}\n"
               "solver: {" +
               text + "}\n")
        .solver;
  };
  EXPECT_EQ(solver("integrator: auto, sub_steps: 3").integrator, Integrator::kAuto);
  EXPECT_EQ(solver("integrator: auto, sub_steps: 3").sub_steps, 3);
  EXPECT_EQ(solver("integrator: explicit").integrator, Integrator::kExplicit);
  EXPECT_EQ(solver("threads: 1").sub_steps, 1);
}

TEST_F(SceneReaderTest, FindsAPackageAboveTheScene) {
  std::ofstream(folder_ / "package.xml") << "<package>\n  <name> soft_parts </name>\n</package>\n";
  const Scene scene = Read(Replaced(kGoodScene, "box.obj", "package://soft_parts/box.obj"));
  EXPECT_EQ(scene.object.mesh, folder_ / "box.obj");
}

TEST_F(SceneReaderTest, AsksTheResolverForPackages) {
  std::ofstream(folder_ / "scene.yaml") << Replaced(kGoodScene, "box.obj", "package://elsewhere/box.obj");
  const Scene scene = ReadScene(folder_ / "scene.yaml", [this](const std::string& package) {
    return package == "elsewhere" ? folder_ : std::filesystem::path();
  });
  EXPECT_EQ(scene.object.mesh, folder_ / "box.obj");
}

TEST_F(SceneReaderTest, KnowsTheLineOfEachKey) {
  const Scene scene = Read(kGoodScene);
  EXPECT_EQ(scene.lines.at("scene_version"), 1);
  EXPECT_EQ(scene.lines.at("object.cell_size_m"), 9);
  EXPECT_EQ(scene.lines.at("object.material.poisson_ratio"), 11);
  EXPECT_EQ(scene.lines.at("tools[0].timeout_s"), 24);
  EXPECT_EQ(SceneMessage(scene, "object.cell_size_m", "0.008", "expected less"),
            (folder_ / "scene.yaml").string() + ":9: key `object.cell_size_m`: 0.008: expected less");
  EXPECT_NE(SceneMessage(scene, "tools[0].nothing", "", "expected more").find("scene.yaml:20: "), std::string::npos)
      << "a key that is not there is reported where its section begins";
}

}  // namespace
}  // namespace meshless_cutting
