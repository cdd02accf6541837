#include "tissue/materials.h"

#include <cmath>
#include <stdexcept>

namespace meshless_cutting {
namespace {

double Log(double x) { return std::log(x); }
double Sqrt(double x) { return std::sqrt(x); }

#include "tissue/material_laws.inl"

/// Row-major copy, as the laws want it.
struct RowMajor {
  explicit RowMajor(const Eigen::Matrix3d& F) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) data[3 * i + j] = F(i, j);
    }
  }
  double data[9];
};

Eigen::Matrix3d FromRowMajor(const double* P) { return Eigen::Map<const Eigen::Matrix3d>(P).transpose(); }

template <class Law>
class MaterialOf : public Material {
 public:
  explicit MaterialOf(const LameConstants& lame) : law_(lame.mu, lame.lambda) {}

  double Energy(const Eigen::Matrix3d& F) const override {
    double P[9];
    return law_.Stress(RowMajor(F).data, P);
  }
  Eigen::Matrix3d Stress(const Eigen::Matrix3d& F) const override {
    double P[9];
    law_.Stress(RowMajor(F).data, P);
    return FromRowMajor(P);
  }
  Eigen::Matrix3d StressDifferential(const Eigen::Matrix3d& F, const Eigen::Matrix3d& dF) const override {
    return Differential(F, dF, false);
  }
  Eigen::Matrix3d FilteredStressDifferential(const Eigen::Matrix3d& F, const Eigen::Matrix3d& dF) const override {
    return Differential(F, dF, true);
  }

 private:
  Eigen::Matrix3d Differential(const Eigen::Matrix3d& F, const Eigen::Matrix3d& dF, bool filtered) const {
    double tangent[Law::kTangentSize], dP[9];
    law_.Linearise(RowMajor(F).data, tangent, filtered);
    law_.Differential(tangent, RowMajor(dF).data, dP);
    return FromRowMajor(dP);
  }

  Law law_;
};

}  // namespace

LameConstants LameConstantsOf(const MaterialConfig& material) {
  const double E = material.youngs_modulus_pa, nu = material.poisson_ratio;
  return {E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))};
}

std::unique_ptr<Material> MakeMaterial(const MaterialConfig& config) {
  const LameConstants lame = LameConstantsOf(config);
  switch (config.model) {
    case MaterialModel::kStableNeoHookean:
      return std::make_unique<MaterialOf<StableNeoHookeanLaw>>(lame);
    case MaterialModel::kNeoHookean:
      return std::make_unique<MaterialOf<NeoHookeanLaw>>(lame);
    case MaterialModel::kStVenantKirchhoff:
      return std::make_unique<MaterialOf<StVenantKirchhoffLaw>>(lame);
    case MaterialModel::kLinear:
      return std::make_unique<MaterialOf<LinearLaw>>(lame);
  }
  throw std::invalid_argument("unknown material model");
}

}  // namespace meshless_cutting
