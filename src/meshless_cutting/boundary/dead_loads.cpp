#include "boundary/dead_loads.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace meshless_cutting {
namespace {

/// Vertices on the face of a box belong to it.
constexpr double kSlackShare = 1e-6;

}  // namespace

int DeadLoads::TissueChanged(const Tissue& tissue, const Surface& surface, const SurfacePoints& mapping) {
  const std::vector<LoadRegion>& loads = scene_.object.loads;
  const std::size_t K = static_cast<std::size_t>(mapping.support_size);
  forces_.assign(tissue.particle_rest.size(), Eigen::Vector3d::Zero());
  shares_.assign(loads.size(), {});
  area_.assign(loads.size(), 0);
  int missed = -1;
  std::vector<double> per_vertex(surface.rest_positions.size());
  for (std::size_t i = 0; i < loads.size(); ++i) {
    std::fill(per_vertex.begin(), per_vertex.end(), 0);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      if (surface.region[t] != SurfaceRegion::kSkin) continue;
      const auto& v = surface.triangles[t];
      const Eigen::Vector3d &a = surface.rest_positions[v[0]], &b = surface.rest_positions[v[1]],
                            &c = surface.rest_positions[v[2]];
      const double slack = kSlackShare * scene_.object.cell_size_m;
      const Box& box = loads[i].box;
      if (!box.Holds(a, slack) || !box.Holds(b, slack) || !box.Holds(c, slack)) continue;
      const double area = 0.5 * (b - a).cross(c - a).norm();
      area_[i] += area;
      for (const auto vertex : v) per_vertex[vertex] += area / 3;
    }
    if (!(area_[i] > 0)) missed = static_cast<int>(i);
    for (std::size_t v = 0; v < per_vertex.size(); ++v) {
      if (per_vertex[v] == 0) continue;
      for (std::size_t k = 0; k < K; ++k) {
        shares_[i].push_back({mapping.particles[v * K + k], per_vertex[v] * mapping.weights[v * K + k]});
      }
    }
    // One entry per particle.
    std::vector<Share>& shares = shares_[i];
    std::stable_sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) { return a.particle < b.particle; });
    std::size_t kept = 0;
    for (std::size_t n = 0; n < shares.size(); ++n) {
      if (kept > 0 && shares[kept - 1].particle == shares[n].particle) {
        shares[kept - 1].area += shares[n].area;
      } else {
        shares[kept++] = shares[n];
      }
    }
    shares.resize(kept);
  }
  return missed;
}

const std::vector<Eigen::Vector3d>& DeadLoads::At(double time_s) {
  std::fill(forces_.begin(), forces_.end(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    const LoadRegion& load = scene_.object.loads[i];
    Eigen::Vector3d traction = scene_.object.T_WO.linear() * load.load.At(time_s);  // Pa
    if (!load.is_traction) traction /= area_[i];
    for (const Share& share : shares_[i]) forces_[share.particle] += share.area * traction;
  }
  return forces_;
}

}  // namespace meshless_cutting
