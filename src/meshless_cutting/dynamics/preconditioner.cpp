#include "dynamics/preconditioner.h"

#include <algorithm>
#include <numeric>

#include "dynamics/field_loops.h"

namespace meshless_cutting {
namespace {

/// The coarse space has at most so many aggregates, and at least so many particles in each.
constexpr int kAggregates = 40;
constexpr int kParticlesPerAggregate = 24;

/// The diagonal serves for so many solves: it is as dear as three products.
constexpr int kRefreshEvery = 6;

/// The coarse matrix is made again when a solve takes kAgeing times the iterations that it took when the matrix was
/// new, and it has served for so many solves that making it has paid, or when a solve takes kUseless times as many.
constexpr double kAgeing = 1.5, kUseless = 4;
constexpr int kLeastSolves = 8;

/// Aggregates from before a cut are made again after so many solves in any case.
constexpr int kMostSolves = 60;

SingleBlock InverseOf(const SymmetricBlock& b) {
  const double cxx = b.yy * b.zz - b.yz * b.yz, cxy = b.xz * b.yz - b.xy * b.zz, cxz = b.xy * b.yz - b.xz * b.yy;
  const double det = b.xx * cxx + b.xy * cxy + b.xz * cxz;
  if (!(det > 1e-12 * b.xx * b.yy * b.zz)) {  // rounding has eaten a direction: the diagonal alone still scales
    return {Round({1 / b.xx, 0, 0, 0}), Round({0, 1 / b.yy, 0, 0}), Round({0, 0, 1 / b.zz, 0})};
  }
  const double xy = cxy / det, xz = cxz / det, yz = (b.xy * b.xz - b.xx * b.yz) / det;
  return {Round({cxx / det, xy, xz, 0}), Round({xy, (b.xx * b.zz - b.xz * b.xz) / det, yz, 0}),
          Round({xz, yz, (b.xx * b.yy - b.xy * b.xy) / det, 0})};
}

}  // namespace

void Preconditioner::TissueChanged(const Tissue& tissue, const IncrementalPotential& potential) {
  const std::size_t particles = tissue.particle_count(), known = inverse_.size();
  is_due_ = true;
  ResizeWithRoom(diagonal_, particles);
  ResizeWithRoom(inverse_, particles);
  ResizeWithRoom(scaled_, particles);
  chunk_sums_.resize(ChunkCount(tissue.particle_count(), kParticlesPerChunk));
  if (known == 0 || particles < known) {
    BuildCoarse(tissue, potential);
    return;
  }
  coarse_.Extend(tissue, potential.free);
  PrepareTransfer();
  tissue_changed_ = true;
}

void Preconditioner::BeginStep(const Tissue& tissue, const IncrementalPotential& potential) {
  if (tissue_changed_ && (coarse_is_stale_ || solves_ >= kMostSolves)) BuildCoarse(tissue, potential);
}

void Preconditioner::BuildCoarse(const Tissue& tissue, const IncrementalPotential& potential) {
  coarse_.Build(tissue, potential.free, std::min(kAggregates, tissue.particle_count() / kParticlesPerAggregate));
  PrepareTransfer();
  coarse_vector_.resize(static_cast<std::size_t>(coarse_.aggregates().count()) * CoarseMatrix::kFunctions);
  coarse_unknowns_.resize(coarse_.size());
  tissue_changed_ = false;
  coarse_is_stale_ = is_due_ = true;
}

void Preconditioner::PrepareTransfer() {
  const Aggregates& aggregates = coarse_.aggregates();
  ResizeWithRoom(basis_, aggregates.basis.size());
  std::transform(aggregates.basis.begin(), aggregates.basis.end(), basis_.begin(), Round);
  runs_.clear();
  for (int a = 0; a < aggregates.count(); ++a) {
    for (int i = aggregates.begin[a]; i < aggregates.begin[a + 1]; ++i) {
      const int chunk = aggregates.particles[i] / kParticlesPerChunk;
      if (i == aggregates.begin[a] || runs_.back().chunk != chunk) runs_.push_back({chunk, a, i, i});
      ++runs_.back().end;
    }
  }
  std::sort(runs_.begin(), runs_.end(), [](const Run& x, const Run& y) {
    return x.chunk != y.chunk ? x.chunk < y.chunk : x.aggregate < y.aggregate;
  });
  run_begin_.assign(chunk_sums_.size() + 1, 0);
  for (const Run& run : runs_) ++run_begin_[run.chunk + 1];
  std::partial_sum(run_begin_.begin(), run_begin_.end(), run_begin_.begin());
  run_sums_.resize(runs_.size() * CoarseMatrix::kFunctions);
}

void Preconditioner::RefreshCoarse(IncrementalPotential& potential) {
  potential.Coarse(coarse_);
  coarse_.Factor();
  coarse_is_stale_ = false;
  coarse_is_new_ = true;
  solves_ = 0;
}

void Preconditioner::ReportIterations(double per_decade) {
  ++solves_;
  is_due_ = ++solves_since_refresh_ >= kRefreshEvery;
  if (coarse_is_new_) {
    iterations_when_new_ = per_decade;
    coarse_is_new_ = false;
  } else if ((solves_ >= kLeastSolves && per_decade > kAgeing * iterations_when_new_ + 1) ||
             per_decade > kUseless * iterations_when_new_ + 1) {
    coarse_is_stale_ = true;
  }
}

void Preconditioner::Refresh(IncrementalPotential& potential) {
  is_due_ = false;
  solves_since_refresh_ = 0;
  // Since a cut the matrix has a shape that the points no longer fit: it serves until the next step.
  if (coarse_is_stale_ && !tissue_changed_) RefreshCoarse(potential);
  potential.Diagonal(diagonal_);
  potential.pool().ForEach(ChunkCount(potential.size(), kParticlesPerChunk), [&](int c) {
    const ParticleRange range(c, potential.size());
    for (int j = range.begin; j < range.end; ++j) {
      inverse_[j] = potential.free[j] > 0 ? InverseOf(diagonal_[j]) : SingleBlock();
    }
  });
}

double Preconditioner::AdvanceSolution(int chunk, double alpha, const SingleField& direction, const SingleField& product,
                                       const std::vector<double>& weight, SingleField& step, SingleField& r) {
  const SolutionSums sums = meshless_cutting::AdvanceSolution(
      ParticleRange(chunk, static_cast<int>(r.size())), alpha, direction.data(), product.data(), weight.data(),
      inverse_.data(), step.data(), r.data(), scaled_.data());
  chunk_sums_[chunk] = sums.scaled;
  const std::vector<int>& particles = coarse_.aggregates().particles;
  for (int n = run_begin_[chunk]; n < run_begin_[chunk + 1]; ++n) {
    const Run& run = runs_[n];
    Restrict(&particles[run.begin], run.end - run.begin, basis_.data(), r.data(),
             &run_sums_[static_cast<std::size_t>(n) * CoarseMatrix::kFunctions]);
  }
  return sums.residual;
}

double Preconditioner::SolveCoarse() {
  constexpr int kFunctions = CoarseMatrix::kFunctions;
  std::fill(coarse_vector_.begin(), coarse_vector_.end(), SingleVector4());
  for (std::size_t n = 0; n < runs_.size(); ++n) {
    for (int c = 0; c < kFunctions; ++c) coarse_vector_[kFunctions * runs_[n].aggregate + c] += run_sums_[kFunctions * n + c];
  }
  for (std::size_t n = 0; n < coarse_vector_.size(); ++n) {
    for (int i = 0; i < 3; ++i) coarse_unknowns_[3 * n + i] = (&coarse_vector_[n].x)[i];
  }
  coarse_.Solve(coarse_unknowns_.data());
  double sum = 0;
  for (std::size_t n = 0; n < coarse_vector_.size(); ++n) {
    const float* u = &coarse_unknowns_[3 * n];
    const SingleVector4 solution = {u[0], u[1], u[2], 0};
    sum += Dot(coarse_vector_[n], solution);
    coarse_vector_[n] = solution;
  }
  for (double s : chunk_sums_) sum += s;
  return sum;
}

void Preconditioner::AdvanceDirection(int chunk, double beta, SingleField& direction) const {
  NextDirection(ParticleRange(chunk, static_cast<int>(direction.size())), beta, scaled_.data(),
                coarse_.aggregates().of_particle.data(), basis_.data(), coarse_vector_.data(), direction.data());
}

}  // namespace meshless_cutting
