// Random strokes of random blades through bodies that move and deform at random: the crossing search finds exactly the
// links that an exhaustive exact search finds, and after every cut all invariants hold.
#include <gtest/gtest.h>

#include <random>

#include "crossing/edge_edge.h"
#include "crossing/find_crossings.h"
#include "cut/soft_body.h"
#include "simulation_checks.h"
#include "support/shapes.h"

namespace meshless_cutting {
namespace {

using Random = std::mt19937_64;

double Uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Eigen::Vector3d RandomVector(Random& random, double size) {
  return {Uniform(random, -size, size), Uniform(random, -size, size), Uniform(random, -size, size)};
}

/// Links that the blade crosses in the window, by trying them all.
std::vector<int> ExhaustiveSearch(const SoftBody& body, const BladeMotion& blade) {
  std::vector<int> links;
  for (size_t l = 0; l < body.lattice().links.size(); ++l) {
    const int link = static_cast<int>(l);
    if (body.graph().IsCut(link)) continue;
    const auto& [a, b] = body.lattice().links[l];
    const auto [a0, a1] = body.motion().At(a);
    const auto [b0, b1] = body.motion().At(b);
    bool crossed = false;
    for (const BladeWindow& w : blade)
      for (size_t e = 0; e + 1 < w.points_t0.size() && !crossed; ++e) {
        const MovingSegment object = {(1 - w.t0) * a0 + w.t0 * a1, (1 - w.t0) * b0 + w.t0 * b1,
                                      (1 - w.t1) * a0 + w.t1 * a1, (1 - w.t1) * b0 + w.t1 * b1};
        crossed = FindFirstCrossing({w.points_t0[e], w.points_t0[e + 1], w.points_t1[e], w.points_t1[e + 1]}, object)
                      .has_value();
      }
    if (crossed) links.push_back(link);
  }
  return links;
}

/// A polyline that flies through the body along a curve, bending and twisting.
class RandomBlade {
 public:
  RandomBlade(Random& random, double size) : random_(random), size_(size) {
    const int edges = std::uniform_int_distribution<int>(1, 5)(random);
    const Eigen::Vector3d start = RandomVector(random, size), along = RandomVector(random, 1).normalized() * size;
    for (int i = 0; i <= edges; ++i)
      points_.push_back(start + along * (i / double(edges) - 0.5) + RandomVector(random, 0.1 * size));
    velocity_ = -start / 6 + RandomVector(random, 0.05 * size);
  }
  BladeMotion Frame() {
    const int windows = std::uniform_int_distribution<int>(1, 3)(random_);
    BladeMotion motion;
    for (int i = 0; i < windows; ++i) {
      BladeWindow w{i / double(windows), (i + 1) / double(windows), points_, {}};
      if (Uniform(random_, 0, 1) < 0.8)  // else it rests
        for (Eigen::Vector3d& p : points_) p += (velocity_ + RandomVector(random_, 0.03 * size_)) / windows;
      w.points_t1 = points_;
      motion.push_back(w);
    }
    if (Uniform(random_, 0, 1) < 0.1) velocity_ = -velocity_;
    return motion;
  }

 private:
  Random& random_;
  double size_;
  std::vector<Eigen::Vector3d> points_;
  Eigen::Vector3d velocity_;
};

void Stroke(const Lattice& lattice, double size, double cell_size, int frames, Random& random) {
  ObjectConfig config;
  config.cell_size_m = cell_size;
  config.material.density_kg_m3 = 1000;
  SoftBody body(lattice, config, true);
  CrossingFinder finder(body.lattice(), body.graph());
  RandomBlade blade(random, size);
  const double volume = RestVolume(body.surface());
  for (int frame = 0; frame < frames; ++frame) {
    const BladeMotion motion = blade.Frame();
    const auto& crossings = finder.Find(motion, body.motion());
    std::vector<int> links;
    std::vector<LinkCut> cuts;
    for (const Crossing& c : crossings) {
      links.push_back(c.cut.link);
      cuts.push_back(c.cut);
      ASSERT_TRUE(c.t >= 0 && c.t <= 1 && c.cut.u >= 0 && c.cut.u <= 1);
    }
    ASSERT_EQ(links, ExhaustiveSearch(body, motion)) << "frame " << frame;
    body.CloseWindow();
    if (!cuts.empty()) {
      body.Cut(cuts);
      ASSERT_EQ(CheckBody(body), "") << "frame " << frame;
      ASSERT_NEAR(RestVolume(body.surface()), volume, 1e-11 * volume);
    }
    // Any motion of the particles will do: a common drift, a flow and noise.
    body.BeginAdvance();
    const Eigen::Vector3d drift = RandomVector(random, 0.02 * size);
    const Eigen::Matrix3d flow = Eigen::Matrix3d::NullaryExpr([&] { return Uniform(random, -0.05, 0.05); });
    for (Eigen::Vector3d& x : body.mutable_state().position)
      x += drift + flow * x + RandomVector(random, 0.02 * cell_size);
    body.EndAdvance();
    ASSERT_EQ(CheckSurfaceClosed(body.surface()), "");
  }
}

TEST(RandomStrokes, ThroughABlock) {
  Random random(1);
  const Lattice lattice = FillWithLattice(BoxMesh({-0.02, -0.015, -0.01}, {0.02, 0.015, 0.01}), 0.005).lattice;
  for (int i = 0; i < 12 && !HasFatalFailure(); ++i) Stroke(lattice, 0.02, 0.01, 15, random);
}

TEST(RandomStrokes, ThroughAThinPlate) {
  Random random(2);
  const Lattice lattice = FillWithLattice(BoxMesh({-0.02, -0.02, -0.001}, {0.02, 0.02, 0.001}), 0.004).lattice;
  for (int i = 0; i < 12 && !HasFatalFailure(); ++i) Stroke(lattice, 0.02, 0.006, 15, random);
}

TEST(RandomStrokes, ThroughASphere) {
  Random random(3);
  const Lattice lattice =
      FillWithLattice(ReadTriangleMesh(MESHLESS_CUTTING_SOURCE_DIR "/meshes/sphere.obj", 1), 0.01).lattice;
  for (int i = 0; i < 8 && !HasFatalFailure(); ++i) Stroke(lattice, 0.04, 0.02, 15, random);
}

}  // namespace
}  // namespace meshless_cutting
