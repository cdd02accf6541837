// Hyperelastic materials: what they are asked, one point at a time. Tests, tools and the set-up of the solver use this; the
// loops over points use the same laws (material_laws.inl), eight points at a time.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "scene/scene.h"

namespace meshless_cutting {

/// Constants of the laws. All laws of this program agree with linear elasticity of these at small strain.
struct LameConstants {
  double mu = 0;      // Pa, shear modulus
  double lambda = 0;  // Pa
};

/// From Young's modulus E and Poisson's ratio nu: mu = E / (2 (1 + nu)), lambda = E nu / ((1 + nu) (1 - 2 nu)).
LameConstants LameConstantsOf(const MaterialConfig& material);

/// Strain energy density Psi(F) of a homogeneous isotropic solid and its derivatives; F is the deformation gradient.
class Material {
 public:
  virtual ~Material() = default;

  /// Psi(F), J/m^3, zero at F = I. +infinity where the law is not defined (neo-Hookean, J <= 0).
  virtual double Energy(const Eigen::Matrix3d& F) const = 0;

  /// First Piola-Kirchhoff stress P = dPsi/dF, Pa.
  virtual Eigen::Matrix3d Stress(const Eigen::Matrix3d& F) const = 0;

  /// dP = (d2Psi/dF2) : dF, Pa.
  virtual Eigen::Matrix3d StressDifferential(const Eigen::Matrix3d& F, const Eigen::Matrix3d& dF) const = 0;

  /// The same with a Hessian that is changed, where it must be, to be positive semidefinite: what Newton's method solves with.
  virtual Eigen::Matrix3d FilteredStressDifferential(const Eigen::Matrix3d& F, const Eigen::Matrix3d& dF) const = 0;
};

std::unique_ptr<Material> MakeMaterial(const MaterialConfig& config);

}  // namespace meshless_cutting
