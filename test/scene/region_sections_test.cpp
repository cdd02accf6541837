// Primitives, held, moved, loaded and stiff regions, slits and probes of a scene file: what is read, what is refused.
#include <cmath>
#include <ostream>

#include "scene/scene_file.h"

namespace meshless_cutting {
namespace {

const char* const kRegions = R"(scene_version: 1
object:
  name: block
  primitive: {box_m: {min: [0, 0, 0], max: [0.1, 0.02, 0.03]}}
  cell_size_m: 0.005
  lattice_size_m: 0.005
  material: {model: neo_hookean, youngs_modulus_pa: 5000, poisson_ratio: 0.4999, density_kg_m3: 1000}
  fixed: [{name: root, box_m: {min: [-1, -1, -1], max: [0, 1, 1]}}]
  prescribed:
    - name: grip
      box_m: {min: [0.1, -1, -1], max: [1, 1, 1]}
      displacement_m: {time_s: [0, 1, 3], values: [[0, 0, 0], [0.1, 0, 0], [0.1, 0.2, 0]], interpolation: smooth}
      rotation: {axis_point_m: [0, 0.01, 0.01], axis: [2, 0, 0], angle_rad: {time_s: [1, 2], values: [0, 3]}}
  loads:
    - {name: pull, box_m: {min: [0, 0, 0.03], max: [0.1, 0.02, 0.03001]}, force_n: [0, 0, 1]}
    - {box_m: {min: [0, 0, -1], max: [0.1, 1, 0.001]}, traction_pa: {time_s: [0, 2], values: [[0, 0, 0], [5, 0, 0]]}}
  regions: [{box_m: {min: [0, 0, 0], max: [0.05, 1, 1]}, material: {youngs_modulus_pa: 50000, poisson_ratio: 0.3, density_kg_m3: 1200,
    prony: [{modulus_ratio: 0.5, relaxation_time_s: 0.1}, {modulus_ratio: 2, relaxation_time_s: 30}]}}]
  slits: [{corner_m: [0.05, -0.01, -0.01], edges_m: [[0, 0.04, 0], [0, 0, 0.02]]}]
  stabilisation: 2
probes: [{name: tip, position_m: [0.1, 0.01, 0.01]}, {name: lip, position_m: [0.05, 0.01, 0], side: [-2, 0, 0]}]
solver: {integrator: quasi_static}
)";

class RegionsTest : public SceneFileTest {};

TEST_F(RegionsTest, AreRead) {
  const Scene scene = Read(kRegions);
  const ObjectConfig& object = scene.object;
  ASSERT_TRUE(object.primitive);
  EXPECT_EQ(std::get<Box>(*object.primitive).max, Eigen::Vector3d(0.1, 0.02, 0.03));
  EXPECT_TRUE(object.mesh.empty());
  EXPECT_EQ(object.fixed[0].name, "root");
  ASSERT_EQ(object.prescribed.size(), 1u);
  EXPECT_EQ(object.prescribed[0].box.name, "grip");
  EXPECT_EQ(object.prescribed[0].axis, Eigen::Vector3d::UnitX());
  EXPECT_NEAR(object.prescribed[0].angle_rad.At(1.5), 1.5, 1e-15);
  ASSERT_EQ(object.loads.size(), 2u);
  EXPECT_FALSE(object.loads[0].is_traction);
  EXPECT_EQ(object.loads[0].load.At(7), Eigen::Vector3d(0, 0, 1));
  EXPECT_TRUE(object.loads[1].is_traction);
  EXPECT_EQ(object.loads[1].load.At(1), Eigen::Vector3d(2.5, 0, 0));
  ASSERT_EQ(object.regions.size(), 1u);
  EXPECT_EQ(object.regions[0].material.youngs_modulus_pa, 50000);
  EXPECT_EQ(object.slits[0].edges[1], Eigen::Vector3d(0, 0, 0.02));
  EXPECT_EQ(object.stabilisation, 2);
  EXPECT_TRUE(object.material.prony.empty());
  ASSERT_EQ(object.regions[0].material.prony.size(), 2u);
  EXPECT_EQ(object.regions[0].material.prony[1].modulus_ratio, 2);
  EXPECT_EQ(object.regions[0].material.prony[1].relaxation_time_s, 30);
  EXPECT_EQ(scene.probes[1].side, Eigen::Vector3d(-1, 0, 0));
  EXPECT_EQ(scene.solver.integrator, Integrator::kQuasiStatic);
}

TEST_F(RegionsTest, TablesAreHeldOutsideAndRestAtSmoothValues) {
  const auto table = Read(kRegions).object.prescribed[0].displacement_m;
  EXPECT_EQ(table.At(-1), Eigen::Vector3d::Zero());
  EXPECT_EQ(table.At(9), Eigen::Vector3d(0.1, 0.2, 0));
  EXPECT_NEAR(table.At(0.5).x(), 0.05, 1e-15);
  EXPECT_LT((table.At(1.001) - table.At(1)).norm(), 1e-6);
  EXPECT_NEAR(table.At(0.25).x(), 0.1 * (3 * 0.0625 - 2 * 0.015625), 1e-15);
}

struct BadRegion {
  std::string from, to, message;
};
void PrintTo(const BadRegion& bad, std::ostream* out) { *out << bad.to; }

class BadRegionTest : public SceneFileTest, public testing::WithParamInterface<BadRegion> {};

TEST_P(BadRegionTest, IsRefusedInOneLine) {
  const BadRegion& bad = GetParam();
  const std::string error = ErrorOf(Replaced(kRegions, bad.from, bad.to));
  EXPECT_NE(error.find(bad.message), std::string::npos) << "error: " << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, BadRegionTest,
    testing::Values(
        BadRegion{"primitive: {box_m", "mesh: box.obj\n  primitive: {box_m", "expected exactly one of `mesh`, `primitive`"},
        BadRegion{"primitive: {box_m: {min: [0, 0, 0], max: [0.1, 0.02, 0.03]}}", "primitive: {}",
                  "key `object.primitive`: a map of 0 keys: expected exactly one of `box_m`, `cylinder_m`, `prism_m`"},
        BadRegion{"  cell_size_m", "  scale: 2\n  cell_size_m", "key `object.scale`: 2: expected no scale beside a primitive"},
        BadRegion{"{box_m: {min: [0, 0, 0], max: [0.1, 0.02, 0.03]}}",
                  "{cylinder_m: {start: [0, 0, 0], end: [0, 0, 1], radius: 0}}",
                  "key `object.primitive.cylinder_m.radius`: 0: expected a number in"},
        BadRegion{"{box_m: {min: [0, 0, 0], max: [0.1, 0.02, 0.03]}}",
                  "{cylinder_m: {start: [0, 0, 1], end: [0, 0, 1], radius: 1}}", "expected a point that differs from `start`"},
        BadRegion{"{box_m: {min: [0, 0, 0], max: [0.1, 0.02, 0.03]}}",
                  "{prism_m: {axis: y, outline: [[0, 0], [1, 1], [1, 0], [0, 1]], from: 0, to: 1}}",
                  "expected a polygon that does not cross itself"},
        BadRegion{"{box_m: {min: [0, 0, 0], max: [0.1, 0.02, 0.03]}}",
                  "{prism_m: {axis: y, outline: [[0, 0], [1, 1], [1, 0]], from: 1, to: 1}}", "expected a number above `from`, 1"},
        BadRegion{"{box_m: {min: [0, 0, 0], max: [0.1, 0.02, 0.03]}}",
                  "{prism_m: {axis: w, outline: [[0, 0], [1, 1], [1, 0]], from: 0, to: 1}}", "expected x, y or z"},
        BadRegion{"name: root", "name: a b", "key `object.fixed[0].name`: a b: expected letters, digits and underscores"},
        BadRegion{"name: grip", "name: root", "key `object.prescribed[0].name`: root: expected a name that is not taken"},
        BadRegion{"name: lip", "name: tip", "key `probes[1].name`: tip: expected a name that is not taken"},
        BadRegion{"time_s: [0, 1, 3]", "time_s: [0, 1, 1]", "displacement_m.time_s[2]`: 1: expected a time after"},
        BadRegion{"time_s: [0, 1, 3]", "time_s: [0, 3]", "expected as many values as there are times, 2"},
        BadRegion{"interpolation: smooth", "interpolation: cubic", "interpolation`: cubic: expected linear or smooth"},
        BadRegion{"axis: [2, 0, 0]", "axis: [0, 0, 0]", "rotation.axis`: [0, 0, 0]: expected a direction that is not zero"},
        BadRegion{"force_n: [0, 0, 1]", "force_n: [0, 0, 1], traction_pa: [0, 0, 1]",
                  "expected exactly one of `force_n`, `traction_pa`"},
        BadRegion{"force_n: [0, 0, 1]", "force_n: 3", "force_n`: 3: expected a list of 3 finite numbers"},
        BadRegion{"regions: [{box_m: {min: [0, 0, 0], max: [0.05, 1, 1]}", "regions: [{mesh: none.obj",
                  "key `object.regions[0].mesh`: none.obj: expected a mesh file"},
        BadRegion{"[0, 0.04, 0], [0, 0, 0.02]", "[0, 0.04, 0], [0, 0.02, 0]", "expected two vectors that span an area"},
        BadRegion{"modulus_ratio: 2", "modulus_ratio: 0",
                  "key `object.regions[0].material.prony[1].modulus_ratio`: 0: expected a number in (0, 100]"},
        BadRegion{"relaxation_time_s: 30", "relaxation_time_s: -1", "relaxation_time_s`: -1: expected a number in [0.0001, 1000000]"},
        BadRegion{", relaxation_time_s: 30", "", "prony[1].relaxation_time_s`"},
        BadRegion{"relaxation_time_s: 30", "relaxation_time_s: 30, tau: 1", "tau"},
        BadRegion{"prony: [{modulus_ratio: 0.5, relaxation_time_s: 0.1}, {modulus_ratio: 2, relaxation_time_s: 30}]", "prony: 3",
                  "prony`: 3: expected a list"},
        BadRegion{"stabilisation: 2", "stabilisation: 0", "key `object.stabilisation`: 0: expected a number in [0.01, 10]"},
        BadRegion{"poisson_ratio: 0.4999", "poisson_ratio: 0.5", "0.5 would be incompressible"}));

}  // namespace
}  // namespace meshless_cutting
