#include "dynamics/elastic_points.h"

#include <algorithm>
#include <type_traits>

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
  ResizeWithRoom(slots_, std::size_t{2} * groups_.slot_count);  // the diagonal takes two
  ResizeWithRoom(single_slots_, groups_.slot_count);
  slots_[groups_.slot_count - 1] = slots_.back() = Vector4();
  single_slots_.back() = SingleVector4();
}

KernelArguments ElasticPoints::Arguments(const PointChunk& chunk) {
  KernelArguments arguments;
  arguments.group = &groups_.groups[chunk.group];
  arguments.chunk = chunk;
  arguments.lame = lame_[arguments.group->material];
  arguments.slots = slots_.data();
  arguments.single_slots = single_slots_.data();
  arguments.slot_count = groups_.slot_count;
  arguments.slot_particle = groups_.slot_particle.data();
  return arguments;
}

template <class Tangent>
KernelArguments ElasticPoints::Arguments(const PointChunk& chunk, const Tangent& tangent) {
  KernelArguments arguments = Arguments(chunk);
  // Only Linearise writes to it, and its caller's is not const.
  auto* numbers = const_cast<Tangent&>(tangent).groups[chunk.group].data();
  if constexpr (std::is_same_v<Tangent, PointTangent>) {
    arguments.tangent = numbers;
  } else {
    arguments.single_tangent = numbers;
  }
  return arguments;
}

void ElasticPoints::Gather(int chunk, Vector4* buffer, double factor, Vector4* to) const {
  GatherSlots(ParticleRange(chunk, particles_), {buffer, groups_}, factor, to);
}

double ElasticPoints::EvaluateInSlots(const Field& x) {
  pool_.ForEach(static_cast<int>(groups_.chunks.size()), [&](int c) {
    KernelArguments arguments = Arguments(groups_.chunks[c]);
    arguments.field = x.data();
    chunk_energy_[c] = kernels_[groups_.chunks[c].group].evaluate(arguments);
  });
  return SumOfEnergies();
}

double ElasticPoints::EvaluateInSlots(const Field& x, const PointDamping& damping) {
  pool_.ForEach(static_cast<int>(groups_.chunks.size()), [&](int c) {
    KernelArguments arguments = Arguments(groups_.chunks[c], *damping.tangent);
    arguments.field = x.data();
    arguments.still = damping.still->data();
    arguments.damping = damping.damping;
    chunk_energy_[c] = kernels_[groups_.chunks[c].group].evaluate_damped(arguments);
  });
  return SumOfEnergies();
}

double ElasticPoints::SumOfEnergies() const {
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

template <class Tangent>
void ElasticPoints::Resize(Tangent& tangent) const {
  tangent.groups.resize(groups_.groups.size());
  for (std::size_t g = 0; g < groups_.groups.size(); ++g) {
    ResizeWithRoom(tangent.groups[g], static_cast<std::size_t>(groups_.groups[g].batches) * kernels_[g].tangent_size * kLanes);
  }
}

template <class Tangent>
void ElasticPoints::Linearise(const Field& x, bool filtered, Tangent& tangent) {
  pool_.ForEach(static_cast<int>(groups_.chunks.size()), [&](int c) {
    KernelArguments arguments = Arguments(groups_.chunks[c], tangent);
    arguments.field = x.data();
    arguments.filtered = filtered;
    kernels_[groups_.chunks[c].group].linearise(arguments);
  });
}

void ElasticPoints::ProductInSlots(const PointTangent& tangent, const Field& p) {
  pool_.ForEach(static_cast<int>(groups_.chunks.size()), [&](int c) {
    KernelArguments arguments = Arguments(groups_.chunks[c], tangent);
    arguments.field = p.data();
    kernels_[groups_.chunks[c].group].product(arguments);
  });
}

void ElasticPoints::ProductInSlots(const SinglePointTangent& tangent, const SingleField& p) {
  pool_.ForEach(static_cast<int>(groups_.chunks.size()), [&](int c) {
    KernelArguments arguments = Arguments(groups_.chunks[c], tangent);
    arguments.single_field = p.data();
    kernels_[groups_.chunks[c].group].single_product(arguments);
  });
}

void ElasticPoints::AddProduct(const PointTangent& tangent, double factor, const Field& p, Field& q) {
  ProductInSlots(tangent, p);
  pool_.ForEach(ChunkCount(particles_, kParticlesPerChunk),
                [&](int c) { Gather(c, slots_.data(), factor, &q[c * kParticlesPerChunk]); });
}

template <class Tangent>
void ElasticPoints::AddDiagonal(const Tangent& tangent, double factor, BlockField& blocks) {
  pool_.ForEach(static_cast<int>(groups_.chunks.size()),
                [&](int c) { kernels_[groups_.chunks[c].group].diagonal(Arguments(groups_.chunks[c], tangent)); });
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

template <class Tangent>
void ElasticPoints::AddCoarse(const Tangent& tangent, double factor, CoarseMatrix& matrix) {
  const std::vector<int>& points = matrix.points();
  const auto arguments_of = [&](int group) {
    PointChunk group_only{};
    group_only.group = group;
    return Arguments(group_only, tangent);
  };
  pool_.ForEach(matrix.aggregates().count(), [&](int a) {
    const int begin = matrix.points_begin(a), inside_end = matrix.points_inside_end(a);
    double tensor[9][9] = {};
    for (int g = 0; g < static_cast<int>(groups_.groups.size()) && begin < inside_end; ++g) {
      PointPlace places[4 * kLanes];
      int count = 0;
      for (int n = begin; n < inside_end; ++n) {
        const PointPlace& place = groups_.places[points[n]];
        if (place.group == g) places[count++] = place;
        if (count == 0 || (count < 4 * kLanes && n + 1 < inside_end)) continue;
        kernels_[g].add_tensors(arguments_of(g), places, count, tensor);
        count = 0;
      }
    }
    if (begin < inside_end) {
      const PointPlace& place = groups_.places[points[begin]];
      AddCoarseOfTensor(groups_.groups[place.group], place, tensor, factor, a, matrix);
    }
    for (int n = inside_end; n < matrix.points_begin(a + 1); ++n) {
      const PointPlace& place = groups_.places[points[n]];
      AddCoarseOfPoint(kernels_[place.group], arguments_of(place.group), place, factor, a, matrix);
    }
  });
}

template void ElasticPoints::Resize(PointTangent&) const;
template void ElasticPoints::Resize(SinglePointTangent&) const;
template void ElasticPoints::Linearise(const Field&, bool, PointTangent&);
template void ElasticPoints::Linearise(const Field&, bool, SinglePointTangent&);
template void ElasticPoints::AddDiagonal(const PointTangent&, double, BlockField&);
template void ElasticPoints::AddDiagonal(const SinglePointTangent&, double, BlockField&);
template void ElasticPoints::AddCoarse(const PointTangent&, double, CoarseMatrix&);
template void ElasticPoints::AddCoarse(const SinglePointTangent&, double, CoarseMatrix&);

}  // namespace meshless_cutting
