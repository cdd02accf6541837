#include "dynamics/elastic_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include "support/box_tissue.h"

namespace meshless_cutting {
namespace {

constexpr MaterialModel kModels[] = {MaterialModel::kStableNeoHookean, MaterialModel::kNeoHookean,
                                     MaterialModel::kStVenantKirchhoff, MaterialModel::kLinear};

/// Box tissues whose points take each of the three loops.
Tissue MakeTissue(SupportShape shape) {
  BoxTissueConfig config;
  config.cells = {5, 4, 3};
  config.size = {0.05, 0.044, 0.036};
  Tissue tissue = MakeBoxTissue(config);
  if (shape == SupportShape::kBox) {
    // Off the centre of the cell: trilinear gradients there are the centre's plus hourglass modes.
    for (int p = 0; p < tissue.point_count(); ++p) {
      for (int k = 0; k < 8; ++k) {
        for (int i = 0; i < 3; ++i) {
          for (int n = 0; n < 4; ++n) {
            tissue.point_gradients[8 * p + k][i] += 2.0 * std::sin(p + 3 * n + i) * Hadamard(kHourglassModes[n], k);
          }
        }
      }
    }
  }
  return shape == SupportShape::kGeneral ? WidenSupports(tissue, 20) : tissue;
}

class ElasticPointsTest : public testing::TestWithParam<SupportShape> {
 protected:
  ElasticPointsTest() : tissue_(MakeTissue(GetParam())), pool_(1) {}

  Field Positions(const Eigen::Matrix3d& F, const Eigen::Vector3d& t = Eigen::Vector3d::Zero()) const {
    Field x;
    for (const Eigen::Vector3d& X : tissue_.particle_rest) x.push_back(Vector4::From(F * X + t));
    return x;
  }
  Field Random(double size) {
    Field x(tissue_.particle_count());
    for (Vector4& v : x) v = {size * uniform_(generator_), size * uniform_(generator_), size * uniform_(generator_), 0};
    return x;
  }
  Field Sum(const Field& a, const Field& b, double s) const {
    Field sum = a;
    for (std::size_t j = 0; j < a.size(); ++j) sum[j] += s * b[j];
    return sum;
  }
  double Inner(const Field& a, const Field& b) const {
    double sum = 0;
    for (std::size_t j = 0; j < a.size(); ++j) sum += Dot(a[j], b[j]);
    return sum;
  }
  Field Zero() const { return Field(tissue_.particle_count()); }

