// Eight numbers side by side, as the compiler's vector type: one register or several, as the instruction set has it. Included
// inside a namespace of internal linkage.

typedef double Lanes __attribute__((vector_size(8 * kLanes)));
typedef unsigned long long LaneBits __attribute__((vector_size(8 * kLanes)));
typedef double FourLanes __attribute__((vector_size(32)));
typedef float SingleLanes __attribute__((vector_size(4 * kLanes)));

[[gnu::always_inline]] inline Lanes Load(const double* from) {
  Lanes lanes;
  __builtin_memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}
[[gnu::always_inline]] inline void Store(const Lanes& lanes, double* to) { __builtin_memcpy(to, &lanes, sizeof(lanes)); }

/// As lanes of either precision, rounded or widened.
template <class L>
[[gnu::always_inline]] inline L LoadAs(const double* from) {
  return __builtin_convertvector(Load(from), L);
}
template <class L>
[[gnu::always_inline]] inline L LoadAs(const float* from) {
  SingleLanes lanes;
  __builtin_memcpy(&lanes, from, sizeof(lanes));
  return __builtin_convertvector(lanes, L);
}
[[gnu::always_inline]] inline void Store(const Lanes& lanes, float* to) {
  const SingleLanes rounded = __builtin_convertvector(lanes, SingleLanes);
  __builtin_memcpy(to, &rounded, sizeof(rounded));
}

[[gnu::always_inline]] inline double Sum(const Lanes& a) { return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7])); }

[[gnu::always_inline]] inline double Sqrt(double x) { return __builtin_sqrt(x); }
[[gnu::always_inline]] inline double Log(double x) { return __builtin_log(x); }

[[gnu::always_inline]] inline Lanes Sqrt(const Lanes& x) {
#if defined(MESHLESS_CUTTING_LANES_AVX512)
  return reinterpret_cast<Lanes>(_mm512_sqrt_pd(reinterpret_cast<__m512d>(x)));
#else
  Lanes root;
  for (int l = 0; l < kLanes; ++l) root[l] = __builtin_sqrt(x[l]);
  return root;
#endif
}

/// Natural logarithm of positive normal numbers, below 1 ulp: the method and the constants of FDLIBM's e_log.c. Ours, so that
/// all lanes are done at once and every C library gives the same bits.
[[gnu::always_inline]] inline Lanes Log(const Lanes& x) {
  // x = 2^k m, sqrt(1/2) <= m < sqrt(2). `biased` = k + 1023.
  const LaneBits bits = reinterpret_cast<LaneBits>(x);
  const LaneBits biased = (bits - 0x3fe6a09e667f3bcdULL + 0x3ff0000000000000ULL) >> 52;
  const Lanes m = reinterpret_cast<Lanes>(bits - ((biased - 1023) << 52));
  const Lanes k = reinterpret_cast<Lanes>(biased + 0x4330000000000000ULL) - (4503599627370496.0 + 1023.0);
  const Lanes f = m - 1.0;
  const Lanes s = f / (2.0 + f);
  const Lanes z = s * s;
  // The polynomial in two halves that do not wait for each other.
  const Lanes w = z * z;
  const Lanes even = w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const Lanes odd = z * (6.666666666666735130e-01 +
                         w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  const Lanes r = even + odd;
  const Lanes half_square = 0.5 * (f * f);
  return k * 6.93147180369123816490e-01 -
         ((half_square - (s * (half_square + r) + k * 1.90821492927058770002e-10)) - f);
}

#if defined(MESHLESS_CUTTING_LANES_AVX512)
[[gnu::always_inline]] inline __m512d Pair(const Vector4& low, const Vector4& high) {
  return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(&low.x)), _mm256_load_pd(&high.x), 1);
}
[[gnu::always_inline]] inline void AddPair(const __m512d& two, Vector4& low, Vector4& high) {
  _mm256_store_pd(&low.x, _mm256_add_pd(_mm256_load_pd(&low.x), _mm512_castpd512_pd256(two)));
  _mm256_store_pd(&high.x, _mm256_add_pd(_mm256_load_pd(&high.x), _mm512_extractf64x4_pd(two, 1)));
}
#endif

#if defined(MESHLESS_CUTTING_LANES_AVX2)
[[gnu::always_inline]] inline __m256 Pair(const SingleVector4& low, const SingleVector4& high) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(&low.x)), _mm_load_ps(&high.x), 1);
}
[[gnu::always_inline]] inline void AddPair(const __m256& two, SingleVector4& low, SingleVector4& high) {
  _mm_store_ps(&low.x, _mm_add_ps(_mm_load_ps(&low.x), _mm256_castps256_ps128(two)));
  _mm_store_ps(&high.x, _mm_add_ps(_mm_load_ps(&high.x), _mm256_extractf128_ps(two, 1)));
}
#endif

