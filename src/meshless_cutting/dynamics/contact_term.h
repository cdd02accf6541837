// Skin vertices against obstacles: a penalty on penetration, Coulomb friction that sticks, and a little damping.
#pragma once

#include <vector>

#include "dynamics/contact_skin.h"
#include "dynamics/force_term.h"
#include "dynamics/obstacle.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

/// What contact needs to know of the object to choose its stiffness.
struct ContactScale {
  double modulus_pa = 0;       // P-wave modulus
  double cell_m = 0;           // edge of a cell of the background grid
  double own_pressure_pa = 0;  // density times gravity times the object's size
};

/// Per vertex, with gap s along the normal n of the face that holds it, way t along the face from where it stuck:
///   k/2 min(s, 0)^2                                   stiffness k = (stiffness per area) (share of the surface)
///   k/2 |t|^2 up to |t| = mu N / k, then linear        N: normal force at the end of the last step
///   k tau / (2 dt) |d|^2                               d: way during this step, along n where the vertex touched at the end of the
///                                                      last step, all of it where it stuck
/// all convex. Friction is a spring that yields (not a smoothed sign of the velocity), so that what lies on a slope stays.
///
/// Whatever the scheme, these are taken at the end of the step, x1 = x0 + (y - x0) / stage: a force that is found at the stage
/// alone lets a fast vertex go on through the surface in the rest of the step. The potential is stage Phi(x1(y)), whose
/// gradient by y is the force Phi'(x1).
class ContactTerm : public ForceTerm {
 public:
  ContactTerm(const std::vector<ObstacleConfig>& obstacles, const ContactScale& scale);

  /// Before BeginStep; `skin` must stay until EndStep. `changed`: its weights or particles are not those of the last step.
  void SetSkin(const SurfacePoints& skin, int particles, bool changed);

  void BeginStep(const StageMotion& motion) override;
  double Evaluate(const Field& y, Field& gradient) override;
  void Linearise(const Field& y) override;
  bool HasTangent() const override { return !active_.empty(); }
  void AddProduct(const Field& p, Field& q) override;
  void AddDiagonal(BlockField& blocks) override;
  void AddCoarse(CoarseMatrix& matrix) override;
  void EndStep(const Field& y) override;

  /// No vertex can touch during this step.
  bool IsFar() const { return candidates_.empty(); }

  /// Vertices that touched at the end of the last step.
  int contact_count() const { return contact_count_; }
  double stiffness_per_area() const { return stiffness_per_area_; }  // Pa/m

 private:
  /// A vertex that may touch during this step.
  struct Candidate {
    int vertex, obstacle, face;
    double stiffness;        // N/m
    double friction_force;   // N, mu times the normal force of the last step
    bool touched, stuck;     // at the end of the last step
    Eigen::Vector3d anchor;  // m, where friction holds it
    Eigen::Vector3d start;   // m, at the start of the step
  };
  /// What a vertex remembers of the last step; of step `step` only.
  struct Memory {
    std::int64_t step = -1;
    int obstacle = 0, face = Obstacle::kNoFace;
    double normal_force = 0;  // N
    bool stuck = false;       // friction held it
    Eigen::Vector3d anchor = Eigen::Vector3d::Zero();
  };

  Eigen::Matrix3d TangentOf(const Candidate& c, const Eigen::Vector3d& x) const;
  Eigen::Vector3d PositionOf(int vertex, const Field& y) const;
  Eigen::Vector3d EndOf(const Candidate& c, const Field& y) const;
  void AddCandidate(int vertex, int obstacle, const StageMotion& motion);

  std::vector<Obstacle> obstacles_;
  double stiffness_per_area_, cell_;
  const SurfacePoints* skin_ = nullptr;
  ContactSkin arranged_;
  std::vector<Memory> memory_;
  std::vector<Candidate> candidates_;
  std::vector<int> active_;  // candidates with a tangent
  std::vector<Eigen::Matrix3d> active_tangent_;
  double stage_ = 1;
  double damping_per_stiffness_ = 0;  // tau / dt
  std::int64_t step_ = 0;             // steps ended
  int contact_count_ = 0;
};

}  // namespace meshless_cutting
