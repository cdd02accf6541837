// How the messages of a driver are read, as a scene says it.
#include "scene/scene_file.h"

namespace meshless_cutting {
namespace {

class ToolKeysTest : public SceneFileTest {
 protected:
  std::string With(const std::string& keys) { return Replaced(kGoodScene, "    timeout_s: 0.2\n", keys); }
};

TEST_F(ToolKeysTest, AreReadAndHaveDefaults) {
  const Scene plain = Read(kGoodScene);
  EXPECT_EQ(plain.tools[0].stamp_policy, StampPolicy::kHeader);
  EXPECT_EQ(plain.tools[0].position_scale, 1);
  EXPECT_FALSE(plain.tools[0].position_only);
  EXPECT_FALSE(plain.tools[0].blade_button);
  const Scene scene = Read(
      With("    stamp_policy: receipt\n    frame_id: omni_base\n    position_scale: 0.001\n    position_only: true\n"
           "    orientation_xyzw: [0, 0, 1, 0]\n    blade_button: {topic: /pedals/joy, index: 3}\n"));
  const ToolConfig& tool = scene.tools[0];
  EXPECT_EQ(tool.stamp_policy, StampPolicy::kReceipt);
  EXPECT_EQ(tool.frame_id, "omni_base");
  EXPECT_EQ(tool.position_scale, 0.001);
  EXPECT_TRUE(tool.position_only);
  EXPECT_EQ(tool.orientation.z(), 1);
  ASSERT_TRUE(tool.blade_button);
  EXPECT_EQ(tool.blade_button->topic, "/pedals/joy");
  EXPECT_EQ(tool.blade_button->index, 3);
}

TEST_F(ToolKeysTest, ErrorsNameFileLineKeyAndRemedy) {
  const std::pair<std::string, std::string> bad[] = {
      {"    stamp_policy: now\n", ":24: key `tools[0].stamp_policy`: now: expected header, or receipt for drivers"},
      {"    frame_id: /omni\n", ":24: key `tools[0].frame_id`: /omni: expected a frame id without leading slash"},
      {"    position_scale: 0\n", ":24: key `tools[0].position_scale`: 0: expected a number in [1e-09, 1000000000]; "},
      {"    position_only: 1\n", ":24: key `tools[0].position_only`: 1: expected true or false"},
      {"    position_only: \"true\"\n", ":24: key `tools[0].position_only`: \"true\": expected true or false"},
      {"    orientation_xyzw: [0, 0, 0, 1]\n",
       ":24: key `tools[0].orientation_xyzw`: [0, 0, 0, 1]: expected this key only with position_only: true"},
      {"    position_only: true\n    orientation_xyzw: [0, 0, 0, 0]\n",
       ":25: key `tools[0].orientation_xyzw`: [0, 0, 0, 0]: expected a unit quaternion"},
      {"    blade_button: {topic: joy}\n", ":24: key `tools[0].blade_button.index`: missing"},
      {"    blade_button: {topic: joy, index: -1}\n", ":24: key `tools[0].blade_button.index`: -1: expected"},
      {"    blade_button: {topic: a b, index: 1}\n", ":24: key `tools[0].blade_button.topic`: a b: expected a topic"},
  };
  for (const auto& [keys, message] : bad) {
    const std::string error = ErrorOf(With(keys));
    EXPECT_NE(error.find(message), std::string::npos) << error << "\nexpected in it: " << message;
  }
  const std::string error =
      ErrorOf(Replaced(kGoodScene, "{tf: probe_tip}}", "{tf: probe_tip}, position_scale: 0.001}"));
  EXPECT_NE(error.find("key `tools[1].position_scale`: 0.001: expected this key only with pose_source: {topic: ...}"),
            std::string::npos)
      << error;
}

const char kAssessment[] =
    "assessment:\n  planned:\n    - {tool: scalpel, points_m: [[0, 0, 0], [1, 0, 0]], direction: [0, 0, -1]}\n"
    "  forbidden: [{name: vein, box_m: {min: [0, 0, 0], max: [1, 1, 1]}}]\n";

TEST_F(SceneFileTest, AssessmentIsReadStrictly) {
  const Scene scene = Read(kGoodScene + kAssessment);
  ASSERT_EQ(scene.assessment.planned.size(), 1u);
  EXPECT_EQ(scene.assessment.planned[0].points.size(), 2u);
  EXPECT_EQ(scene.assessment.planned[0].direction->z(), -1);
  ASSERT_EQ(scene.assessment.forbidden.size(), 1u);
  EXPECT_EQ(scene.assessment.forbidden[0].name, "vein");
  const std::pair<std::string, std::string> bad[][2] = {
      {{"tool: scalpel", "tool: saw"}, {"", "planned[0].tool`: saw: expected the name of a tool of this scene"}},
      {{", [1, 0, 0]]", "]"}, {"", "planned[0].points_m`: [[0, 0, 0]]: expected at least two points"}},
      {{"direction: [0, 0, -1]", "direction: [0, 0, 0]"},
       {"", "planned[0].direction`: [0, 0, 0]: expected a direction"}},
      {{"max: [1, 1, 1]", "max: [1, 0, 1]"},
       {"", "forbidden[0].box_m.max`: [1, 0, 1]: expected each coordinate above"}},
      {{"name: vein", "nam: vein"}, {"", "forbidden[0].nam`: vein: unknown key; expected `name`?"}}};
  for (const auto& edit : bad) {
    const std::string error = ErrorOf(kGoodScene + Replaced(kAssessment, edit[0].first, edit[0].second));
    EXPECT_NE(error.find("key `assessment." + edit[1].second), std::string::npos) << error;
  }
}

TEST_F(ToolKeysTest, ForceIsOffUnlessTheSceneHasIt) {
  EXPECT_FALSE(Read(kGoodScene).tools[0].force);
  const Scene scene = Read(With("    force: {toughness_j_m2: 300, flat_normal: [0, 2, 0], max_force_n: 1.5}\n"));
  ASSERT_TRUE(scene.tools[0].force);
  EXPECT_EQ(scene.tools[0].force->toughness_j_m2, 300);
  EXPECT_EQ(scene.tools[0].force->flat_normal->y(), 1);
  EXPECT_EQ(scene.tools[0].force->max_force_n, 1.5);
  EXPECT_NE(ErrorOf(With("    force: {max_force_n: 0}\n")).find("force.max_force_n`: 0: expected"), std::string::npos);
  EXPECT_NE(ErrorOf(With("    force: {flat_normal: [0, 0, 0]}\n")).find("force.flat_normal`: [0, 0, 0]: expected a dir"),
            std::string::npos);
}

TEST_F(SceneFileTest, ObstaclesFromALink) {
  const Scene scene =
      Read(Replaced(kGoodScene, "obstacles:", "obstacles:\n  - urdf_link: {link: table, friction: 0.3}"));
  ASSERT_EQ(scene.link_obstacles.size(), 1u);
  EXPECT_EQ(scene.link_obstacles[0].link, "table");
  EXPECT_EQ(scene.link_obstacles[0].friction, 0.3);
  EXPECT_FALSE(scene.obstacles.empty());
  const std::string error =
      ErrorOf(Replaced(kGoodScene, "obstacles:", "obstacles:\n  - urdf_link: {lnk: table, friction: 0.3}"));
  EXPECT_NE(error.find("urdf_link.lnk`: table: unknown key; expected `link`?"), std::string::npos) << error;
}

}  // namespace
}  // namespace meshless_cutting
