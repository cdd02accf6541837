// The laws, each written once for a number type T: double, or kLanes doubles side by side. Included inside a namespace of
// internal linkage, because the loops over points are compiled for several instruction sets from the same text.
//
// Matrices are T[9], row by row: F[3 * i + j] = F_ij. J = det F, C = F^T F, I1 = tr C, cof F = dJ/dF.
// A law has
//   kTangentSize                     numbers that Linearise keeps per point
//   Stress(F, P) -> Psi              energy density and first Piola stress
//   Linearise(F, s, filtered)        what Differential needs; filtered: made positive semidefinite
//   Differential(s, dF, dP)          dP = (d2Psi/dF2) : dF
//   Block(s, g, h, B)                B_il = g_a (d2Psi / dF_ia dF_lb) h_b, the 3 x 3 block that joins two gradients
// No std:: function is used but through Log and Sqrt, which whoever includes this provides for its T.

/// What one lane of T is.
template <class T>
struct NumberOf {
  using type = std::decay_t<decltype(T()[0])>;
};
template <>
struct NumberOf<double> {
  using type = double;
};

template <class T>
[[gnu::always_inline]] inline void Cofactor(const T* F, T* cof) {
  cof[0] = F[4] * F[8] - F[5] * F[7];
  cof[1] = F[5] * F[6] - F[3] * F[8];
  cof[2] = F[3] * F[7] - F[4] * F[6];
  cof[3] = F[2] * F[7] - F[1] * F[8];
  cof[4] = F[0] * F[8] - F[2] * F[6];
  cof[5] = F[1] * F[6] - F[0] * F[7];
  cof[6] = F[1] * F[5] - F[2] * F[4];
  cof[7] = F[2] * F[3] - F[0] * F[5];
  cof[8] = F[0] * F[4] - F[1] * F[3];
}

template <class T>
[[gnu::always_inline]] inline T Dot9(const T* a, const T* b) {
  return ((a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])) +
         ((a[4] * b[4] + a[5] * b[5]) + (a[6] * b[6] + a[7] * b[7])) + a[8] * b[8];
}

/// y = F g.
template <class T>
[[gnu::always_inline]] inline void Times(const T* F, const T* g, T* y) {
  for (int i = 0; i < 3; ++i) y[i] = F[3 * i] * g[0] + F[3 * i + 1] * g[1] + F[3 * i + 2] * g[2];
}

template <class T>
[[gnu::always_inline]] inline T Smaller(const T& a, const T& b) {
  return a < b ? a : b;
}
template <class T>
[[gnu::always_inline]] inline T Larger(const T& a, const T& b) {
  return a < b ? b : a;
}

/// Whether any lane is not zero.
template <class T>
[[gnu::always_inline]] inline bool Any(const T& a) {
  unsigned long long words[sizeof(T) / 8], all = 0;
  __builtin_memcpy(words, &a, sizeof(words));
  for (const unsigned long long word : words) all |= word;
  return all != 0;
}

/// Laws Psi = f(I1) + g(J), whose stress is P = A F + B cof F with A = 2 f'(I1), B = g'(J). `Law` gives
/// Coefficients(I1, J, A, A2, B, B2) with A2 = 4 f''(I1), B2 = g''(J), so that
/// dP = A dF + A2 (F:dF) F + B d(cof F) + B2 (cof:dF) cof; and Energy(I1, J).
template <class Law>
struct NeoHookeanFamily {
  static constexpr int kTangentSize = 14;  // F, A, A2, B, B2, C

  template <class T>
  [[gnu::always_inline]] T Stress(const T* F, T* P) const {
    T cof[9], A, A2, B, B2;
    Cofactor(F, cof);
    const T I1 = Dot9(F, F);
    const T J = F[0] * cof[0] + F[1] * cof[1] + F[2] * cof[2];
    law().Coefficients(I1, J, A, A2, B, B2);
    for (int i = 0; i < 9; ++i) P[i] = A * F[i] + B * cof[i];
    return law().Energy(I1, J);
  }