/// The vectors of eight particles, one to a lane.
[[gnu::always_inline]] inline void LoadParticles(const Vector4* field, const Slot* slot, Lanes* v) {
#if defined(MESHLESS_CUTTING_LANES_AVX512)
  // Lanes n and n + 4 share a register until they are transposed: xyz_ xyz_ -> x, y, z.
  const __m512d a = Pair(field[slot[0]], field[slot[4]]), b = Pair(field[slot[1]], field[slot[5]]);
  const __m512d c = Pair(field[slot[2]], field[slot[6]]), d = Pair(field[slot[3]], field[slot[7]]);
  const __m512d xz_ab = _mm512_unpacklo_pd(a, b), y_ab = _mm512_unpackhi_pd(a, b);
  const __m512d xz_cd = _mm512_unpacklo_pd(c, d), y_cd = _mm512_unpackhi_pd(c, d);
  const __m512i first = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
  const __m512i second = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  v[0] = reinterpret_cast<Lanes>(_mm512_permutex2var_pd(xz_ab, first, xz_cd));
  v[1] = reinterpret_cast<Lanes>(_mm512_permutex2var_pd(y_ab, first, y_cd));
  v[2] = reinterpret_cast<Lanes>(_mm512_permutex2var_pd(xz_ab, second, xz_cd));
#else
  const Vector4 &a = field[slot[0]], &b = field[slot[1]], &c = field[slot[2]], &d = field[slot[3]];
  const Vector4 &e = field[slot[4]], &f = field[slot[5]], &g = field[slot[6]], &h = field[slot[7]];
  v[0] = Lanes{a.x, b.x, c.x, d.x, e.x, f.x, g.x, h.x};
  v[1] = Lanes{a.y, b.y, c.y, d.y, e.y, f.y, g.y, h.y};
  v[2] = Lanes{a.z, b.z, c.z, d.z, e.z, f.z, g.z, h.z};
#endif
}
[[gnu::always_inline]] inline void LoadParticles(const SingleVector4* field, const Slot* slot, SingleLanes* v) {
#if defined(MESHLESS_CUTTING_LANES_AVX2)
  const __m256 a = Pair(field[slot[0]], field[slot[4]]), b = Pair(field[slot[1]], field[slot[5]]);
  const __m256 c = Pair(field[slot[2]], field[slot[6]]), d = Pair(field[slot[3]], field[slot[7]]);
  const __m256 xy_ab = _mm256_unpacklo_ps(a, b), z_ab = _mm256_unpackhi_ps(a, b);
  const __m256 xy_cd = _mm256_unpacklo_ps(c, d), z_cd = _mm256_unpackhi_ps(c, d);
  v[0] = reinterpret_cast<SingleLanes>(_mm256_shuffle_ps(xy_ab, xy_cd, 0x44));
  v[1] = reinterpret_cast<SingleLanes>(_mm256_shuffle_ps(xy_ab, xy_cd, 0xee));
  v[2] = reinterpret_cast<SingleLanes>(_mm256_shuffle_ps(z_ab, z_cd, 0x44));
#else
  for (int l = 0; l < kLanes; ++l) {
    const SingleVector4& x = field[slot[l]];
    v[0][l] = x.x;
    v[1][l] = x.y;
    v[2][l] = x.z;
  }
#endif
}

/// The reverse: adds lane l of v[0], v[1], v[2] to the vector at to[slot[l]]. Slots may coincide.
[[gnu::always_inline]] inline void AddParticles(const Lanes* v, const Slot* slot, Vector4* to) {
#if defined(MESHLESS_CUTTING_LANES_AVX512)
  const __m512d x = reinterpret_cast<__m512d>(v[0]), y = reinterpret_cast<__m512d>(v[1]);
  const __m512d z = reinterpret_cast<__m512d>(v[2]), zero = _mm512_setzero_pd();
  const __m512d xy_even = _mm512_unpacklo_pd(x, y), xy_odd = _mm512_unpackhi_pd(x, y);
  const __m512d z_even = _mm512_unpacklo_pd(z, zero), z_odd = _mm512_unpackhi_pd(z, zero);
  const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
  const __m512i high = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
  AddPair(_mm512_permutex2var_pd(xy_even, low, z_even), to[slot[0]], to[slot[2]]);
  AddPair(_mm512_permutex2var_pd(xy_odd, low, z_odd), to[slot[1]], to[slot[3]]);
  AddPair(_mm512_permutex2var_pd(xy_even, high, z_even), to[slot[4]], to[slot[6]]);
  AddPair(_mm512_permutex2var_pd(xy_odd, high, z_odd), to[slot[5]], to[slot[7]]);
#else
  // In the order of the above: where two slots coincide, the order of the sum matters to the last bit.
  for (int l : {0, 2, 1, 3, 4, 6, 5, 7}) to[slot[l]] += Vector4{v[0][l], v[1][l], v[2][l], 0};
#endif
}
[[gnu::always_inline]] inline void AddParticles(const SingleLanes* v, const Slot* slot, SingleVector4* to) {
#if defined(MESHLESS_CUTTING_LANES_AVX2)
  const __m256 x = reinterpret_cast<__m256>(v[0]), y = reinterpret_cast<__m256>(v[1]);
  const __m256 z = reinterpret_cast<__m256>(v[2]), zero = _mm256_setzero_ps();
  const __m256 xy_low = _mm256_unpacklo_ps(x, y), z_low = _mm256_unpacklo_ps(z, zero);
  const __m256 xy_high = _mm256_unpackhi_ps(x, y), z_high = _mm256_unpackhi_ps(z, zero);
  AddPair(_mm256_shuffle_ps(xy_low, z_low, 0x44), to[slot[0]], to[slot[4]]);
  AddPair(_mm256_shuffle_ps(xy_low, z_low, 0xee), to[slot[1]], to[slot[5]]);
  AddPair(_mm256_shuffle_ps(xy_high, z_high, 0x44), to[slot[2]], to[slot[6]]);
  AddPair(_mm256_shuffle_ps(xy_high, z_high, 0xee), to[slot[3]], to[slot[7]]);
#else
  for (int l : {0, 4, 1, 5, 2, 6, 3, 7}) to[slot[l]] += SingleVector4{v[0][l], v[1][l], v[2][l], 0};
#endif
}
