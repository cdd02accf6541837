// Scene files for the tests of the reader: a good one, and edits of it.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "scene/scene_reader.h"

namespace meshless_cutting {

/// A folder of its own for each test, removed at the end; holds box.obj (empty: the reader only asks whether it is
/// there).
class SceneFileTest : public testing::Test {
 protected:
  SceneFileTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(info->test_suite_name()) + "_" + info->name() + "_" + std::to_string(getpid());
    for (char& c : name) c = c == '/' ? '_' : c;
    folder_ = std::filesystem::temp_directory_path() / name;
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "box.obj") << "v 0 0 0\n";
  }
  ~SceneFileTest() override { std::filesystem::remove_all(folder_); }

  Scene Read(const std::string& text) const {
    std::ofstream(folder_ / "scene.yaml") << text;
    return ReadScene(folder_ / "scene.yaml");
  }

  /// The message with which reading `text` fails; "" when it does not.
  std::string ErrorOf(const std::string& text) const {
    try {
      Read(text);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  static std::string Replaced(std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("the test's scene has no " + from);
    return text.replace(at, from.size(), to);
  }

  static inline const std::string kGoodScene = R"(scene_version: 1
frame: cell
time_step_s: 0.01
object:
  name: block
  mesh: box.obj
  scale: 0.5
  pose: {position_m: [1, 2, 3], orientation_xyzw: [0, 0, 0.7071067811865476, 0.7071067811865476]}
  cell_size_m: 0.008
  lattice_size_m: 0.004
  material: {model: neo_hookean, youngs_modulus_pa: 5000, poisson_ratio: 0.45, density_kg_m3: 1050}
  fixed: [{box_m: {min: [-1, -1, -1], max: [1, 1, 0.01]}}]
  support_radius_cells: 0.95
gravity_m_s2: [0, 0, -9.81]
obstacles:
  - plane: {point_m: [0, 0, -0.12], normal: [0, 0, 2], friction: 0.4}
  - box_m: {min: [0, 0, 0], max: [2, 4, 6], pose: {position_m: [10, 0, 0]}, friction: 0.1}
damping: {mass_per_s: 0.5, stiffness_s: 0.002}
tools:
  - name: scalpel
    cutting_edge_m: [[0, 0, 0], [0, 0, 0.03]]
    pose_source: {topic: scalpel/measured_cp}
    max_speed_m_s: 3
    timeout_s: 0.2
  - {name: probe, urdf_link: blade, pose_source: {tf: probe_tip}}
  - {name: knife, cutting_edge_m: [[0, 0, 0], [0, 0, 1]], pose_source: {fixed: {position_m: [0, 1, 0]}}}
solver: {integrator: implicit_euler, relative_tolerance: 1e-4, newton_iterations: 7, threads: 3}
)";

  std::filesystem::path folder_;
};

}  // namespace meshless_cutting
