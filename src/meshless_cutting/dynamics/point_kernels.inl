// The loops over points, for Lanes of any instruction set. Included inside a namespace of internal linkage, after lanes.inl
// and material_laws.inl.

/// The corners of a box. Modes[m][i] = sum_k H_m(k) x_k,i by the fast Hadamard transform: 24 additions for eight sums, one
/// component after the other, so that the eight stay in registers.
template <bool kCentre, class L>
struct BoxSupport {
  using Number = typename NumberOf<L>::type;
  using Vector = BasicVector4<Number>;
  static constexpr int kModes = 8;

  BoxSupport(const PointGroup& group, int batch)
      : slot(&group.slot[static_cast<std::size_t>(batch) * 8 * kLanes]),
        box(&group.box[static_cast<std::size_t>(batch) * 3 * kLanes]),
        hourglass(kCentre ? nullptr : &group.hourglass[static_cast<std::size_t>(batch) * 12 * kLanes]),
        stiffness(LoadAs<L>(&group.stabilisation[static_cast<std::size_t>(batch) * kLanes])) {}

  /// Modes of a field, given per slot of the chunk, and its gradient F_ij = sum_k x_k,i g_k,j.
  [[gnu::always_inline]] void Gradient(const Vector* field, L (*modes)[3], L* F) const {
#pragma GCC unroll 8
    for (int k = 0; k < 8; ++k) LoadParticles(field, slot + k * kLanes, modes[k]);
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      L sum[8];
      for (int k = 0; k < 8; ++k) sum[k] = modes[k][i];
#pragma GCC unroll 12
      for (int n = 0; n < 12; ++n) {
        const L low = sum[kLow[n]], high = sum[kLow[n] | kBit[n]];
        sum[kLow[n]] = low + high;
        sum[kLow[n] | kBit[n]] = high - low;
      }
      for (int k = 0; k < 8; ++k) modes[k][i] = sum[k];
    }
    for (int j = 0; j < 3; ++j) {
      const L c = LoadAs<L>(box + j * kLanes);
      for (int i = 0; i < 3; ++i) F[3 * i + j] = c * modes[1 << j][i];
    }
    if constexpr (!kCentre) {
      for (int n = 0; n < 4; ++n) {
        for (int j = 0; j < 3; ++j) {
          const L c = LoadAs<L>(hourglass + (3 * n + j) * kLanes);
          for (int i = 0; i < 3; ++i) F[3 * i + j] += c * modes[kHourglassModes[n]][i];
        }
      }
    }
  }

  /// S sum_k |x_k - affine fit|^2 = S/8 of the sum over the hourglass modes.
  [[gnu::always_inline]] L StabilisationEnergy(const L (*modes)[3]) const {
    L sum = stiffness - stiffness;
    for (int n : kHourglassModes) {
      for (int i = 0; i < 3; ++i) sum += modes[n][i] * modes[n][i];
    }
    return (0.5 / 8) * stiffness * sum;
  }

  /// Adds to the slots the transpose: sum_j P_ij g_k,j plus the stabilisation of `modes`, which are overwritten. P times volume.
  [[gnu::always_inline]] void Scatter(const L* P, L (*modes)[3], Vector* slots) const {
    const L s = Number(0.125) * stiffness;
    for (int n = 0; n < 4; ++n) {
      for (int i = 0; i < 3; ++i) {
        L sum = s * modes[kHourglassModes[n]][i];
        if constexpr (!kCentre) {
          for (int j = 0; j < 3; ++j) sum += P[3 * i + j] * LoadAs<L>(hourglass + (3 * n + j) * kLanes);
        }
        modes[kHourglassModes[n]][i] = sum;
      }
    }
    for (int j = 0; j < 3; ++j) {
      const L c = LoadAs<L>(box + j * kLanes);
      for (int i = 0; i < 3; ++i) modes[1 << j][i] = c * P[3 * i + j];
    }
    for (int i = 0; i < 3; ++i) modes[0][i] = s - s;
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      L sum[8];
      for (int k = 0; k < 8; ++k) sum[k] = modes[k][i];
#pragma GCC unroll 12
      for (int n = 0; n < 12; ++n) {
        const L low = sum[kLow[n]], high = sum[kLow[n] | kBit[n]];
        sum[kLow[n]] = low - high;
        sum[kLow[n] | kBit[n]] = low + high;
      }
      for (int k = 0; k < 8; ++k) modes[k][i] = sum[k];
    }
