// The last resort of a frame for which no step is found.
#include "dynamics/strain_limit.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "dynamics/dynamics.h"
#include "support/box_tissue.h"

namespace meshless_cutting {
namespace {

Eigen::Matrix3d DeformationOf(const Tissue& tissue, int point, const std::vector<Eigen::Vector3d>& position) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Zero();
  for (int k = 0; k < tissue.support_size; ++k) {
    const int i = point * tissue.support_size + k;
    F += position[tissue.point_particles[i]] * tissue.point_gradients[i].transpose();
  }
  return F;
}

Tissue Beam(bool clamped) {
  BoxTissueConfig box;
  box.cells = {6, 1, 1};
  box.size = {0.06, 0.01, 0.01};
  box.clamp_x0 = clamped;
  return MakeBoxTissue(box);
}

Field Positions(const Tissue& tissue, const Eigen::Matrix3d& A) {
  Field x;
  for (const Eigen::Vector3d& X : tissue.particle_rest) x.push_back(Vector4::From(A * X));
  return x;
}

std::vector<Eigen::Vector3d> Vectors(const Field& x) {
  std::vector<Eigen::Vector3d> vectors;
  for (const Vector4& v : x) vectors.push_back(v.vector());
  return vectors;
}

TEST(StrainLimit, LeavesWhatIsWithinAsItIs) {
  const Tissue tissue = Beam(false);
  Eigen::Matrix3d A;
  A << 0, -1.9, 0, 1.9, 0, 0, 0, 0, 0.55;
  Field x = Positions(tissue, A);
  const Field before = x;
  StrainLimit limit;
  EXPECT_EQ(limit.Apply(tissue, std::vector<double>(x.size(), 1), x), 0);
  for (std::size_t j = 0; j < x.size(); ++j) EXPECT_EQ(x[j].vector(), before[j].vector());
}

TEST(StrainLimit, BringsStretchedCrushedAndMirroredPointsBack) {
  const Tissue tissue = Beam(true);
  for (const Eigen::Vector3d& stretch :
       {Eigen::Vector3d(100, 1, 1), Eigen::Vector3d(1, 1e-3, 1), Eigen::Vector3d(1, 1, -1), Eigen::Vector3d(0, 0, 0)}) {
    Field x = Positions(tissue, stretch.asDiagonal());
    std::vector<double> free(x.size(), 1);
    for (std::size_t j = 0; j < x.size(); ++j) {
      if (tissue.particle_fixed[j]) free[j] = 0, x[j] = Vector4::From(tissue.particle_rest[j]);
    }
    StrainLimit limit;
    EXPECT_GT(limit.Apply(tissue, free, x), 0);
    for (int frame = 0; frame < 40; ++frame) limit.Apply(tissue, free, x);
    for (std::size_t j = 0; j < x.size(); ++j) {
      if (tissue.particle_fixed[j] == 0) continue;
      EXPECT_EQ(x[j].vector(), tissue.particle_rest[j]);
    }
    for (int p = 0; p < tissue.point_count(); ++p) {
      const Eigen::Matrix3d F = DeformationOf(tissue, p, Vectors(x));
      const Eigen::Vector3d s = F.jacobiSvd().singularValues();
      EXPECT_GT(F.determinant(), 0) << stretch.transpose() << ", point " << p;
      EXPECT_LT(s[0], 1.1 * StrainLimit::kMost) << stretch.transpose() << ", point " << p;
      EXPECT_GT(s[2], 0.9 / StrainLimit::kMost) << stretch.transpose() << ", point " << p;
    }
  }
}

// Log neo-Hookean has no energy for inverted cells, so no step is found from there.
TEST(StrainLimit, AMirroredBodyMovesAgainAfterAFewFrames) {
  const Tissue tissue = Beam(false);
  DynamicsConfig config;
  config.material = {MaterialModel::kNeoHookean, 1e4, 0.45, 1000};
  config.solver.threads = 1;
  Dynamics dynamics(config, tissue);
  TissueState state = RestState(tissue);
  for (Eigen::Vector3d& x : state.position) x.z() = -x.z();
  int frozen = 0;
  while (frozen < 100 && dynamics.Advance(tissue, {}, state).status & kStepFrozen) ++frozen;
  EXPECT_GT(frozen, 0);
  EXPECT_LT(frozen, 20);
  for (int n = 0; n < 300; ++n) EXPECT_FALSE(dynamics.Advance(tissue, {}, state).status & kStepFrozen) << n;
  for (int p = 0; p < tissue.point_count(); ++p) {
    EXPECT_NEAR(DeformationOf(tissue, p, state.position).determinant(), 1, 0.1) << p;
  }
}

}  // namespace
}  // namespace meshless_cutting
