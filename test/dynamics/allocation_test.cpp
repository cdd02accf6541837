// A program of its own: it replaces operator new.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "dynamics/dynamics.h"
#include "support/box_tissue.h"
#include "support/count_allocations.h"

namespace meshless_cutting {
namespace {

TEST(Allocation, StepsAllocateNothing) {
  BoxTissueConfig box;
  box.cells = {6, 6, 6};
  const Tissue tissue = MakeBoxTissue(box);
  DynamicsConfig config;
  config.material = {MaterialModel::kStableNeoHookean, 5e3, 0.45, 1000};
  config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  config.damping = DampingConfig{0.5, 0.01};
  config.obstacles.push_back({PlaneObstacle{Eigen::Vector3d(0, 0, -0.004), Eigen::Vector3d::UnitZ()}, 0.5});
  config.obstacles.push_back({BoxObstacle{}, 0.5});
  const SurfacePoints skin = MakeBoxSkin(box);
  Dynamics dynamics(config, tissue);
  TissueState state = RestState(tissue);
  dynamics.Advance(tissue, skin, state);  // sizes what depends on the skin

  const long before = AllocationCount();
  int contacts = 0;
  for (int frame = 0; frame < 60; ++frame) contacts = dynamics.Advance(tissue, skin, state).contacts;
  EXPECT_EQ(AllocationCount(), before);
  EXPECT_GT(contacts, 0);

  // The same tissue again: every buffer is large enough. (A cut allocates only what it adds.)
  dynamics.TissueChanged(tissue);
  dynamics.Advance(tissue, skin, state);
  EXPECT_EQ(AllocationCount(), before);
}

/// Every subset of the optional parts builds, steps and allocates nothing on its way; what a part needs is not there without it.
TEST(Allocation, EverySubsetOfPartsStepsWithoutAllocatingAndAbsentPartsHoldNothing) {
  enum : unsigned { kGravity = 1, kMassDamping = 2, kStiffnessDamping = 4, kObstacle = 8, kFixed = 16, kExplicit = 32, kSubSteps = 64, kViscous = 128, kAll = 256 };
  std::vector<long> built(kAll);
  for (unsigned parts = 0; parts < kAll; ++parts) {
    BoxTissueConfig box;
    box.cells = {4, 3, 3};
    box.size = {0.04, 0.03, 0.03};
    box.clamp_x0 = parts & kFixed;
    const Tissue tissue = MakeBoxTissue(box);
    const SurfacePoints skin = parts & kObstacle ? MakeBoxSkin(box) : SurfacePoints();
    DynamicsConfig config;
    config.material = {MaterialModel::kStableNeoHookean, 5e3, 0.45, 1000};
    config.solver.threads = 1;
    if (parts & kGravity) config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
    if (parts & (kMassDamping | kStiffnessDamping)) {
      config.damping = DampingConfig{parts & kMassDamping ? 0.5 : 0, parts & kStiffnessDamping ? 0.01 : 0};
    }
    if (parts & kObstacle) {
      config.obstacles.push_back({PlaneObstacle{Eigen::Vector3d(0, 0, -0.001), Eigen::Vector3d::UnitZ()}, 0.5});
    }
    if (parts & kViscous) config.material.prony = {{0.5, 0.1}, {0.2, 2}};
    if (parts & kExplicit) config.solver.integrator = Integrator::kExplicit;
    if (parts & kSubSteps) config.solver.sub_steps = 2;
    TissueState state = RestState(tissue);
    for (int j = 0; j < tissue.particle_count(); ++j) state.velocity[j].z() = j % 2 == 0 ? -0.1 : -0.05;  // or it would sleep
    const long before = AllocationCount();
    Dynamics dynamics(config, tissue);
    dynamics.Advance(tissue, skin, state);
    built[parts] = AllocationCount() - before;
    const long ready = AllocationCount();
    for (int frame = 0; frame < 20; ++frame) {
      const AdvanceResult result = dynamics.Advance(tissue, skin, state);
      ASSERT_TRUE(std::isfinite(result.kinetic_j + result.elastic_j)) << parts;
    }
    EXPECT_EQ(AllocationCount(), ready) << parts;
  }
  for (unsigned parts = 0; parts < kAll; ++parts) {
    // Neither is anything more than a few numbers.
    for (unsigned free_part : {kGravity, kMassDamping, kSubSteps}) {
      EXPECT_EQ(built[parts | free_part], built[parts & ~free_part]) << parts;
    }
    EXPECT_GT(built[parts | kObstacle], built[parts & ~kObstacle]) << parts;
    EXPECT_GT(built[parts | kViscous], built[parts & ~kViscous]) << parts;
    EXPECT_GT(built[parts | kStiffnessDamping], built[parts & ~kStiffnessDamping]) << parts;
  }
}

}  // namespace
}  // namespace meshless_cutting