  template <class T>
  [[gnu::always_inline]] void Linearise(const T* F, T* s, bool filtered) const {
    T cof[9], A, A2, B, B2;
    Cofactor(F, cof);
    const T I1 = Dot9(F, F);
    const T J = F[0] * cof[0] + F[1] * cof[1] + F[2] * cof[2];
    law().Coefficients(I1, J, A, A2, B, B2);
    for (int i = 0; i < 9; ++i) s[i] = F[i];
    s[9] = A;
    s[10] = A2;
    s[11] = B;
    s[12] = B2;
    s[13] = J - J;
    if (filtered) Filter(I1, Dot9(cof, cof), J, s);
  }

  /// Makes the Hessian positive semidefinite and changes it as little as is cheap. With the singular values sigma of F the
  /// eigenvalues of d2J/dF2 are sigma_k for the twist about axis k, -sigma_k for the flip in the same plane, and those of
  /// K = [0 s3 s2; s3 0 s1; s2 s1 0] for the stretches (Smith et al. 2018, section 4).
  /// * Compressed, B < 0: only twists can be negative, A + B sigma_k. C |omega|^2 / 2 with omega = axial vector of the
  ///   antisymmetric part of F^T dF, twice, is added: sigma_i + sigma_j times the twist plus sigma_i - sigma_j times the flip of a plane.
  ///   C = -(A + B sigma_k) sigma_k / J makes the plane semidefinite: its determinant is then no less than that of sigma_i = sigma_j.
  ///   Shear keeps its full stiffness, which a smaller |B| would take away.
  /// * Stretched, B > 0: flips ask for B <= A / sigma_max.
  ///   sigma_max^2 is bounded by mean + sqrt(2) deviation of the eigenvalues of C (Samuelson's inequality), exact at rest.
  /// * Of the stretches' block A + B K + B2 c c^T, c_i = sigma_j sigma_k, at most one eigenvalue is then negative when J > 0 (K has one
  ///   positive eigenvalue; Cauchy interlacing), so that the sign of its determinant decides. It is a polynomial in the invariants.
  /// * Where it is negative, or J <= 0: |B| <= A / (2 sigma_max), because |K| <= 2 sigma_max (Gershgorin).
  template <class T>
  [[gnu::always_inline]] static void Filter(const T& I1, const T& I2, const T& J, T* s) {
    const T A = s[9], B = s[11], zero = J - J;
    const T B2 = Larger(s[12], zero);
    const T mean = I1 * (1.0 / 3);
    const T variance = Larger((2.0 / 9) * (I1 * I1 - 3.0 * I2), zero);
    const T largest = Sqrt(mean + Sqrt(2.0 * variance) + 1e-30);
    const T limit = A / largest;
    const T b = Smaller(limit, B);
    const T det = A * (A * A - b * b * I1) + 2.0 * (b * b * b * J) + B2 * (A * A * I2 + 3.0 * (b * b * J * J) - 2.0 * (b * A * J * I1));
    const T safe = Larger(-0.5 * limit, Smaller(0.5 * limit, B));
    const T is_stable = det < -1e-12 * (A * A * A) ? zero : zero + 1.0;
    const T one = J > zero ? is_stable : zero;
    const T twist = Larger(-(A + b * largest), zero) * largest / (J > zero ? J : zero + 1.0);
    s[11] = one > zero ? b : safe;
    s[12] = B2;
    s[13] = one > zero ? twist : zero;
  }

  template <class T>
  [[gnu::always_inline]] void Differential(const T* s, const T* dF, T* dP) const {
    const T *F = s, &A = s[9], &A2 = s[10], &B = s[11], &B2 = s[12];
    T cof[9];
    Cofactor(F, cof);
    const T a = A2 * Dot9(F, dF);
    const T b = B2 * Dot9(cof, dF);
    for (int i = 0; i < 3; ++i) {
      const int i0 = 3 * i, i1 = 3 * ((i + 1) % 3), i2 = 3 * ((i + 2) % 3);
      for (int j = 0; j < 3; ++j) {
        const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        const T dcof = (dF[i1 + j1] * F[i2 + j2] + F[i1 + j1] * dF[i2 + j2]) -
                       (dF[i1 + j2] * F[i2 + j1] + F[i1 + j2] * dF[i2 + j1]);
        dP[i0 + j] = (A * dF[i0 + j] + a * F[i0 + j]) + (B * dcof + b * cof[i0 + j]);
      }
    }
    if (!Any(s[13])) return;  // the true tangent, and most filtered ones: a quarter of the work
    T omega[3];
    for (int n = 0; n < 3; ++n) {
      const int i = (n + 1) % 3, j = (n + 2) % 3;
      omega[n] = s[13] * ((F[i] * dF[j] - F[j] * dF[i]) + (F[3 + i] * dF[3 + j] - F[3 + j] * dF[3 + i]) +
                          (F[6 + i] * dF[6 + j] - F[6 + j] * dF[6 + i]));
    }
    for (int i = 0; i < 9; i += 3) {
      dP[i] += F[i + 2] * omega[1] - F[i + 1] * omega[2];
      dP[i + 1] += F[i] * omega[2] - F[i + 2] * omega[0];
      dP[i + 2] += F[i + 1] * omega[0] - F[i] * omega[1];
    }
  }

