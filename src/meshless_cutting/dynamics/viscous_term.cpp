#include "dynamics/viscous_term.h"

#include <algorithm>
#include <cmath>

#include "dynamics/field_loops.h"
#include "tissue/materials.h"

namespace meshless_cutting {
namespace {

[[maybe_unused]] double Log(double x) { return std::log(x); }
double Sqrt(double x) { return std::sqrt(x); }

#include "tissue/material_laws.inl"

/// Points that one task of a parallel loop takes. Fixed, so that sums do not depend on the number of threads.
constexpr int kPointsPerChunk = 64;

/// Strains below this are as good as relaxed.
constexpr double kRelaxedStrain = 1e-6;

/// (1 - exp(-x)) / x.
double MeanOfDecay(double x) { return x > 1e-9 ? -std::expm1(-x) / x : 1; }

double Square(const double* q) {
  return (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]) + 2 * (q[3] * q[3] + q[4] * q[4] + q[5] * q[5]);
}

}  // namespace

ViscousTerm::ViscousTerm(const std::vector<MaterialConfig>& materials, ThreadPool& pool) : pool_(pool) {
  for (const MaterialConfig& material : materials) {
    Series& series = series_.emplace_back();
    series.mu = LameConstantsOf(material).mu;
    double sum = 0;
    for (const PronyBranch& branch : material.prony) {
      series.branches.push_back({branch.modulus_ratio, branch.relaxation_time_s});
      sum += branch.modulus_ratio;
    }
    instantaneous_shear_ = std::max(instantaneous_shear_, series.mu * sum);
    factors_.emplace_back(series.branches.size());
  }
  gain_.resize(series_.size());
}

bool ViscousTerm::IsNeeded(const std::vector<MaterialConfig>& materials) {
  return std::any_of(materials.begin(), materials.end(), [](const MaterialConfig& m) { return !m.prony.empty(); });
}

void ViscousTerm::TissueChanged(const Tissue& tissue) {
  const int known = branch_begin_.empty() ? 0 : static_cast<int>(branch_begin_.size()) - 1;
  if (known == 0) branch_begin_.assign(1, 0);
  for (int p = known; p < tissue.point_count(); ++p) {
    const std::size_t first = strain_.size(), count = series_[tissue.material(p)].branches.size();
    strain_.resize(first + count);
    branch_begin_.push_back(strain_.size());
    const int origin = tissue.origin(p);
    if (origin < 0) continue;
    for (std::size_t i = 0; i < count; ++i) strain_[first + i] = strain_[branch_begin_[origin] + i];
  }

  support_ = tissue.support_size;
  points_.clear();
  particle_.clear();
  gradient_.clear();
  for (int p = 0; p < tissue.point_count(); ++p) {
    if (series_[tissue.material(p)].branches.empty()) continue;
    points_.push_back({p, tissue.material(p), tissue.point_volume[p]});
    for (int k = 0; k < support_; ++k) {
      const std::size_t entry = static_cast<std::size_t>(p) * support_ + k;
      particle_.push_back(tissue.point_particles[entry]);
      gradient_.push_back(Vector4::From(tissue.point_gradients[entry]));
    }
  }
  kept_ = strain_;
  slots_.resize(particle_.size());
  start_.resize(points_.size());
  history_.resize(points_.size());
  tangent_.resize(points_.size());
  chunk_energy_.resize(ChunkCount(static_cast<int>(points_.size()), kPointsPerChunk));
  begin_.assign(tissue.particle_count() + 1, 0);
  for (int j : particle_) ++begin_[j + 1];
  for (int j = 0; j < tissue.particle_count(); ++j) begin_[j + 1] += begin_[j];
  at_.resize(particle_.size());
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t entry = 0; entry < particle_.size(); ++entry) at_[next[particle_[entry]]++] = static_cast<int>(entry);
}

template <class Task>
void ViscousTerm::ForEachPoint(const Task& task) {
  const int count = static_cast<int>(points_.size());
  pool_.ForEach(static_cast<int>(chunk_energy_.size()), [&](int c) {
    double energy = 0;
    for (int n = c * kPointsPerChunk; n < std::min(count, (c + 1) * kPointsPerChunk); ++n) energy += task(n);
    chunk_energy_[c] = energy;
  });
}

double ViscousTerm::SumOfChunks() const {
  double sum = 0;
  for (double energy : chunk_energy_) sum += energy;
  return sum;
}

void ViscousTerm::Gradient(int n, const Field& x, double* F) const {
  std::fill(F, F + 9, 0.0);
  for (int entry = n * support_; entry < (n + 1) * support_; ++entry) {
    const Vector4 &y = x[particle_[entry]], &g = gradient_[entry];
    F[0] += y.x * g.x, F[1] += y.x * g.y, F[2] += y.x * g.z;
    F[3] += y.y * g.x, F[4] += y.y * g.y, F[5] += y.y * g.z;
    F[6] += y.z * g.x, F[7] += y.z * g.y, F[8] += y.z * g.z;
  }
}

