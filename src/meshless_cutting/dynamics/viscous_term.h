// Viscoelastic damping: a Prony series of Maxwell branches beside the elastic law, per integration point.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/force_term.h"
#include "dynamics/thread_pool.h"
#include "scene/scene.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

/// Linear viscoelasticity of the deviatoric Green-Lagrange strain D = dev((F^T F - I) / 2), in the reference frame and therefore
/// objective (Simo 1987; Simo and Hughes 1998, chapter 10). Branch i of shear modulus g_i mu remembers the strain q_i of its spring,
///   dq_i/dt + q_i / tau_i = dD/dt,   second Piola stress of all branches 2 mu sum_i g_i q_i.
/// The law of the material is what is left when all branches have relaxed: a stretch that is held relaxes as
/// 1 + sum g_i exp(-t / tau_i), volume changes meet no branch. Stored energy mu sum_i g_i |q_i|^2.
///
/// Time: exact for a strain that changes at a constant rate (Taylor, Pister and Goudreau 1970), q_i <- a_i q_i + c_i (D1 - D0) with
/// a = exp(-dt / tau), c = (1 - a) tau / dt: stable for any step. To Newton it is the potential
/// mu c |D|^2 + 2 mu B : D, B what the history gives; its tangent is exact but that a negative eigenvalue of the stress is lifted to zero.
class ViscousTerm : public ForceTerm {
 public:
  /// One material per value of Tissue::point_material. `pool` must outlive this.
  ViscousTerm(const std::vector<MaterialConfig>& materials, ThreadPool& pool);

  static bool IsNeeded(const std::vector<MaterialConfig>& materials);
  /// Largest sum of mu g_i over the branches of a material, Pa: by so much are quick changes of shape stiffer.
  double instantaneous_shear_pa() const { return instantaneous_shear_; }

  /// After a cut: a new point inherits the strains of the point that it was split from.
  void TissueChanged(const Tissue& tissue);

  // A frame that is repeated in halves begins with the strains that it had: Keep() at its start, Restore() before each attempt.
  void Keep() { kept_ = strain_; }
  void Restore() { strain_ = kept_; }

  /// Whether the branches are so far relaxed that an object may sleep.
  bool IsRelaxed() const;
  /// Energy in the branches, J: now, and if the step that has begun ended at x.
  double StoredEnergy() const;
  double StoredEnergyAt(const Field& x) const;
  /// Adds the gradient of what the branches hold at x, N.
  void AddForce(const Field& x, Field& gradient);

  void BeginStep(const StageMotion& motion) override;
  double Evaluate(const Field& y, Field& gradient) override;
  void Linearise(const Field& y) override;
  bool HasTangent() const override { return true; }
  void AddProduct(const Field& p, Field& q) override;
  void AddDiagonal(BlockField& blocks) override;
  /// The coarse space of the preconditioner does without: it is an approximation anyhow.
  void AddCoarse(CoarseMatrix&) override {}
  void EndStep(const Field& y) override;

 private:
  struct Strain {
    double value[6] = {};  // xx yy zz xy xz yz
  };
  struct Branch {
    double ratio, time_s;
  };
  struct Series {  // of one material
    double mu = 0;  // Pa
    std::vector<Branch> branches;
  };
  /// One point that has branches.
  struct Point {
    int index = 0;     // in the tissue
    int material = 0;
    double volume = 0;  // m^3
  };
  /// What the step in progress makes of a branch: over the step, and as far as its stage.
  struct Factors {
    double keep = 0, gain = 0, keep_at_stage = 0, gain_at_stage = 0;
  };
  void Gradient(int n, const Field& x, double* F) const;
  Strain DeviatoricStrain(int n, const Field& x) const;
  /// Sums what the loop over points left for each particle.
  void Gather(Field& to);
  void Scatter(int n, const double* P);
  template <class Task>
  void ForEachPoint(const Task& task);
  double SumOfChunks() const;

  ThreadPool& pool_;
  std::vector<Series> series_;  // per material
  double instantaneous_shear_ = 0;

  int support_ = 8;
  std::vector<Point> points_;
  std::vector<int> particle_;   // [point][K]
  Field gradient_;              // [point][K], 1/m
  std::vector<int> begin_, at_;  // of each particle: entries of the two above
  Field slots_;                 // [point][K], N
  std::vector<double> chunk_energy_;

  std::vector<std::size_t> branch_begin_;  // per point of the tissue, and the end: its strains in strain_
  std::vector<Strain> strain_, kept_;      // q_i at the start of the step, of the frame

  // Of the step in progress.
  StageMotion motion_;
  std::vector<std::vector<Factors>> factors_;  // per material, per branch
  std::vector<double> gain_;                   // per material: sum of g_i c_i at the stage
  std::vector<Strain> start_, history_;        // per point: D0; B

  struct Tangent {
    double data[15];  // as StVenantKirchhoffLaw
  };
  std::vector<Tangent> tangent_;
};

}  // namespace meshless_cutting