  template <class T>
  [[gnu::always_inline]] void Block(const T* s, const T* g, const T* h, T* block) const {
    const T *F = s, &A = s[9], &A2 = s[10], &B = s[11], &B2 = s[12];
    T cof[9], Fg[3], Fh[3], cg[3], ch[3], w[3];
    Cofactor(F, cof);
    Times(F, g, Fg);
    Times(F, h, Fh);
    Times(cof, g, cg);
    Times(cof, h, ch);
    const T cross[3] = {g[1] * h[2] - g[2] * h[1], g[2] * h[0] - g[0] * h[2], g[0] * h[1] - g[1] * h[0]};
    Times(F, cross, w);
    const T gh = g[0] * h[0] + g[1] * h[1] + g[2] * h[2];
    for (int i = 0; i < 3; ++i) {
      for (int l = 0; l < 3; ++l) {
        const T FFt = F[3 * i] * F[3 * l] + F[3 * i + 1] * F[3 * l + 1] + F[3 * i + 2] * F[3 * l + 2];
        block[3 * i + l] = A2 * Fg[i] * Fh[l] + B2 * cg[i] * ch[l] + s[13] * (gh * FFt - Fh[i] * Fg[l]);
      }
      block[4 * i] += A * gh;
    }
    // d2J/dF_ia dF_lb = eps_ilm eps_abn F_mn.
    block[1] += B * w[2];
    block[5] += B * w[0];
    block[6] += B * w[1];
    block[3] -= B * w[2];
    block[7] -= B * w[0];
    block[2] -= B * w[1];
  }

 private:
  const Law& law() const { return static_cast<const Law&>(*this); }
};

/// Smith, De Goes, Kim 2018, "Stable Neo-Hookean Flesh Simulation", eq. 14 with the constants of its section 3.4 (m, l from
/// mu, lambda): Psi = m/2 (I1 - 3) + l/2 (J - a)^2 - m/2 ln(I1 + 1), less its value at rest. Defined for every F.
struct StableNeoHookeanLaw : NeoHookeanFamily<StableNeoHookeanLaw> {
  StableNeoHookeanLaw(double mu, double lambda)
      : m(4.0 / 3 * mu), l(lambda + 5.0 / 6 * mu), a(1 + m / l - m / (4 * l)), shift(l * (1 - a)) {}

  template <class T>
  [[gnu::always_inline]] void Coefficients(const T& I1, const T& J, T& A, T& A2, T& B, T& B2) const {
    const T q = 1.0 / (I1 + 1.0);
    A = m - m * q;
    A2 = 2.0 * m * (q * q);
    B = l * (J - 1.0) + shift;
    B2 = l + (J - J);
  }
  template <class T>
  [[gnu::always_inline]] T Energy(const T& I1, const T& J) const {
    const T j = J - 1.0;  // written about the rest state: no difference of large numbers there
    return 0.5 * m * ((I1 - 3.0) - Log(0.25 * (I1 + 1.0))) + j * (0.5 * l * j + shift);
  }

  double m, l, a;  // Pa, Pa, 1
  double shift;    // Pa, l (1 - a): g'(J) at rest
};

/// Psi = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2 for J > 0, infinite elsewhere.
struct NeoHookeanLaw : NeoHookeanFamily<NeoHookeanLaw> {
  NeoHookeanLaw(double mu_, double lambda_) : mu(mu_), lambda(lambda_) {}