  Tissue tissue_;
  ThreadPool pool_;
  std::mt19937 generator_{3};
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

TEST_P(ElasticPointsTest, SortsPointsByShape) {
  PointGroups groups;
  groups.Build(tissue_, {1e3});
  for (int shape = 0; shape < kSupportShapes; ++shape) {
    EXPECT_EQ(groups.groups[shape].batches > 0, shape == static_cast<int>(GetParam()));
  }
}

TEST_P(ElasticPointsTest, AffineMapsHaveTheEnergyOfTheirStrainAndNoForceInside) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F << 1.1, 0.2, 0, -0.1, 0.95, 0.05, 0, 0.1, 1.02;
  double volume = 0;
  for (double v : tissue_.point_volume) volume += v;
  for (MaterialModel model : kModels) {
    const MaterialConfig config{model, 1e4, 0.4, 1000};
    ElasticPoints points(config, pool_);
    points.TissueChanged(tissue_);
    Field gradient = Zero();
    const double energy = points.Evaluate(Positions(F, {1, 2, 3}), gradient);
    EXPECT_NEAR(energy, volume * MakeMaterial(config)->Energy(F), 1e-10 * energy);
    if (GetParam() != SupportShape::kBoxCentre) continue;  // the others are not integrated exactly at the rim
    for (int j = 0; j < tissue_.particle_count(); ++j) {
      const Eigen::Vector3d X = tissue_.particle_rest[j];
      const bool inside = (X.array() > 1e-6).all() && ((Eigen::Vector3d(0.05, 0.044, 0.036) - X).array() > 1e-6).all();
      if (!inside) continue;
      EXPECT_LT(gradient[j].vector().norm(), 1e-12 * energy / 0.01);
    }
  }
}

TEST_P(ElasticPointsTest, ForcesAndTorquesSumToZero) {
  for (MaterialModel model : kModels) {
    ElasticPoints points({model, 1e4, 0.4, 1000}, pool_);
    points.TissueChanged(tissue_);
    const Field x = Sum(Positions(Eigen::Matrix3d::Identity()), Random(1), 1e-3);
    Field gradient = Zero();
    points.Evaluate(x, gradient);
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero();
    double size = 0;
    for (std::size_t j = 0; j < x.size(); ++j) {
      force += gradient[j].vector();
      torque += x[j].vector().cross(gradient[j].vector());
      size += gradient[j].vector().norm();
    }
    EXPECT_LT(force.norm(), 1e-13 * size);
    if (model == MaterialModel::kLinear) continue;  // not objective
    EXPECT_LT(torque.norm(), 1e-13 * size);
  }
}

TEST_P(ElasticPointsTest, GradientAndProductAreDerivatives) {
  for (MaterialModel model : kModels) {
    ElasticPoints points({model, 1e4, 0.4, 1000}, pool_);
    points.TissueChanged(tissue_);
    // About the rest state the filter changes next to nothing.
    const Field x = Sum(Positions(Eigen::Matrix3d::Identity()), Random(1), 1e-8), d = Random(1);
    const double h = 1e-6;
    Field scratch = Zero(), plus = Zero(), minus = Zero(), product = Zero(), gradient = Zero();
    const double up = points.Evaluate(Sum(x, d, h), plus), down = points.Evaluate(Sum(x, d, -h), minus);
    points.Evaluate(x, gradient);
    PointTangent tangent;
    points.Resize(tangent);
    points.Linearise(x, true, tangent);
    points.AddProduct(tangent, 2, d, product);
    const Field slope = Sum(plus, minus, -1);
    EXPECT_NEAR(Inner(gradient, d), (up - down) / (2 * h), 1e-5 * Inner(product, d) * h + 1e-9);
    EXPECT_LT(std::sqrt(Inner(Sum(slope, product, -h), Sum(slope, product, -h))), 1e-3 * std::sqrt(Inner(slope, slope)));
  }
}

TEST_P(ElasticPointsTest, DampingAddsTheTangentTimesTheWay) {
  for (MaterialModel model : kModels) {
    ElasticPoints points({model, 1e4, 0.4, 1000}, pool_);
    points.TissueChanged(tissue_);
    const Field start = Sum(Positions(Eigen::Matrix3d::Identity()), Random(1), 1e-3);
    const Field x = Sum(start, Random(1), 1e-4), still = Sum(start, Random(1), 1e-4), way = Sum(x, still, -1);
    PointTangent tangent;
    points.Resize(tangent);
    points.Linearise(start, true, tangent);
    Field expected = Zero(), force = Zero(), gradient = Zero();
    const double elastic = points.Evaluate(x, expected);
    points.AddProduct(tangent, 0.3, way, force);
    const double energy = points.EvaluateInSlots(x, {&tangent, &still, 0.3});
    GatherSlots({0, tissue_.particle_count()}, points.slot_sums(), 1, gradient.data());
    EXPECT_NEAR(energy - elastic, 0.5 * Inner(way, force), 1e-12 * energy);
    const Field difference = Sum(gradient, Sum(expected, force, 1), -1);
    EXPECT_LT(std::sqrt(Inner(difference, difference)), 1e-12 * std::sqrt(Inner(gradient, gradient)));
  }
}

TEST_P(ElasticPointsTest, ProductIsSymmetricPositiveAndMatchesItsDiagonalAndItsCoarseMatrix) {
  for (MaterialModel model : kModels) {
    ElasticPoints points({model, 1e4, 0.4, 1000}, pool_);
    points.TissueChanged(tissue_);
    const Field x = Sum(Positions(Eigen::Matrix3d::Identity()), Random(1), 1e-3);
    PointTangent tangent;
    points.Resize(tangent);
    points.Linearise(x, true, tangent);
    const auto times = [&](const Field& p) {
      Field q = Zero();
      points.AddProduct(tangent, 1, p, q);
      return q;
    };
    const Field a = Random(1), b = Random(1), Ha = times(a), Hb = times(b);
    EXPECT_NEAR(Inner(a, Hb), Inner(b, Ha), 1e-11 * std::abs(Inner(a, Ha)));
    EXPECT_GT(Inner(a, Ha), 0);

    BlockField blocks(x.size());
    points.AddDiagonal(tangent, 1, blocks);
    for (int j : {0, 7, 31}) {
      Field p = Zero();
      p[j].y = 1;
      const Field q = times(p);
      EXPECT_NEAR(q[j].y, blocks[j].yy, 1e-11 * blocks[j].yy);
      EXPECT_NEAR(q[j].x, blocks[j].xy, 1e-11 * blocks[j].yy);
      EXPECT_NEAR(q[j].z, blocks[j].yz, 1e-11 * blocks[j].yy);
    }

    CoarseMatrix coarse;
    coarse.Build(tissue_, std::vector<double>(x.size(), 1), 4);
    coarse.Clear();
    points.AddCoarse(tangent, 1, coarse);
    // Z^T H Z e_u for some unknowns u against the column of the matrix.
    const Aggregates& aggregates = coarse.aggregates();
    ASSERT_GT(aggregates.count(), 1);
    int inside = 0, shared = 0;  // points: the two kinds go different ways into the matrix
    for (int n = 0; n < aggregates.count(); ++n) {
      inside += coarse.points_inside_end(n) - coarse.points_begin(n);
      shared += coarse.points_begin(n + 1) - coarse.points_inside_end(n);
    }
    EXPECT_GT(inside, 0);
    EXPECT_GT(shared, 0);
    for (int unknown : {0, 5, 13, coarse.size() - 1}) {
      Field p = Zero();
      for (std::size_t j = 0; j < x.size(); ++j) {
        if (aggregates.of_particle[j] != unknown / 12) continue;
        const double value = (&aggregates.basis[j].x)[unknown % 12 / 3];
        (&p[j].x)[unknown % 3] = value;
      }
      const Field q = times(p);
      std::vector<double> column(coarse.size());
      for (std::size_t j = 0; j < x.size(); ++j) {
        for (int i = 0; i < 12; ++i) {
          column[12 * aggregates.of_particle[j] + i] += (&aggregates.basis[j].x)[i / 3] * (&q[j].x)[i % 3];
        }
      }
      for (int row = unknown; row < coarse.size(); ++row) {
        const bool is_coupled = coarse.first_coupled(row / 12) <= unknown / 12;
        EXPECT_NEAR(column[row], is_coupled ? coarse.At(row, unknown) : 0, 1e-11 * coarse.At(unknown, unknown));
      }
    }
  }
}

TEST_P(ElasticPointsTest, ProductInSinglePrecisionDiffersByRounding) {
  for (MaterialModel model : kModels) {
    ElasticPoints points({model, 1e4, 0.45, 1000}, pool_);
    points.TissueChanged(tissue_);
    const Field x = Sum(Positions(Eigen::Matrix3d::Identity()), Random(1), 1e-3), p = Random(1);
    PointTangent tangent;
    SinglePointTangent single_tangent;
    points.Resize(tangent);
    points.Resize(single_tangent);
    points.Linearise(x, true, tangent);
    points.Linearise(x, true, single_tangent);
    Field q = Zero();
    points.AddProduct(tangent, 2, p, q);
    const int count = static_cast<int>(x.size());
    SingleField single_p(count), single_q(count);
    std::transform(p.begin(), p.end(), single_p.begin(), Round);
    const std::vector<double> free(count, 1), inertia(count, 3);
    points.ProductInSlots(single_tangent, single_p);
    double size = 0, difference = 0, dot = 0;
    for (int c = 0; c < ChunkCount(count, kParticlesPerChunk); ++c) {
      dot += GatherProduct(ParticleRange(c, count), points.single_slot_sums(), 2, free.data(), inertia.data(),
                           single_p.data(), single_q.data());
    }
    for (int j = 0; j < count; ++j) {
      const Vector4 expected = q[j] + 3 * p[j], error = expected - Widen(single_q[j]);
      size += Dot(expected, expected);
      difference += Dot(error, error);
    }
    EXPECT_LT(std::sqrt(difference), 1e-6 * std::sqrt(size));
    EXPECT_NEAR(dot, Inner(p, Sum(q, p, 3)), 1e-6 * dot);

    BlockField blocks(count), single_blocks(count);
    points.AddDiagonal(tangent, 1, blocks);
    points.AddDiagonal(single_tangent, 1, single_blocks);
    for (int j = 0; j < count; ++j) EXPECT_NEAR(blocks[j].yy, single_blocks[j].yy, 1e-6 * blocks[j].yy);
  }
}

INSTANTIATE_TEST_SUITE_P(AllShapes, ElasticPointsTest,
                         testing::Values(SupportShape::kBoxCentre, SupportShape::kBox, SupportShape::kGeneral));

/// Every processor gives the same bits.
TEST(PointKernels, InstructionSetsAgreeToTheBit) {
  std::vector<const PointKernelTable*> tables{&kPointKernelsBaseline};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) tables.push_back(&kPointKernelsAvx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) tables.push_back(&kPointKernelsAvx512);
#endif
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int shape = 0; shape < kSupportShapes; ++shape) {
    const Tissue tissue = MakeTissue(static_cast<SupportShape>(shape));
    PointGroups groups;
    groups.Build(tissue, {1e3});
    Field x;
    for (const Eigen::Vector3d& X : tissue.particle_rest) {
      x.push_back(Vector4::From(X + 1e-3 * Eigen::Vector3d(uniform(generator), uniform(generator), uniform(generator))));
    }
    for (int model = 0; model < 4; ++model) {
      Field first;
      SingleField first_single;
      double first_energy = 0, first_damped_energy = 0;
      std::array<double, 81 + 4 * 9 * 4> first_coarse{};
      for (const PointKernelTable* table : tables) {
        const PointKernels& kernels = (*table)[model][shape];
        Field slots(3 * groups.slot_count);
        KernelArguments arguments;
        arguments.group = &groups.groups[shape];
        arguments.chunk = groups.chunks[0];
        arguments.slot_count = groups.slot_count;
        arguments.slot_particle = groups.slot_particle.data();
        arguments.lame = LameConstantsOf({kModels[model], 1e4, 0.45, 1000});
        arguments.field = x.data();
        AlignedVector<double> tangent(arguments.group->batches * kernels.tangent_size * kLanes);
        arguments.tangent = tangent.data();
        arguments.slots = slots.data();
        const double energy = kernels.evaluate(arguments);
        kernels.linearise(arguments);
        arguments.slots = slots.data() + groups.slot_count;
        kernels.product(arguments);
        const Field d(x.rbegin(), x.rend());
        arguments.slots = slots.data() + 2 * groups.slot_count;
        arguments.still = d.data();
        arguments.damping = 0.3;
        const double damped_energy = kernels.evaluate_damped(arguments);
        std::array<double, 81 + 4 * 9 * 4> coarse{};  // a sum of tensors, then the blocks of one point
        kernels.add_tensors(arguments, groups.places.data(), 11, reinterpret_cast<double(*)[9]>(coarse.data()));
        const double g[3][4] = {{1, 0, 2, -1}, {0.5, 3, 0, 1}, {0, 0.1, 1, 1}};
        kernels.blocks(arguments, groups.places[3], g, g, reinterpret_cast<double(*)[9][4]>(coarse.data() + 81));
        SingleField single_d(d.size()), single_slots(groups.slot_count);
        std::transform(d.begin(), d.end(), single_d.begin(), Round);
        AlignedVector<float> single_tangent(tangent.size());
        arguments.tangent = nullptr;
        arguments.single_tangent = single_tangent.data();
        arguments.single_field = single_d.data();
        arguments.single_slots = single_slots.data();
        kernels.linearise(arguments);
        kernels.single_product(arguments);
        if (first.empty()) {
          first = slots;
          first_single = single_slots;
          first_energy = energy;
          first_damped_energy = damped_energy;
          first_coarse = coarse;
        }
        EXPECT_EQ(std::memcmp(coarse.data(), first_coarse.data(), sizeof(coarse)), 0);
        EXPECT_EQ(std::memcmp(single_slots.data(), first_single.data(), groups.slot_count * sizeof(SingleVector4)), 0);
        EXPECT_EQ(energy, first_energy);
        EXPECT_EQ(damped_energy, first_damped_energy);
        EXPECT_EQ(std::memcmp(slots.data(), first.data(), 3 * groups.slot_count * sizeof(Vector4)), 0);
      }
    }
  }
}

}  // namespace
}  // namespace meshless_cutting
