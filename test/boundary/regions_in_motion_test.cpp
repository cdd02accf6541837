// Prescribed motion, dead loads, reactions, probes, materials and slits of scenes, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "lattice/primitives.h"
#include "simulation.h"

namespace meshless_cutting {
namespace {

/// A bar of 0.08 x 0.02 x 0.02 m along x, linear, static; probes at its free end and in the middle.
Scene BarScene(double poisson_ratio) {
  Scene scene;
  scene.object.name = "bar";
  scene.object.primitive = Box{{0, 0, 0}, {0.08, 0.02, 0.02}};
  scene.object.cell_size_m = scene.object.lattice_size_m = 0.005;
  scene.object.material = {MaterialModel::kLinear, 1e5, poisson_ratio, 1000};
  scene.object.fixed = {{{-1, -1, -1}, {0, 1, 1}, "root"}};
  scene.solver = {Integrator::kQuasiStatic, 1e-10, 50, 1};
  scene.probes = {{"end", {0.08, 0.01, 0.01}, {0, 0, 0}}, {"middle", {0.04, 0.01, 0.01}, {0, 0, 0}}};
  return scene;
}

LoadRegion Load(const Box& box, bool is_traction, const Eigen::Vector3d& value) {
  return {box, is_traction, {{0}, {value}, false}};
}

TEST(DeadLoad, PullsABarAsHookeSays) {
  for (bool is_traction : {false, true}) {
    Scene scene = BarScene(0);
    const double force = 0.4, traction = force / (0.02 * 0.02);
    scene.object.loads = {Load({{0.08, -1, -1}, {1, 1, 1}}, is_traction, {is_traction ? traction : force, 0, 0})};
    Simulation simulation(scene);
    simulation.Step();
    simulation.Step();
    EXPECT_NEAR(simulation.probes()[0].displacement.x(), traction / 1e5 * 0.08, 1e-9);
    EXPECT_NEAR(simulation.probes()[1].displacement.x(), traction / 1e5 * 0.04, 1e-9);
    ASSERT_EQ(simulation.reactions().size(), 1u);
    EXPECT_EQ(simulation.reactions()[0].name, "root");
    EXPECT_NEAR(simulation.reactions()[0].force_n.x(), -force, 1e-7);
  }
}

TEST(DeadLoad, KeepsItsForceAndTorqueAcrossACutThroughItsFace) {
  Scene scene = BarScene(0.3);
  scene.object.loads = {Load({{0.08, -1, -1}, {1, 1, 1}}, false, {0, 0, -0.01})};
  // Along the bar, from the loaded end to the middle: two fingers bend instead of one bar, the load is the same.
  scene.object.slits = {{{0.04, -0.01, 0.0103}, {{0.05, 0, 0}, {0, 0.04, 0}}}};
  Simulation simulation(scene);
  simulation.Step();
  simulation.Step();
  EXPECT_GT(simulation.statistics().links_cut, 0);
  EXPECT_NEAR(simulation.reactions()[0].force_n.z(), 0.01, 1e-8);
  EXPECT_NEAR(simulation.reactions()[0].torque_nm.y(), -0.01 * 0.08, 2e-6);  // arm of the bent bar: second order
}

// Probes on the face of a region: their weights reach into the cell behind by some per cent of the strain there.
TEST(PrescribedRegion, MovesAndTurnsAndReportsBalancedReactions) {
  Scene scene = BarScene(0.3);
  scene.object.material.model = MaterialModel::kStableNeoHookean;
  PrescribedRegion grip;
  grip.box = {{0.08, -1, -1}, {1, 1, 1}, "grip"};
  grip.displacement_m = {{0, 0.05}, {{0, 0, 0}, {0.01, 0, 0.002}}, false};
  grip.axis_point = {0, 0.01, 0.01};
  grip.axis = Eigen::Vector3d::UnitX();
  grip.angle_rad = {{0, 0.05}, {0, 1}, true};
  scene.object.prescribed = {grip};
  scene.probes.push_back({"corner", {0.08, 0.02, 0.01}, {0, 0, 0}});
  Simulation simulation(scene);
  for (int n = 0; n < 5; ++n) simulation.Step();
  EXPECT_EQ(simulation.statistics().status & kStepFrozen, 0u);
  EXPECT_LT((simulation.probes()[0].displacement - Eigen::Vector3d(0.01, 0, 0.002)).norm(), 5e-6);
  const Eigen::Vector3d corner(0.01, 0.01 * (std::cos(1.0) - 1), 0.002 + 0.01 * std::sin(1.0));
  EXPECT_LT((simulation.probes()[2].displacement - corner).norm(), 5e-6);
  const Reaction &root = simulation.reactions()[0], &held = simulation.reactions()[1];
  EXPECT_LT((root.force_n + held.force_n).norm(), 1e-6 * held.force_n.norm());
  const Eigen::Vector3d moment = held.torque_nm + (held.about - root.about).cross(held.force_n);
  EXPECT_LT((root.torque_nm + moment).norm(), 1e-6 * held.torque_nm.norm());
  EXPECT_GT(held.torque_nm.x(), 0);
}

TEST(PrescribedRegion, MovesInDynamicScenesToo) {
  for (Integrator integrator : {Integrator::kGeneralizedAlpha, Integrator::kImplicitEuler}) {
    Scene scene = BarScene(0.45);
    scene.object.material.model = MaterialModel::kStableNeoHookean;
    scene.solver = {integrator, 1e-4, 10, 1};
    scene.damping = DampingConfig{2, 0.005};
    PrescribedRegion grip;
    grip.box = {{0.08, -1, -1}, {1, 1, 1}, "grip"};
    grip.displacement_m = {{0, 0.2}, {{0, 0, 0}, {0.02, 0, 0}}, false};
    grip.angle_rad = {{0}, {0.0}, false};
    scene.object.prescribed = {grip};
    Simulation simulation(scene);
    for (int n = 0; n < 240; ++n) simulation.Step();
    EXPECT_LT((simulation.probes()[0].displacement - Eigen::Vector3d(0.02, 0, 0)).norm(), 5e-6);
    EXPECT_NEAR(simulation.probes()[1].displacement.x(), 0.01, 2e-4);
    EXPECT_LT(simulation.statistics().kinetic_j, 1e-9);
    EXPECT_NEAR(simulation.reactions()[0].force_n.x(), -simulation.reactions()[1].force_n.x(), 1e-3);
  }
}

TEST(MaterialRegion, TwoSpringsInARow) {
  Scene scene = BarScene(0);
  MaterialRegion stiff;
  stiff.box = Box{{-1, -1, -1}, {0.04, 1, 1}};
  stiff.material = {MaterialModel::kLinear, 4e5, 0, 3000};
  scene.object.regions = {stiff};
  scene.object.loads = {Load({{0.08, -1, -1}, {1, 1, 1}}, true, {1000, 0, 0})};
  Simulation simulation(scene);
  simulation.Step();
  simulation.Step();
  EXPECT_NEAR(simulation.probes()[1].displacement.x(), 1000 / 4e5 * 0.04, 1e-8);
  EXPECT_NEAR(simulation.probes()[0].displacement.x(), 1000 / 4e5 * 0.04 + 1000 / 1e5 * 0.04, 1e-8);
}

TEST(MaterialRegion, HasItsOwnDensity) {
  Scene scene = BarScene(0);
  MaterialRegion heavy;
  heavy.box = Box{{-1, -1, -1}, {0.04, 1, 1}};
  heavy.material = {MaterialModel::kLinear, 1e5, 0, 3000};
  scene.object.regions = {heavy};
  scene.gravity_m_s2 = Eigen::Vector3d(0, 0, -10);
  Simulation simulation(scene);
  simulation.Step();
  simulation.Step();
  EXPECT_NEAR(simulation.reactions()[0].force_n.z(), 10 * 0.02 * 0.02 * 0.04 * (1000 + 3000), 1e-7);
}

TEST(Slit, OpensUnderTheWeightOfABeam) {
  Scene scene = BarScene(0.3);
  scene.object.material = {MaterialModel::kStableNeoHookean, 2e4, 0.3, 1000};
  scene.object.fixed.push_back({{0.08, -1, -1}, {1, 1, 1}, "other"});
  scene.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  scene.object.slits = {{{0.04, -0.01, -0.01}, {{0, 0.04, 0}, {0, 0, 0.02}}}};
  scene.probes = {{"left", {0.04, 0.01, 0}, {-1, 0, 0}}, {"right", {0.04, 0.01, 0}, {1, 0, 0}}};
  Simulation simulation(scene);
  for (int n = 0; n < 3; ++n) simulation.Step();
  EXPECT_EQ(simulation.CheckInvariants(), "");
  const double left = simulation.probes()[0].displacement.x(), right = simulation.probes()[1].displacement.x();
  EXPECT_LT(left, -1e-4);
  EXPECT_NEAR(right, -left, 0.02 * right);
}

TEST(Primitives, HaveTheirVolume) {
  Scene scene = BarScene(0.3);
  EXPECT_NEAR(Simulation(scene).lattice_report().volume_m3, 0.08 * 0.02 * 0.02, 1e-15);
  scene.object.primitive = CylinderPrimitive{{0, 0, 0}, {0.08, 0, 0}, 0.01};
  scene.object.lattice_size_m = 0.002;
  EXPECT_NEAR(Simulation(scene).lattice_report().volume_m3, M_PI * 1e-4 * 0.08, 0.01 * M_PI * 1e-4 * 0.08);
  // An L, not convex, clockwise.
  scene.object.primitive =
      PrismPrimitive{2, {{0, 0}, {0, 0.02}, {0.01, 0.02}, {0.01, 0.01}, {0.08, 0.01}, {0.08, 0}}, 0, 0.02};
  scene.object.lattice_size_m = 0.005;
  scene.object.fixed = {{{-1, -1, -1}, {0, 1, 1}, "root"}};
  scene.probes.clear();
  EXPECT_NEAR(Simulation(scene).lattice_report().volume_m3, (0.08 * 0.01 + 0.01 * 0.01) * 0.02, 1e-12);
}

TEST(BadScene, BoxesThatMissAreNamed) {
  const auto error_of = [](const Scene& scene) -> std::string {
    try {
      Simulation simulation(scene);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  Scene scene = BarScene(0);
  scene.object.loads = {Load({{0.5, 0, 0}, {1, 1, 1}}, true, {1, 0, 0})};
  EXPECT_NE(error_of(scene).find("object.loads[0].box_m"), std::string::npos) << error_of(scene);
  scene = BarScene(0);
  scene.object.prescribed.push_back({{{0.5, 0, 0}, {1, 1, 1}}, {{0}, {Eigen::Vector3d::Zero()}, false}, {}, {0, 0, 1}, {{0}, {0}, false}});
  EXPECT_NE(error_of(scene).find("object.prescribed[0]"), std::string::npos) << error_of(scene);
  scene = BarScene(0);
  scene.probes[1].position = {1, 0, 0};
  EXPECT_NE(error_of(scene).find("probes[1]"), std::string::npos) << error_of(scene);
}

}  // namespace
}  // namespace meshless_cutting