#pragma GCC unroll 8
    for (int k = 0; k < 8; ++k) {
      AddParticles(modes[k], slot + k * kLanes, slots);
    }
  }

  int count() const { return 8; }

  [[gnu::always_inline]] void GradientOf(int k, L* g) const {
    for (int j = 0; j < 3; ++j) {
      const L c = LoadAs<L>(box + j * kLanes);
      g[j] = k >> j & 1 ? c : -c;
      if constexpr (!kCentre) {
        for (int n = 0; n < 4; ++n) {
          const L h = LoadAs<L>(hourglass + (3 * n + j) * kLanes);
          g[j] += Hadamard(kHourglassModes[n], k) * h;
        }
      }
    }
  }
  /// Diagonal entry of the stabilisation, N/m.
  [[gnu::always_inline]] L StabilisationDiagonal(int) const { return 0.5 * stiffness; }

  // The pairs (k, k | bit) of the fast transform.
  static constexpr int kLow[12] = {0, 2, 4, 6, 0, 1, 4, 5, 0, 1, 2, 3};
  static constexpr int kBit[12] = {1, 1, 1, 1, 2, 2, 2, 2, 4, 4, 4, 4};
  const Slot* slot;
  const double *box, *hourglass;
  L stiffness;
};

/// Any K particles. Modes[k] = x_k less the affine fit to all of them.
template <class L>
struct GeneralSupport {
  using Number = typename NumberOf<L>::type;
  using Vector = BasicVector4<Number>;
  static constexpr int kModes = 64;  // the most particles per point

  GeneralSupport(const PointGroup& group, int batch)
      : K(group.support),
        slot(&group.slot[static_cast<std::size_t>(batch) * K * kLanes]),
        gradient(&group.gradient[static_cast<std::size_t>(batch) * K * 3 * kLanes]),
        fit(&group.fit[static_cast<std::size_t>(batch) * K * 3 * kLanes]),
        offset(&group.offset[static_cast<std::size_t>(batch) * K * 3 * kLanes]),
        stiffness(LoadAs<L>(&group.stabilisation[static_cast<std::size_t>(batch) * kLanes])) {}

  [[gnu::always_inline]] void Gradient(const Vector* field, L (*modes)[3], L* F) const {
    L fitted[9], mean[3];
    for (int i = 0; i < 9; ++i) F[i] = fitted[i] = stiffness - stiffness;
    for (int i = 0; i < 3; ++i) mean[i] = stiffness - stiffness;
    for (int k = 0; k < K; ++k) {
      LoadParticles(field, slot + k * kLanes, modes[k]);
      for (int i = 0; i < 3; ++i) mean[i] += modes[k][i];
      for (int j = 0; j < 3; ++j) {
        const L g = LoadAs<L>(gradient + (3 * k + j) * kLanes), f = LoadAs<L>(fit + (3 * k + j) * kLanes);
        for (int i = 0; i < 3; ++i) {
          F[3 * i + j] += modes[k][i] * g;
          fitted[3 * i + j] += modes[k][i] * f;
        }
      }
    }
    for (int i = 0; i < 3; ++i) mean[i] *= Number(1.0 / K);
    for (int k = 0; k < K; ++k) {
      L d[3], affine[3];
      for (int j = 0; j < 3; ++j) d[j] = LoadAs<L>(offset + (3 * k + j) * kLanes);
      Times(fitted, d, affine);
      for (int i = 0; i < 3; ++i) modes[k][i] = (modes[k][i] - mean[i]) - affine[i];
    }
  }

  [[gnu::always_inline]] L StabilisationEnergy(const L (*modes)[3]) const {
    L sum = stiffness - stiffness;
    for (int k = 0; k < K; ++k) {
      for (int i = 0; i < 3; ++i) sum += modes[k][i] * modes[k][i];
    }
    return 0.5 * stiffness * sum;
  }

