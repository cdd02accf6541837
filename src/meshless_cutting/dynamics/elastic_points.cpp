#include "dynamics/elastic_points.h"

#include <algorithm>

#include "dynamics/coarse_point.h"
#include "dynamics/field_loops.h"

namespace meshless_cutting {

ElasticPoints::ElasticPoints(const std::vector<MaterialConfig>& materials, double stabilisation, ThreadPool& pool)
    : pool_(pool) {
  for (const MaterialConfig& material : materials) {
    lame_.push_back(LameConstantsOf(material));
    stabilisation_.push_back(stabilisation * lame_.back().mu);
    stiffest_.mu = std::max(stiffest_.mu, lame_.back().mu);
    stiffest_.lambda = std::max(stiffest_.lambda, lame_.back().lambda);
    for (int shape = 0; shape < kSupportShapes; ++shape) {
      kernels_.push_back(SelectPointKernels(material.model, static_cast<SupportShape>(shape)));
    }
  }
}

void ElasticPoints::TissueChanged(const Tissue& tissue) {
  groups_.Build(tissue, stabilisation_);
  particles_ = tissue.particle_count();
  chunk_energy_.resize(groups_.chunks.size());
  slots_.resize(std::size_t{2} * groups_.slot_count);  // the diagonal takes two
}

KernelArguments ElasticPoints::Arguments(const PointChunk& chunk, const Field& field, const PointTangent* tangent) {
  KernelArguments arguments;
  arguments.group = &groups_.groups[chunk.group];
  arguments.chunk = chunk;
  arguments.lame = lame_[arguments.group->material];
  arguments.field = field.data();
  arguments.slots = slots_.data();
  arguments.slot_count = groups_.slot_count;
  // Only Linearise writes to it, and its caller's is not const.
  if (tangent != nullptr) arguments.tangent = const_cast<double*>(tangent->groups[chunk.group].data());
  return arguments;
}

void ElasticPoints::Gather(int chunk, const Vector4* buffer, double factor, Vector4* to) const {
  GatherSlots(ParticleRange(chunk, particles_), buffer, groups_.slot_begin.data(), groups_.slots.data(), factor, to);
}

double ElasticPoints::EvaluateInSlots(const Field& x) {
  pool_.ForEach(static_cast<int>(groups_.chunks.size()), [&](int c) {
    chunk_energy_[c] = kernels_[groups_.chunks[c].group].evaluate(Arguments(groups_.chunks[c], x, nullptr));
  });
  double energy = 0;
  for (double e : chunk_energy_) energy += e;
  return energy;
}

double ElasticPoints::Evaluate(const Field& x, Field& gradient) {
  const double energy = EvaluateInSlots(x);
  pool_.ForEach(ChunkCount(particles_, kParticlesPerChunk),
                [&](int c) { Gather(c, slots_.data(), 1, &gradient[c * kParticlesPerChunk]); });
  return energy;
}

void ElasticPoints::Resize(PointTangent& tangent) const {
  tangent.groups.resize(groups_.groups.size());
  for (std::size_t g = 0; g < groups_.groups.size(); ++g) {
    tangent.groups[g].resize(static_cast<std::size_t>(groups_.groups[g].batches) * kernels_[g].tangent_size * kLanes);
  }
}

void ElasticPoints::Linearise(const Field& x, bool filtered, PointTangent& tangent) {
  pool_.ForEach(static_cast<int>(groups_.chunks.size()), [&](int c) {
    KernelArguments arguments = Arguments(groups_.chunks[c], x, &tangent);
    arguments.filtered = filtered;
    kernels_[groups_.chunks[c].group].linearise(arguments);
  });
}

void ElasticPoints::ProductInSlots(const PointTangent& tangent, const Field& p) {
  pool_.ForEach(static_cast<int>(groups_.chunks.size()),
                [&](int c) { kernels_[groups_.chunks[c].group].product(Arguments(groups_.chunks[c], p, &tangent)); });
}

void ElasticPoints::AddProduct(const PointTangent& tangent, double factor, const Field& p, Field& q) {
  ProductInSlots(tangent, p);
  pool_.ForEach(ChunkCount(particles_, kParticlesPerChunk),
                [&](int c) { Gather(c, slots_.data(), factor, &q[c * kParticlesPerChunk]); });
}

void ElasticPoints::AddDiagonal(const PointTangent& tangent, double factor, BlockField& blocks) {
  static const Field kNone;
  pool_.ForEach(static_cast<int>(groups_.chunks.size()), [&](int c) {
    kernels_[groups_.chunks[c].group].diagonal(Arguments(groups_.chunks[c], kNone, &tangent));
  });
  pool_.ForEach(ChunkCount(particles_, kParticlesPerChunk), [&](int c) {
    Vector4 diagonal[kParticlesPerChunk], off_diagonal[kParticlesPerChunk];
    const ParticleRange range(c, particles_);
    Gather(c, slots_.data(), factor, diagonal);
    Gather(c, slots_.data() + groups_.slot_count, factor, off_diagonal);
    for (int j = range.begin; j < range.end; ++j) {
      const Vector4 &d = diagonal[j - range.begin], &o = off_diagonal[j - range.begin];
      blocks[j].xx += d.x;
      blocks[j].yy += d.y;
      blocks[j].zz += d.z;
      blocks[j].xy += o.x;
      blocks[j].xz += o.y;
      blocks[j].yz += o.z;
    }
  });
}

void ElasticPoints::AddCoarse(const PointTangent& tangent, double factor, CoarseMatrix& matrix) {
  static const Field kNone;
  pool_.ForEach(matrix.aggregates().count(), [&](int a) {
    for (int n = matrix.points_begin(a); n < matrix.points_begin(a + 1); ++n) {
      const PointPlace& place = groups_.places[matrix.points()[n]];
      PointChunk group_only{};
      group_only.group = place.group;
      AddCoarseOfPoint(kernels_[place.group], Arguments(group_only, kNone, &tangent), place, factor, a, matrix);
    }
  });
}

}  // namespace meshless_cutting
