// A node runs for days: what a session took, its reset gives back.
#include <gtest/gtest.h>

#include <array>

#include "support/count_allocations.h"
#include "support/scenes.h"

namespace meshless_cutting {
namespace {

TEST(Memory, AResetGivesBackEveryByteOfASession) {
  const Scene scene = BlockScene();
  Simulation simulation(scene);
  std::array<long, 6> bytes{};
  for (std::size_t session = 0; session < bytes.size(); ++session) {
    simulation.Reset();
    bytes[session] = LiveBytes();
    // Another place in each session: other cuts, other buffers.
    const double x = 0.03 + 0.01 * static_cast<double>(session);
    LineMotion stroke{{x, 0.02, 0.06}, {x, 0.02, -0.02}, 0.0, 0.2};
    for (int step = 1; step <= 30; ++step) {
      stroke.FeedUntil(simulation, 0, step * scene.time_step_s);
      simulation.Step();
    }
    EXPECT_EQ(simulation.surface().fragment_volume_m3.size(), 2u);
    EXPECT_GT(LiveBytes() - bytes[session], 10000);
  }
  // The first time also pays for what the program keeps for good.
  for (std::size_t session = 2; session < bytes.size(); ++session) EXPECT_EQ(bytes[session], bytes[1]) << session;
}

}  // namespace
}  // namespace meshless_cutting