  [[gnu::always_inline]] void Scatter(const L* P, L (*modes)[3], Vector* slots) const {
    for (int k = 0; k < K; ++k) {
      L g[3], f[3];
      for (int j = 0; j < 3; ++j) g[j] = LoadAs<L>(gradient + (3 * k + j) * kLanes);
      Times(P, g, f);
      for (int i = 0; i < 3; ++i) f[i] += stiffness * modes[k][i];
      AddParticles(f, slot + k * kLanes, slots);
    }
  }

  int count() const { return K; }
  [[gnu::always_inline]] void GradientOf(int k, L* g) const {
    for (int j = 0; j < 3; ++j) g[j] = LoadAs<L>(gradient + (3 * k + j) * kLanes);
  }
  [[gnu::always_inline]] L StabilisationDiagonal(int k) const {
    L share = (stiffness - stiffness) + (1.0 - 1.0 / K);
    for (int j = 0; j < 3; ++j) share -= LoadAs<L>(offset + (3 * k + j) * kLanes) * LoadAs<L>(fit + (3 * k + j) * kLanes);
    return share * stiffness;
  }

  int K;
  const Slot* slot;
  const double *gradient, *fit, *offset;
  L stiffness;
};

/// A field as a chunk sees it: per slot.
template <class Vector>
class ChunkField {
 public:
  ChunkField(const KernelArguments& a, const Vector* field) {
    const int* particle = a.slot_particle + a.chunk.first_slot;
    const int count = a.chunk.last_slot - a.chunk.first_slot;
    for (int n = 0; n < count; ++n) __builtin_memcpy(bytes_ + n * sizeof(Vector), field + particle[n], sizeof(Vector));
  }
  const Vector* data() const { return reinterpret_cast<const Vector*>(bytes_); }

 private:
  alignas(64) unsigned char bytes_[kSlotsPerChunk * sizeof(Vector)];  // no vectors, which would be cleared first
};

/// The slots of a chunk, cleared.
template <class Vector>
inline Vector* ClearSlots(const KernelArguments& a, Vector* slots) {
  for (int slot = a.chunk.first_slot; slot < a.chunk.last_slot; ++slot) slots[slot] = Vector();
  return slots + a.chunk.first_slot;
}
template <class L>
[[gnu::always_inline]] inline L VolumeOf(const KernelArguments& a, int batch) {
  return LoadAs<L>(&a.group->volume[static_cast<std::size_t>(batch) * kLanes]);
}

template <class Law, class L>
[[gnu::always_inline]] inline void LoadTangent(const KernelArguments& a, int batch, L* tangent) {
  const std::size_t first = static_cast<std::size_t>(batch) * Law::kTangentSize * kLanes;
  for (int i = 0; i < Law::kTangentSize; ++i) {
    tangent[i] = a.tangent != nullptr ? LoadAs<L>(a.tangent + first + i * kLanes)
                                      : LoadAs<L>(a.single_tangent + first + i * kLanes);
  }
}

/// In place of a field that is not there.
struct Nothing {
  Nothing(const KernelArguments&, const Vector4*) {}
};

template <class Law, class Support, bool kDamped>
double EvaluatePoints(const KernelArguments& a) {
  Vector4* slots = ClearSlots(a, a.slots);
  const ChunkField<Vector4> field(a, a.field);
  std::conditional_t<kDamped, ChunkField<Vector4>, Nothing> still(a, a.still);
  const Law law(a.lame.mu, a.lame.lambda);
  Lanes energy = {};
  for (int batch = a.chunk.begin; batch < a.chunk.end; ++batch) {
    const Support support(*a.group, batch);
    const Lanes volume = VolumeOf<Lanes>(a, batch);
    Lanes modes[Support::kModes][3], F[9], P[9];
    support.Gradient(field.data(), modes, F);
    law.Stress(F, P);
    energy += support.StabilisationEnergy(modes);
    if constexpr (kDamped) {
      Lanes way[Support::kModes][3], dF[9], dP[9], tangent[Law::kTangentSize];
      support.Gradient(still.data(), way, dF);
      for (int k = 0; k < support.count(); ++k) {
        for (int i = 0; i < 3; ++i) way[k][i] = modes[k][i] - way[k][i];
      }
      for (int i = 0; i < 9; ++i) dF[i] = F[i] - dF[i];
      LoadTangent<Law>(a, batch, tangent);
      law.Differential(tangent, dF, dP);
      energy += a.damping * (0.5 * volume * Dot9(dF, dP) + support.StabilisationEnergy(way));
      for (int i = 0; i < 9; ++i) P[i] += a.damping * dP[i];
      for (int k = 0; k < support.count(); ++k) {
        for (int i = 0; i < 3; ++i) modes[k][i] += a.damping * way[k][i];
      }
    }
    for (int i = 0; i < 9; ++i) P[i] *= volume;
    support.Scatter(P, modes, slots);
    energy += volume * law.Stress(F, P);  // last, so that no force waits for it; the compiler does what both need once
  }
  return Sum(energy);
}