ViscousTerm::Strain ViscousTerm::DeviatoricStrain(int n, const Field& x) const {
  double F[9];
  Gradient(n, x, F);
  Strain D;
  StVenantKirchhoffLaw(0.5, -1.0 / 3).SecondPiola(F, D.value);  // 2 mu E + lambda tr(E) I
  return D;
}

void ViscousTerm::Scatter(int n, const double* P) {
  for (int entry = n * support_; entry < (n + 1) * support_; ++entry) {
    const Vector4& g = gradient_[entry];
    slots_[entry] = {P[0] * g.x + P[1] * g.y + P[2] * g.z, P[3] * g.x + P[4] * g.y + P[5] * g.z,
                     P[6] * g.x + P[7] * g.y + P[8] * g.z, 0};
  }
}

void ViscousTerm::Gather(Field& to) {
  const int count = static_cast<int>(to.size());
  pool_.ForEach(ChunkCount(count, kParticlesPerChunk), [&](int c) {
    const ParticleRange range(c, count);
    for (int j = range.begin; j < range.end; ++j) {
      for (int i = begin_[j]; i < begin_[j + 1]; ++i) to[j] += slots_[at_[i]];
    }
  });
}

bool ViscousTerm::IsRelaxed() const {
  return std::all_of(strain_.begin(), strain_.end(),
                     [](const Strain& q) { return Square(q.value) <= kRelaxedStrain * kRelaxedStrain; });
}

double ViscousTerm::StoredEnergy() const {
  double energy = 0;
  for (const Point& point : points_) {
    const Series& series = series_[point.material];
    for (std::size_t i = 0; i < series.branches.size(); ++i) {
      energy += point.volume * series.mu * series.branches[i].ratio * Square(strain_[branch_begin_[point.index] + i].value);
    }
  }
  return energy;
}

double ViscousTerm::StoredEnergyAt(const Field& x) const {
  double energy = 0;
  for (std::size_t n = 0; n < points_.size(); ++n) {
    const Series& series = series_[points_[n].material];
    const Strain D = DeviatoricStrain(static_cast<int>(n), x);
    for (std::size_t i = 0; i < series.branches.size(); ++i) {
      const Factors& f = factors_[points_[n].material][i];
      const Strain& q = strain_[branch_begin_[points_[n].index] + i];
      double end[6];
      for (int a = 0; a < 6; ++a) end[a] = f.keep * q.value[a] + f.gain * (D.value[a] - start_[n].value[a]);
      energy += points_[n].volume * series.mu * series.branches[i].ratio * Square(end);
    }
  }
  return energy;
}

void ViscousTerm::AddForce(const Field& x, Field& gradient) {
  ForEachPoint([&](int n) {
    const Series& series = series_[points_[n].material];
    double F[9], P[9], S[6] = {};
    for (std::size_t i = 0; i < series.branches.size(); ++i) {
      const double stiffness = 2 * points_[n].volume * series.mu * series.branches[i].ratio;
      for (int a = 0; a < 6; ++a) S[a] += stiffness * strain_[branch_begin_[points_[n].index] + i].value[a];
    }
    Gradient(n, x, F);
    StVenantKirchhoffLaw::TimesSymmetric(F, S, P);
    Scatter(n, P);
    return 0.0;
  });
  Gather(gradient);
}

void ViscousTerm::BeginStep(const StageMotion& motion) {
  motion_ = motion;
  for (std::size_t m = 0; m < series_.size(); ++m) {
    gain_[m] = 0;
    for (std::size_t i = 0; i < series_[m].branches.size(); ++i) {
      const Branch& branch = series_[m].branches[i];
      const double x = motion.elapsed_s / branch.time_s, at_stage = motion.stage * x;
      factors_[m][i] = {std::exp(-x), MeanOfDecay(x), std::exp(-at_stage), MeanOfDecay(at_stage)};
      gain_[m] += branch.ratio * factors_[m][i].gain_at_stage;
    }
  }
  ForEachPoint([&](int n) {
    const Point& point = points_[n];
    if (!motion.is_made) start_[n] = DeviatoricStrain(n, *motion.start);
    Strain& B = history_[n] = Strain();
    for (std::size_t i = 0; i < factors_[point.material].size(); ++i) {
      const Factors& f = factors_[point.material][i];
      const Strain& q = strain_[branch_begin_[point.index] + i];
      const double ratio = series_[point.material].branches[i].ratio;
      for (int a = 0; a < 6; ++a) {
        B.value[a] += ratio * (f.keep_at_stage * q.value[a] - f.gain_at_stage * start_[n].value[a]);
      }
    }
    return 0.0;
  });
}

