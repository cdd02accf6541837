// Flakes of next to no mass, and small pieces beside large ones: neither is left to what the solver did not resolve.
#include "dynamics/light_particles.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "cut/soft_body.h"
#include "dynamics/dynamics.h"
#include "support/box_tissue.h"
#include "support/shapes.h"

namespace meshless_cutting {
namespace {

/// What Follow() makes of random motion.
Field Followed(const LightParticles& light, int particles) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Field fields[3];
  for (Field& field : fields) {
    for (int j = 0; j < particles; ++j) field.push_back({uniform(random), uniform(random), uniform(random), 0});
  }
  light.Follow(fields[0], fields[1], fields[2]);
  for (Field& field : fields) fields[0].insert(fields[0].end(), field.begin(), field.end());
  return fields[0];
}

TEST(LightParticles, AreThoseOfTheWholeTissueAfterEachOfManyCuts) {
  const Lattice lattice = FillWithLattice(BoxMesh({0, 0, 0}, {0.06, 0.05, 0.04}), 0.008).lattice;
  ObjectConfig object;
  object.material.density_kg_m3 = 1000;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  int most = 0;
  for (const double cell : {0.008, 0.01}) {
    object.cell_size_m = cell;
    SoftBody body(lattice, object, true);
    LightParticles light;
    light.Build(body.tissue(), cell);
    for (int round = 0; round < 40; ++round) {
      std::vector<LinkCut> cuts;
      for (int l = 0; l < static_cast<int>(lattice.links.size()); ++l) {
        if (!body.graph().IsCut(l) && uniform(random) < 0.01) cuts.push_back({l, uniform(random)});
      }
      if (cuts.empty()) continue;
      body.CloseWindow();
      body.Cut(cuts);
      light.Build(body.tissue(), cell);
      LightParticles anew;
      anew.Build(body.tissue(), cell);
      ASSERT_EQ(light.count(), anew.count()) << "round " << round;
      const int particles = body.tissue().particle_count();
      const Field a = Followed(light, particles), b = Followed(anew, particles);
      for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a[i].vector(), b[i].vector()) << "round " << round << ", value " << i;
      }
      most = std::max(most, light.count());
    }
  }
  EXPECT_GT(most, 10);
}

/// Two cells in a row; of the second a cut has left a ten-thousandth.
Tissue CellWithFlake() {
  BoxTissueConfig box;
  box.cells = {2, 1, 1};
  box.size = {0.01, 0.005, 0.005};
  Tissue tissue = MakeBoxTissue(box);
  tissue.point_volume[1] *= 1e-4;
  for (int j = 0; j < tissue.particle_count(); ++j) {
    if (tissue.particle_rest[j].x() > 0.009) tissue.particle_mass[j] *= 1e-4;
  }
  return tissue;
}

TEST(LightParticles, FollowTheAffineMotionOfTheMaterialBehindThem) {
  const Tissue tissue = CellWithFlake();
  LightParticles light;
  light.Build(tissue, 0.005);
  ASSERT_EQ(light.count(), 4);

  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(-1, 1);
  Eigen::Matrix3d A, L;
  for (int i = 0; i < 9; ++i) A.data()[i] = (i % 4 == 0) + 0.3 * share(random), L.data()[i] = share(random);
  Field position, velocity, acceleration;
  for (const Eigen::Vector3d& X : tissue.particle_rest) {
    position.push_back(Vector4::From(A * X));
    velocity.push_back(Vector4::From(L * X));
    acceleration.push_back(Vector4::From(A * L * X));
  }
  const Field x = position;
  for (int j = 0; j < tissue.particle_count(); ++j) {
    if (tissue.particle_rest[j].x() < 0.009) continue;
    position[j] += Vector4{0.02, 0, 0, 0};  // metres away from where it should be, and on its way
    velocity[j] += Vector4{8, -3, 0, 0};
    acceleration[j] += Vector4{0, 0, 1e4, 0};
  }
  light.Follow(position, velocity, acceleration);
  for (int j = 0; j < tissue.particle_count(); ++j) {
    const Eigen::Vector3d X = tissue.particle_rest[j];
    EXPECT_LT((velocity[j].vector() - L * X).norm(), 1e-15);
    EXPECT_LT((acceleration[j].vector() - A * L * X).norm(), 1e-15);
    EXPECT_LT((position[j] - x[j]).vector().norm(), LightParticles::kReach * 0.005 * (1 + 1e-12));
  }
}