template <class Law, class Support>
void LinearisePoints(const KernelArguments& a) {
  const ChunkField<Vector4> field(a, a.field);
  const Law law(a.lame.mu, a.lame.lambda);
  for (int batch = a.chunk.begin; batch < a.chunk.end; ++batch) {
    const Support support(*a.group, batch);
    Lanes modes[Support::kModes][3], F[9], tangent[Law::kTangentSize];
    support.Gradient(field.data(), modes, F);
    law.Linearise(F, tangent, a.filtered);
    const std::size_t first = static_cast<std::size_t>(batch) * Law::kTangentSize * kLanes;
    for (int i = 0; i < Law::kTangentSize; ++i) {
      if (a.tangent != nullptr) {
        Store(tangent[i], a.tangent + first + i * kLanes);
      } else {
        Store(tangent[i], a.single_tangent + first + i * kLanes);
      }
    }
  }
}

template <class Law, class L, class Support, class Vector>
[[gnu::always_inline]] inline void Product(const KernelArguments& a, const Vector* of_particles, Vector* all_slots) {
  Vector* slots = ClearSlots(a, all_slots);
  const ChunkField<Vector> field(a, of_particles);
  const Law law(a.lame.mu, a.lame.lambda);
  for (int batch = a.chunk.begin; batch < a.chunk.end; ++batch) {
    const Support support(*a.group, batch);
    const L volume = VolumeOf<L>(a, batch);
    L modes[Support::kModes][3], dF[9], dP[9], tangent[Law::kTangentSize];
    support.Gradient(field.data(), modes, dF);
    LoadTangent<Law>(a, batch, tangent);
    law.Differential(tangent, dF, dP);
    for (int i = 0; i < 9; ++i) dP[i] *= volume;
    support.Scatter(dP, modes, slots);
  }
}

template <class Law, class Support>
void ProductPoints(const KernelArguments& a) {
  Product<Law, Lanes, Support>(a, a.field, a.slots);
}

template <class Law, class Support>
void SingleProductPoints(const KernelArguments& a) {
  Product<Law, SingleLanes, Support>(a, a.single_field, a.single_slots);
}

template <class Law, class Support>
void DiagonalOfPoints(const KernelArguments& a) {
  Vector4* slots = ClearSlots(a, a.slots);
  Vector4* more_slots = ClearSlots(a, a.slots + a.slot_count);
  const Law law(a.lame.mu, a.lame.lambda);
  for (int batch = a.chunk.begin; batch < a.chunk.end; ++batch) {
    const Support support(*a.group, batch);
    const Lanes volume = VolumeOf<Lanes>(a, batch);
    Lanes tangent[Law::kTangentSize];
    LoadTangent<Law>(a, batch, tangent);
    for (int k = 0; k < support.count(); ++k) {
      Lanes g[3], block[9];
      support.GradientOf(k, g);
      law.Block(tangent, g, g, block);
      const Lanes s = support.StabilisationDiagonal(k);
      const Lanes diagonal[3] = {volume * block[0] + s, volume * block[4] + s, volume * block[8] + s};
      const Lanes off_diagonal[3] = {volume * block[1], volume * block[2], volume * block[5]};
      AddParticles(diagonal, support.slot + k * kLanes, slots);
      AddParticles(off_diagonal, support.slot + k * kLanes, more_slots);
    }
  }
}