  template <class T>
  [[gnu::always_inline]] void Coefficients(const T& I1, const T& J, T& A, T& A2, T& B, T& B2) const {
    const T tiny = (J - J) + 1e-100;  // keeps the numbers finite; Energy() refuses the state
    const T safe = J > tiny ? J : tiny;
    const T q = 1.0 / safe;
    const T log = Log(safe);
    A = mu + (I1 - I1);
    A2 = I1 - I1;
    B = (lambda * log - mu) * q;
    B2 = (lambda + mu - lambda * log) * (q * q);
  }
  template <class T>
  [[gnu::always_inline]] T Energy(const T& I1, const T& J) const {
    const T zero = J - J;
    const T log = Log(J > zero ? J : zero + 1.0);
    const T energy = 0.5 * mu * (I1 - 3.0) + log * (0.5 * lambda * log - mu);
    return J > zero ? energy : zero + __builtin_inf();
  }

  double mu, lambda;  // Pa
};

/// Psi = lambda/2 (tr E)^2 + mu E:E, E = (F^T F - I) / 2; second Piola stress S = lambda tr(E) I + 2 mu E.
struct StVenantKirchhoffLaw {
  static constexpr int kTangentSize = 15;  // F, S (xx yy zz xy xz yz)

  StVenantKirchhoffLaw(double mu_, double lambda_) : mu(mu_), lambda(lambda_) {}

  template <class T>
  [[gnu::always_inline]] T SecondPiola(const T* F, T* S) const {
    T E[6];
    for (int a = 0; a < 3; ++a) E[a] = 0.5 * ((F[a] * F[a] + F[3 + a] * F[3 + a] + F[6 + a] * F[6 + a]) - 1.0);
    E[3] = 0.5 * (F[0] * F[1] + F[3] * F[4] + F[6] * F[7]);
    E[4] = 0.5 * (F[0] * F[2] + F[3] * F[5] + F[6] * F[8]);
    E[5] = 0.5 * (F[1] * F[2] + F[4] * F[5] + F[7] * F[8]);
    const T trace = E[0] + E[1] + E[2];
    for (int a = 0; a < 6; ++a) S[a] = 2.0 * mu * E[a];
    for (int a = 0; a < 3; ++a) S[a] += lambda * trace;
    const T square = (E[0] * E[0] + E[1] * E[1] + E[2] * E[2]) + 2.0 * (E[3] * E[3] + E[4] * E[4] + E[5] * E[5]);
    return 0.5 * lambda * trace * trace + mu * square;
  }

  template <class T>
  [[gnu::always_inline]] static void TimesSymmetric(const T* M, const T* S, T* P) {
    for (int i = 0; i < 9; i += 3) {
      P[i] = M[i] * S[0] + M[i + 1] * S[3] + M[i + 2] * S[4];
      P[i + 1] = M[i] * S[3] + M[i + 1] * S[1] + M[i + 2] * S[5];
      P[i + 2] = M[i] * S[4] + M[i + 1] * S[5] + M[i + 2] * S[2];
    }
  }

  template <class T>
  [[gnu::always_inline]] T Stress(const T* F, T* P) const {
    T S[6];
    const T energy = SecondPiola(F, S);
    TimesSymmetric(F, S, P);
    return energy;
  }

  template <class T>
  [[gnu::always_inline]] void Linearise(const T* F, T* s, bool filtered) const {
    for (int i = 0; i < 9; ++i) s[i] = F[i];
    T* S = s + 9;
    SecondPiola(F, S);
    if (filtered) {
      // Psi'' = dF S : dF + a square. Lift S by its most negative eigenvalue (bounded by Samuelson's inequality).
      const T mean = (S[0] + S[1] + S[2]) * (1.0 / 3);
      const T x = S[0] - mean, y = S[1] - mean, z = S[2] - mean, zero = mean - mean;
      const T variance = ((x * x + y * y + z * z) + 2.0 * (S[3] * S[3] + S[4] * S[4] + S[5] * S[5])) * (1.0 / 3);
      const T lift = Larger(Sqrt(2.0 * variance) - mean, zero);
      for (int a = 0; a < 3; ++a) S[a] += lift;
    }
  }

