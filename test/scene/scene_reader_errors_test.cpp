// What a bad scene file is told: one line with file, line, key, value and what was expected.
#include <ostream>

#include "scene/scene_file.h"

namespace meshless_cutting {
namespace {

struct BadScene {
  std::string what;
  std::string from, to;  // the edit of the good scene
  std::string message;   // part of the error, behind the file's name
};

void PrintTo(const BadScene& bad, std::ostream* out) { *out << bad.what; }

class BadSceneTest : public SceneFileTest, public testing::WithParamInterface<BadScene> {};

TEST_P(BadSceneTest, IsRefusedInOneLine) {
  const BadScene& bad = GetParam();
  const std::string error = ErrorOf(Replaced(kGoodScene, bad.from, bad.to));
  EXPECT_NE(error.find((folder_ / "scene.yaml").string() + bad.message), std::string::npos)
      << "error: " << error << "\nexpected in it: " << bad.message;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  EXPECT_NE(error.find("expected"), std::string::npos) << error;
}

const BadScene kBadScenes[] = {
    {"unknown key", "frame: cell", "colour: red", ":2: key `colour`: red: unknown key"},
    {"misspelt section", "gravity_m_s2", "gravty_m_s2",
     ":14: key `gravty_m_s2`: [0, 0, -9.81]: unknown key; expected `gravity_m_s2`?"},
    {"misspelt key", "poisson_ratio", "poison_ratio",
     ":11: key `object.material.poison_ratio`: 0.45: unknown key; expected `poisson_ratio`?"},
    {"key without its unit", "cell_size_m", "cell_size",
     ":9: key `object.cell_size`: 0.008: unknown key; expected `cell_size_m`?"},
    {"misspelt key in a list", "timeout_s", "time_out_s",
     ":24: key `tools[0].time_out_s`: 0.2: unknown key; expected `timeout_s`?"},
    {"key in the wrong section", "  scale: 0.5", "  friction: 0.5", ":7: key `object.friction`: 0.5: unknown key"},
    {"doubled key", "  scale: 0.5", "  name: again",
     ":7: key `object.name`: again: key is there twice, first in line 5"},
    {"missing key", "  cell_size_m: 0.008\n", "",
     ":4: key `object.cell_size_m`: missing; expected this key in `object`"},
    {"missing section", "object:", "object_:", ":4: key `object_`: a map of 9 keys: unknown key; expected `object`?"},
    {"version from the future", "scene_version: 1", "scene_version: 2",
     ":1: key `scene_version`: 2: expected the whole number 1"},
    {"no version", "scene_version: 1\n", "", ":1: key `scene_version`: missing"},
    {"text for a number", "0.008", "big", ":9: key `object.cell_size_m`: big: expected a number in"},
    {"number in quotes", "0.008", "\"0.008\"", ":9: key `object.cell_size_m`: \"0.008\": expected a number in"},
    {"number with its unit", "0.008", "8 mm", ":9: key `object.cell_size_m`: 8 mm: expected a number in"},
    {"list for a number", "0.008", "[0.008]", ":9: key `object.cell_size_m`: [0.008]: expected a number in"},
    {"nothing for a number", "0.008", "", ":9: key `object.cell_size_m`: nothing: expected a number in"},
    {"number for a section", "damping: {mass_per_s: 0.5, stiffness_s: 0.002}", "damping: 3",
     ":18: key `damping`: 3: expected a section with keys of `mass_per_s`"},
    {"section for a list", "  fixed: [{box_m: {min: [-1, -1, -1], max: [1, 1, 0.01]}}]", "  fixed: {box_m: 1}",
     ":12: key `object.fixed`: a map of 1 keys: expected a list"},
    {"two numbers for three", "[0, 0, -9.81]", "[0, 0]",
     ":14: key `gravity_m_s2`: [0, 0]: expected a list of 3 finite numbers"},
    {"negative size", "cell_size_m: 0.008", "cell_size_m: -0.008",
     ":9: key `object.cell_size_m`: -0.008: expected a number in [1e-05, 10]"},
    {"size zero", "lattice_size_m: 0.004", "lattice_size_m: 0",
     ":10: key `object.lattice_size_m`: 0: expected a number in"},
    {"lattice coarser than the cells", "lattice_size_m: 0.004", "lattice_size_m: 0.01",
     ":10: key `object.lattice_size_m`: 0.01: expected at most cell_size_m, 0.008"},
    {"incompressible", "0.45", "0.5",
     ":11: key `object.material.poisson_ratio`: 0.5: expected a number in (-1, 0.5); 0.5 would be incompressible"},
    {"nearly no density", "1050", "0.001",
     ":11: key `object.material.density_kg_m3`: 0.001: expected a number in [1, 100000]"},
    {"negative modulus", "5000", "-5000", ":11: key `object.material.youngs_modulus_pa`: -5000: expected"},
    {"unknown material", "neo_hookean", "jelly",
     ":11: key `object.material.model`: jelly: expected stable_neo_hookean, "},
    {"not finite", "[0, 0, -9.81]", "[0, 0, .nan]",
     ":14: key `gravity_m_s2`: [0, 0, .nan]: expected a list of 3 finite"},
    {"infinite", "youngs_modulus_pa: 5000", "youngs_modulus_pa: .inf",
     ":11: key `object.material.youngs_modulus_pa`: .inf: expected"},
    {"time step too long", "time_step_s: 0.01", "time_step_s: 1",
     ":3: key `time_step_s`: 1: expected a number in [0.0005, 0.1]"},
    {"zero quaternion", "orientation_xyzw: [0, 0, 0.7071067811865476, 0.7071067811865476]",
     "orientation_xyzw: [0, 0, 0, 0]",
     ":8: key `object.pose.orientation_xyzw`: [0, 0, 0, 0]: expected a unit quaternion"},
    {"box inside out", "max: [1, 1, 0.01]", "max: [1, -2, 0.01]",
     ":12: key `object.fixed[0].box_m.max`: [1, -2, 0.01]: expected each coordinate above that of `min`, [-1, -1, -1]"},
    {"zero normal", "normal: [0, 0, 2]", "normal: [0, 0, 0]",
     ":16: key `obstacles[0].plane.normal`: [0, 0, 0]: expected a direction"},
    {"negative friction", "friction: 0.4", "friction: -0.4",
     ":16: key `obstacles[0].plane.friction`: -0.4: expected a number in [0, 10]"},
    {"obstacle of no kind", "  - plane: {point_m: [0, 0, -0.12], normal: [0, 0, 2], friction: 0.4}", "  - {}",
     ":16: key `obstacles[0]`: a map of 0 keys: expected exactly one of `plane`, `box_m`"},
    {"two pose sources", "pose_source: {tf: probe_tip}", "pose_source: {tf: a, topic: b}",
     ":25: key `tools[1].pose_source`: a map of 2 keys: expected exactly one of"},
    {"edge and link", "urdf_link: blade", "urdf_link: blade, cutting_edge_m: [[0, 0, 0], [0, 0, 1]]",
     ":25: key `tools[1]`: a map of 4 keys: expected exactly one of `cutting_edge_m`, `urdf_link`"},
    {"edge of one point", "[[0, 0, 0], [0, 0, 0.03]]", "[[0, 0, 0]]",
     ":21: key `tools[0].cutting_edge_m`: [[0, 0, 0]]: expected at least two points"},
    {"edge of no length", "[[0, 0, 0], [0, 0, 0.03]]", "[[0, 0, 1], [0, 0, 1]]",
     ":21: key `tools[0].cutting_edge_m[1]`: [0, 0, 1]: expected a point that differs"},
    {"tool's name not for topics", "name: scalpel", "name: my scalpel",
     ":20: key `tools[0].name`: my scalpel: expected letters"},
    {"two tools of one name", "name: probe", "name: scalpel",
     ":25: key `tools[1].name`: scalpel: expected a name that no other tool has"},
    {"topic with a space", "scalpel/measured_cp", "scalpel pose",
     ":22: key `tools[0].pose_source.topic`: scalpel pose: expected a topic name"},
    {"frame with slash", "frame: cell", "frame: /cell",
     ":2: key `frame`: /cell: expected a frame id without leading slash"},
    {"unknown integrator", "implicit_euler", "euler",
     ":27: key `solver.integrator`: euler: expected auto, generalized_alpha, implicit_euler, explicit or "
     "quasi_static"},
    {"no sub-steps", "newton_iterations: 7", "sub_steps: 0",
     ":27: key `solver.sub_steps`: 0: expected a whole number from 1 to 1000"},
    {"fraction of an iteration", "newton_iterations: 7", "newton_iterations: 7.5",
     ":27: key `solver.newton_iterations`: 7.5: expected a whole number from 1 to 100"},
    {"missing mesh", "mesh: box.obj", "mesh: ball.obj",
     ":6: key `object.mesh`: ball.obj: expected a mesh file; there is none at "},
    {"folder for a mesh", "mesh: box.obj", "mesh: .", ":6: key `object.mesh`: .: expected a mesh file"},
    {"unknown package", "mesh: box.obj", "mesh: package://nowhere/box.obj",
     ":6: key `object.mesh`: package://nowhere/box.obj: expected a package that can be found"},
    {"broken YAML", "[0, 0, -9.81]", "[0, 0, -9.81", ":15: not YAML ("},
    {"tab for indentation", "  scale: 0.5", "\tscale: 0.5", ":7: not YAML ("},
    {"list that contains itself", "[0, 0, -9.81]", "&a [*a]", ":14: "},
};

INSTANTIATE_TEST_SUITE_P(Scenes, BadSceneTest, testing::ValuesIn(kBadScenes), [](const auto& bad) {
  std::string name = bad.param.what;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
});

class BadFileTest : public SceneFileTest {};

TEST_F(BadFileTest, MissingScene) {
  try {
    ReadScene(folder_ / "nothing.yaml");
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), (folder_ / "nothing.yaml").string() +
                                ": no such file; expected a scene file (YAML) that starts with `scene_version: 1`, "
                                "e.g. launch/liver.yaml");
  }
}

TEST_F(BadFileTest, FolderForAScene) { EXPECT_THROW(ReadScene(folder_), std::runtime_error); }

TEST_F(BadFileTest, EmptyAndOtherFiles) {
  for (const std::string text : {"", "just words", "- a\n- b\n", "%PDF-1.4 \x01\x02", "{}", "~"}) {
    const std::string error = ErrorOf(text);
    EXPECT_NE(error.find("expected"), std::string::npos) << "scene: " << text << "\nerror: " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

TEST_F(BadFileTest, EveryTruncationEitherReadsOrIsRefusedInOneLine) {
  for (std::size_t length = 0; length < kGoodScene.size(); ++length) {
    const std::string error = ErrorOf(kGoodScene.substr(0, length));
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace meshless_cutting