/// The tangent of the point in one lane.
inline double TangentNumber(const KernelArguments& a, int tangent_size, const PointPlace& place, int i) {
  const std::size_t at = (static_cast<std::size_t>(place.batch) * tangent_size + i) * kLanes + place.lane;
  return a.tangent != nullptr ? a.tangent[at] : static_cast<double>(a.single_tangent[at]);
}
inline double VolumeAt(const KernelArguments& a, const PointPlace& place) {
  return a.group->volume[static_cast<std::size_t>(place.batch) * kLanes + place.lane];
}

template <class Law>
void BlocksOfPoint(const KernelArguments& a, const PointPlace& place, const double (*g)[4], const double (*h)[4],
                   double (*blocks)[9][4]) {
  const Law law(a.lame.mu, a.lame.lambda);
  const FourLanes none = {};
  FourLanes tangent[Law::kTangentSize], right[3], block[9];
  for (int i = 0; i < Law::kTangentSize; ++i) tangent[i] = none + TangentNumber(a, Law::kTangentSize, place, i);
  __builtin_memcpy(right, h, sizeof(right));
  const double volume = VolumeAt(a, place);
  for (int c = 0; c < 4; ++c) {
    const FourLanes left[3] = {none + g[0][c], none + g[1][c], none + g[2][c]};
    law.Block(tangent, left, right, block);
    for (int i = 0; i < 9; ++i) block[i] *= volume;
    __builtin_memcpy(blocks[c], block, sizeof(block));
  }
}

template <class Law>
void AddTensorsOfPoints(const KernelArguments& a, const PointPlace* places, int count, double (*tensor)[9]) {
  const Law law(a.lame.mu, a.lame.lambda);
  const Lanes none = {};
  Lanes sum[9][9] = {};
  for (int begin = 0; begin < count; begin += kLanes) {
    Lanes tangent[Law::kTangentSize], volume = none;
    for (int l = 0; l < kLanes; ++l) {
      const PointPlace& place = places[begin + l < count ? begin + l : begin];
      for (int i = 0; i < Law::kTangentSize; ++i) tangent[i][l] = TangentNumber(a, Law::kTangentSize, place, i);
      if (begin + l < count) volume[l] = VolumeAt(a, place);
    }
    for (int n = 0; n < 9; ++n) {
      Lanes left[3] = {none, none, none}, right[3] = {none, none, none}, block[9];
      left[n / 3] += 1.0;
      right[n % 3] += 1.0;
      law.Block(tangent, left, right, block);
      for (int i = 0; i < 9; ++i) sum[n][i] += volume * block[i];
    }
  }
  for (int n = 0; n < 9; ++n) {
    for (int i = 0; i < 9; ++i) tensor[n][i] += Sum(sum[n][i]);
  }
}

template <class Law, class Support, class SingleSupport>
constexpr PointKernels MakePointKernels() {
  return {Law::kTangentSize,
          EvaluatePoints<Law, Support, false>,
          EvaluatePoints<Law, Support, true>,
          LinearisePoints<Law, Support>,
          ProductPoints<Law, Support>,
          SingleProductPoints<Law, SingleSupport>,
          DiagonalOfPoints<Law, Support>,
          BlocksOfPoint<Law>,
          AddTensorsOfPoints<Law>};
}

// Rows in the order of MaterialModel, columns in that of SupportShape.
#define MESHLESS_CUTTING_POINT_KERNEL_ROW(Law)                                              \
  {                                                                                         \
    MakePointKernels<Law, BoxSupport<true, Lanes>, BoxSupport<true, SingleLanes>>(),        \
        MakePointKernels<Law, BoxSupport<false, Lanes>, BoxSupport<false, SingleLanes>>(),  \
        MakePointKernels<Law, GeneralSupport<Lanes>, GeneralSupport<SingleLanes>>()         \
  }
#define MESHLESS_CUTTING_POINT_KERNEL_TABLE                                                                             \
  {                                                                                                                     \
    MESHLESS_CUTTING_POINT_KERNEL_ROW(StableNeoHookeanLaw), MESHLESS_CUTTING_POINT_KERNEL_ROW(NeoHookeanLaw),           \
        MESHLESS_CUTTING_POINT_KERNEL_ROW(StVenantKirchhoffLaw), MESHLESS_CUTTING_POINT_KERNEL_ROW(LinearLaw)           \
  }