  template <class T>
  [[gnu::always_inline]] void Differential(const T* s, const T* dF, T* dP) const {
    using Number = typename NumberOf<T>::type;
    const T *F = s, *S = s + 9;
    T dE[6], dS[6], FdS[9];
    for (int a = 0; a < 3; ++a) dE[a] = F[a] * dF[a] + F[3 + a] * dF[3 + a] + F[6 + a] * dF[6 + a];
    const int row[3] = {0, 0, 1}, column[3] = {1, 2, 2};
    for (int n = 0; n < 3; ++n) {
      const int a = row[n], b = column[n];
      dE[3 + n] = Number(0.5) * ((F[a] * dF[b] + F[3 + a] * dF[3 + b] + F[6 + a] * dF[6 + b]) +
                                 (F[b] * dF[a] + F[3 + b] * dF[3 + a] + F[6 + b] * dF[6 + a]));
    }
    const T trace = Number(lambda) * (dE[0] + dE[1] + dE[2]);
    for (int a = 0; a < 6; ++a) dS[a] = Number(2.0 * mu) * dE[a];
    for (int a = 0; a < 3; ++a) dS[a] += trace;
    TimesSymmetric(dF, S, dP);
    TimesSymmetric(F, dS, FdS);
    for (int i = 0; i < 9; ++i) dP[i] += FdS[i];
  }

  template <class T>
  [[gnu::always_inline]] void Block(const T* s, const T* g, const T* h, T* block) const {
    const T *F = s, *S = s + 9;
    T Fg[3], Fh[3], Sh[3];
    Times(F, g, Fg);
    Times(F, h, Fh);
    Sh[0] = S[0] * h[0] + S[3] * h[1] + S[4] * h[2];
    Sh[1] = S[3] * h[0] + S[1] * h[1] + S[5] * h[2];
    Sh[2] = S[4] * h[0] + S[5] * h[1] + S[2] * h[2];
    const T diagonal = g[0] * Sh[0] + g[1] * Sh[1] + g[2] * Sh[2];
    const T gh = mu * (g[0] * h[0] + g[1] * h[1] + g[2] * h[2]);
    for (int i = 0; i < 3; ++i) {
      for (int l = 0; l < 3; ++l) {
        const T FFt = F[3 * i] * F[3 * l] + F[3 * i + 1] * F[3 * l + 1] + F[3 * i + 2] * F[3 * l + 2];
        block[3 * i + l] = lambda * Fg[i] * Fh[l] + mu * Fh[i] * Fg[l] + gh * FFt;
      }
      block[4 * i] += diagonal;
    }
  }

  double mu, lambda;  // Pa
};

/// Small strain: Psi = lambda/2 (tr e)^2 + mu e:e, e = (F + F^T) / 2 - I. Not objective; for the study.
struct LinearLaw {
  static constexpr int kTangentSize = 1;  // nothing: the tangent is constant

  LinearLaw(double mu_, double lambda_) : mu(mu_), lambda(lambda_) {}

  template <class T>
  [[gnu::always_inline]] T Stress(const T* F, T* P) const {
    T e[9];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) e[3 * i + j] = 0.5 * (F[3 * i + j] + F[3 * j + i]) - (i == j ? 1.0 : 0.0);
    }
    const T trace = e[0] + e[4] + e[8];
    for (int i = 0; i < 9; ++i) P[i] = 2.0 * mu * e[i];
    for (int i = 0; i < 9; i += 4) P[i] += lambda * trace;
    return 0.5 * lambda * trace * trace + mu * Dot9(e, e);
  }
  template <class T>
  [[gnu::always_inline]] void Linearise(const T* F, T* s, bool) const {
    s[0] = F[0] - F[0];
  }
  template <class T>
  [[gnu::always_inline]] void Differential(const T*, const T* dF, T* dP) const {
    using Number = typename NumberOf<T>::type;
    const T trace = Number(lambda) * (dF[0] + dF[4] + dF[8]);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) dP[3 * i + j] = Number(mu) * (dF[3 * i + j] + dF[3 * j + i]);
      dP[4 * i] += trace;
    }
  }
  template <class T>
  [[gnu::always_inline]] void Block(const T*, const T* g, const T* h, T* block) const {
    const T gh = mu * (g[0] * h[0] + g[1] * h[1] + g[2] * h[2]);
    for (int i = 0; i < 3; ++i) {
      for (int l = 0; l < 3; ++l) block[3 * i + l] = lambda * g[i] * h[l] + mu * h[i] * g[l];
      block[4 * i] += gh;
    }
  }

  double mu, lambda;  // Pa
};