// Found by session_search with seed 1019: the material behind the flake began beyond a smaller chip.
TEST(LightParticles, FollowMaterialBeyondASmallerChip) {
  BoxTissueConfig box;
  box.cells = {3, 1, 1};
  box.size = {0.015, 0.005, 0.005};
  Tissue tissue = MakeBoxTissue(box);
  tissue.point_volume[1] *= 1e-4;
  tissue.point_volume[2] *= 1e-3;
  for (int j = 0; j < tissue.particle_count(); ++j) {
    if (tissue.particle_rest[j].x() > 0.009) tissue.particle_mass[j] *= 1e-3;
  }
  LightParticles light;
  light.Build(tissue, 0.005);
  EXPECT_EQ(light.count(), 8);
  Field position, velocity, acceleration(tissue.particle_count());
  for (const Eigen::Vector3d& X : tissue.particle_rest) {
    position.push_back(Vector4::From(X));
    velocity.push_back(X.x() < 0.009 ? Vector4{1, 2, 3, 0} : Vector4{-40, 0, 7, 0});
  }
  light.Follow(position, velocity, acceleration);
  for (const Vector4& v : velocity) EXPECT_LT((v - Vector4{1, 2, 3, 0}).vector().norm(), 1e-12);
}

TEST(LightParticles, FullCellsHaveNone) {
  BoxTissueConfig box;
  LightParticles light;
  light.Build(MakeBoxTissue(box), 0.025);
  EXPECT_EQ(light.count(), 0);
}

/// Adds `piece` to `tissue`, `offset` away.
void Append(const Tissue& piece, const Eigen::Vector3d& offset, Tissue& tissue) {
  const int first = tissue.particle_count();
  for (int j = 0; j < piece.particle_count(); ++j) {
    tissue.particle_rest.push_back(piece.particle_rest[j] + offset);
    tissue.particle_mass.push_back(piece.particle_mass[j]);
    tissue.particle_fixed.push_back(piece.particle_fixed[j]);
  }
  for (int j : piece.point_particles) tissue.point_particles.push_back(first + j);
  for (int p = 0; p < piece.point_count(); ++p) {
    tissue.point_volume.push_back(piece.point_volume[p]);
    tissue.point_rest.push_back(piece.point_rest[p] + offset);
  }
  for (const Eigen::Vector3d& g : piece.point_gradients) tissue.point_gradients.push_back(g);
}

/// Where the particles of the piece are after half a second in which it swings, clamped and under its own weight;
/// beside a block of a hundred times its mass, or alone.
std::vector<Eigen::Vector3d> SwingOfAPiece(bool beside_a_block) {
  BoxTissueConfig block, piece;
  block.cells = {12, 6, 6};
  block.size = {0.12, 0.06, 0.06};
  piece.cells = {6, 1, 1};
  piece.size = {0.03, 0.005, 0.005};
  block.clamp_x0 = piece.clamp_x0 = true;
  Tissue tissue = MakeBoxTissue(piece);
  const int particles = tissue.particle_count();
  if (beside_a_block) Append(MakeBoxTissue(block), Eigen::Vector3d(0, 0.1, 0), tissue);
  DynamicsConfig config;
  config.material = {MaterialModel::kStableNeoHookean, 2e5, 0.4, 1000};
  config.gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);
  config.solver.threads = 1;
  Dynamics dynamics(config, tissue);
  TissueState state = RestState(tissue);
  for (int n = 0; n < 30; ++n) dynamics.Advance(tissue, {}, state);
  state.position.resize(particles);
  return state.position;
}

TEST(LightParticles, SmallPiecesAreSolvedAsIfTheyWereAlone) {
  const std::vector<Eigen::Vector3d> alone = SwingOfAPiece(false), beside = SwingOfAPiece(true);
  double difference = 0, drop = 0;
  for (std::size_t j = 0; j < alone.size(); ++j) {
    difference = std::max(difference, (alone[j] - beside[j]).norm());
    drop = std::max(drop, -alone[j].z());
  }
  EXPECT_GT(drop, 0.001);
  EXPECT_LT(difference, 0.05 * drop);  // with residuals measured over all of the object: 0.095
}

}  // namespace
}  // namespace meshless_cutting
