// A program of its own: it replaces operator new.
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace meshless_cutting
