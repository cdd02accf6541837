// Same input, same bits, whatever the number of threads.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <cstring>
#include <thread>

#include "dynamics/dynamics.h"
#include "dynamics/thread_pool.h"
#include "support/box_tissue.h"

namespace meshless_cutting {
namespace {

TissueState RunWith(int threads) {
  BoxTissueConfig box;
  box.cells = {12, 10, 9};
  const Tissue tissue = MakeBoxTissue(box);
  DynamicsConfig config;
  config.material = {MaterialModel::kStableNeoHookean, 5e3, 0.45, 1000};
  config.gravity_m_s2 = Eigen::Vector3d(0.5, 0, -9.81);
  config.damping = DampingConfig{0.5, 0.005};
  config.obstacles.push_back({PlaneObstacle{Eigen::Vector3d(0, 0, -0.004), Eigen::Vector3d::UnitZ()}, 0.4});
  config.solver.threads = threads;
  Dynamics dynamics(config, tissue);
  TissueState state = RestState(tissue);
  const SurfacePoints skin = MakeBoxSkin(box);
  for (int n = 0; n < 20; ++n) dynamics.Advance(tissue, skin, state);
  return state;
}

TEST(Determinism, BitsDoNotDependOnTheThreads) {
  const TissueState one = RunWith(1);
  for (const int threads : {2, 3, 1}) {
    const TissueState other = RunWith(threads);
    const std::size_t bytes = one.position.size() * sizeof(Eigen::Vector3d);
    EXPECT_EQ(std::memcmp(one.position.data(), other.position.data(), bytes), 0) << threads << " threads";
    EXPECT_EQ(std::memcmp(one.velocity.data(), other.velocity.data(), bytes), 0) << threads << " threads";
  }
}

TEST(ThreadPool, RunsEveryTaskOnce) {
  for (const int threads : {0, 1, 2, 4}) {
    ThreadPool pool(threads);
    std::vector<int> done(1000);
    for (int loop = 0; loop < 2000; ++loop) {
      const int count = loop % 50;
      pool.ForEach(count, [&](int i) { ++done[i]; });
    }
    for (int i = 0; i < 50; ++i) EXPECT_EQ(done[i], 40 * (49 - i));
  }
}

/// More threads than processors, loops that wait for long tasks, pauses in which threads go to sleep.
TEST(ThreadPool, SleepersAreWokenAndWaitedFor) {
  ThreadPool pool(7);
  std::vector<std::int64_t> sums(64);
  for (int loop = 0; loop < 300; ++loop) {
    const int length = loop % 3 == 0 ? 20000 : 10;
    pool.ForEach(64, [&](int i) {
      volatile std::int64_t sum = 0;
      for (int n = 0; n < (i % 9 == 0 ? length : 1); ++n) sum = sum + n;
      sums[i] += sum + 1;
    });
    if (loop % 50 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(3));
  }
  const auto of = [](std::int64_t n) { return n * (n - 1) / 2 + 1; };
  for (int i = 0; i < 64; ++i) EXPECT_EQ(sums[i], i % 9 == 0 ? 100 * of(20000) + 200 * of(10) : 300) << i;
}

}  // namespace
}  // namespace meshless_cutting
