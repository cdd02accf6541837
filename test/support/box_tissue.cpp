#include "support/box_tissue.h"

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>

namespace meshless_cutting {

int BoxParticle(const BoxTissueConfig& config, int i, int j, int k) {
  return (k * (config.cells.y() + 1) + j) * (config.cells.x() + 1) + i;
}

Tissue MakeBoxTissue(const BoxTissueConfig& config) {
  Tissue tissue;
  tissue.support_size = 8;
  const Eigen::Vector3i n = config.cells;
  const Eigen::Vector3d h = config.size.cwiseQuotient(n.cast<double>());
  for (int k = 0; k <= n.z(); ++k) {
    for (int j = 0; j <= n.y(); ++j) {
      for (int i = 0; i <= n.x(); ++i) {
        tissue.particle_rest.push_back(Eigen::Vector3d(i, j, k).cwiseProduct(h));
        tissue.particle_fixed.push_back(config.clamp_x0 && i == 0);
      }
    }
  }
  tissue.particle_mass.assign(tissue.particle_rest.size(), 0);
  const double volume = h.prod();
  for (int k = 0; k < n.z(); ++k) {
    for (int j = 0; j < n.y(); ++j) {
      for (int i = 0; i < n.x(); ++i) {
        tissue.point_volume.push_back(volume);
        tissue.point_rest.push_back((Eigen::Vector3d(i, j, k) + Eigen::Vector3d::Constant(0.5)).cwiseProduct(h));
        for (int corner = 0; corner < 8; ++corner) {
          const int a = corner & 1, b = corner >> 1 & 1, c = corner >> 2 & 1;
          const int particle = BoxParticle(config, i + a, j + b, k + c);
          tissue.point_particles.push_back(particle);
          tissue.point_gradients.push_back(
              0.25 * Eigen::Vector3d(a ? 1 : -1, b ? 1 : -1, c ? 1 : -1).cwiseQuotient(h));
          tissue.particle_mass[particle] += config.density_kg_m3 * volume / 8;
        }
      }
    }
  }
  return tissue;
}

TissueState RestState(const Tissue& tissue) {
  TissueState state;
  state.position = tissue.particle_rest;
  state.velocity.assign(tissue.particle_rest.size(), Eigen::Vector3d::Zero());
  state.acceleration = state.velocity;
  return state;
}

SurfacePoints MakeBoxSkin(const BoxTissueConfig& config) {
  SurfacePoints skin;
  skin.support_size = 1;
  const Eigen::Vector3i n = config.cells;
  for (int k = 0; k <= n.z(); ++k) {
    for (int j = 0; j <= n.y(); ++j) {
      for (int i = 0; i <= n.x(); ++i) {
        if (i % n.x() != 0 && j % n.y() != 0 && k % n.z() != 0) continue;
        skin.particles.push_back(BoxParticle(config, i, j, k));
        skin.weights.push_back(1);
      }
    }
  }
  return skin;
}

Tissue WidenSupports(const Tissue& tissue, int support_size) {
  Tissue wide = tissue;
  wide.support_size = support_size;
  wide.point_particles.clear();
  wide.point_gradients.clear();
  std::vector<int> order(tissue.particle_count());
  for (int p = 0; p < tissue.point_count(); ++p) {
    std::iota(order.begin(), order.end(), 0);
    const auto distance = [&](int j) { return (tissue.particle_rest[j] - tissue.point_rest[p]).squaredNorm(); };
    std::partial_sort(order.begin(), order.begin() + support_size, order.end(), [&](int a, int b) {
      const double da = distance(a), db = distance(b);
      return std::abs(da - db) > 1e-12 * (da + db) ? da < db : a < b;
    });
    Eigen::Matrix4d moment = Eigen::Matrix4d::Zero();
    for (int k = 0; k < support_size; ++k) {
      const Eigen::Vector4d basis((tissue.particle_rest[order[k]] - tissue.point_rest[p]).homogeneous());
      moment += basis * basis.transpose();
    }
    const Eigen::Matrix4d inverse = moment.inverse();
    for (int k = 0; k < support_size; ++k) {
      const Eigen::Vector4d basis((tissue.particle_rest[order[k]] - tissue.point_rest[p]).homogeneous());
      wide.point_particles.push_back(order[k]);
      wide.point_gradients.push_back((inverse * basis).head<3>());
    }
  }
  return wide;
}

}  // namespace meshless_cutting