double ViscousTerm::Evaluate(const Field& y, Field& gradient) {
  ForEachPoint([&](int n) {
    const Point& point = points_[n];
    const double mu = series_[point.material].mu * point.volume, gain = gain_[point.material];
    const Strain& B = history_[n];
    double F[9], P[9], D[6], S[6];
    Gradient(n, y, F);
    StVenantKirchhoffLaw(0.5, -1.0 / 3).SecondPiola(F, D);
    double mixed = 0;
    for (int a = 0; a < 6; ++a) {
      S[a] = 2 * mu * (gain * D[a] + B.value[a]);
      mixed += (a < 3 ? 1 : 2) * B.value[a] * D[a];
    }
    StVenantKirchhoffLaw::TimesSymmetric(F, S, P);
    Scatter(n, P);
    return mu * (gain * Square(D) + 2 * mixed);
  });
  Gather(gradient);
  return SumOfChunks();
}

void ViscousTerm::Linearise(const Field& y) {
  ForEachPoint([&](int n) {
    const Point& point = points_[n];
    const double mu = series_[point.material].mu * point.volume;
    double F[9], *s = tangent_[n].data;
    Gradient(n, y, F);
    StVenantKirchhoffLaw(mu * gain_[point.material], -2.0 / 3 * mu * gain_[point.material]).Linearise(F, s, false);
    double* S = s + 9;
    for (int a = 0; a < 6; ++a) S[a] += 2 * mu * history_[n].value[a];
    // Lifted by its most negative eigenvalue (bounded by Samuelson's inequality) where there is one.
    const double mean = (S[0] + S[1] + S[2]) / 3;
    const double deviator[6] = {S[0] - mean, S[1] - mean, S[2] - mean, S[3], S[4], S[5]};
    const double lift = std::max(0.0, std::sqrt(2.0 / 3 * Square(deviator)) - mean);
    for (int a = 0; a < 3; ++a) S[a] += lift;
    return 0.0;
  });
}

void ViscousTerm::AddProduct(const Field& p, Field& q) {
  ForEachPoint([&](int n) {
    const double mu = series_[points_[n].material].mu * points_[n].volume * gain_[points_[n].material];
    double dF[9], dP[9];
    Gradient(n, p, dF);
    StVenantKirchhoffLaw(mu, -2.0 / 3 * mu).Differential(tangent_[n].data, dF, dP);
    Scatter(n, dP);
    return 0.0;
  });
  Gather(q);
}

void ViscousTerm::AddDiagonal(BlockField& blocks) {
  const int count = static_cast<int>(blocks.size());
  pool_.ForEach(ChunkCount(count, kParticlesPerChunk), [&](int c) {
    const ParticleRange range(c, count);
    for (int j = range.begin; j < range.end; ++j) {
      for (int i = begin_[j]; i < begin_[j + 1]; ++i) {
        const int n = at_[i] / support_;
        const double mu = series_[points_[n].material].mu * points_[n].volume * gain_[points_[n].material];
        const Vector4& v = gradient_[at_[i]];
        const double g[3] = {v.x, v.y, v.z};
        double block[9];
        StVenantKirchhoffLaw(mu, -2.0 / 3 * mu).Block(tangent_[n].data, g, g, block);
        SymmetricBlock& to = blocks[j];
        to.xx += block[0], to.yy += block[4], to.zz += block[8];
        to.xy += block[1], to.xz += block[2], to.yz += block[5];
      }
    }
  });
}

void ViscousTerm::EndStep(const Field& y) {
  // The end of the step lies beyond the stage, on the same straight line.
  const double share = 1 / motion_.stage;
  const Field& x0 = *motion_.start;
  ForEachPoint([&](int n) {
    const Point& point = points_[n];
    double F0[9], F[9];
    Gradient(n, x0, F0);
    Gradient(n, y, F);
    for (int i = 0; i < 9; ++i) F[i] = F0[i] + share * (F[i] - F0[i]);
    Strain end;
    const double* D = end.value;
    StVenantKirchhoffLaw(0.5, -1.0 / 3).SecondPiola(F, end.value);
    for (std::size_t i = 0; i < factors_[point.material].size(); ++i) {
      const Factors& f = factors_[point.material][i];
      Strain& q = strain_[branch_begin_[point.index] + i];
      for (int a = 0; a < 6; ++a) q.value[a] = f.keep * q.value[a] + f.gain * (D[a] - start_[n].value[a]);
    }
    start_[n] = end;
    return 0.0;
  });
}

}  // namespace meshless_cutting
