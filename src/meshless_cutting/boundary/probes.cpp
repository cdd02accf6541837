#include "boundary/probes.h"

#include <limits>
#include <stdexcept>

namespace meshless_cutting {
namespace {

/// A vertex counts as being on a side when it is farther to it than this share of the lattice size.
constexpr double kBeside = 0.2;

}  // namespace

Probes::Probes(const Scene& scene, const Lattice& lattice, const IntegrationPoints& points, const ShapeFunctions& shape,
               const Tissue& tissue)
    : scene_(scene), mapping_(points, shape, tissue) {
  for (std::size_t i = 0; i < scene.probes.size(); ++i) {
    const ProbeConfig& probe = scene.probes[i];
    int anchor = -1;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < lattice.vertices.size(); ++v) {
      const Eigen::Vector3d way = lattice.vertices[v] - probe.position;
      const bool on_side = probe.side.isZero() || way.dot(probe.side) > kBeside * scene.object.lattice_size_m;
      if (!on_side || way.squaredNorm() >= nearest) continue;
      nearest = way.squaredNorm();
      anchor = static_cast<int>(v);
    }
    if (anchor < 0 || nearest > 4 * scene.object.cell_size_m * scene.object.cell_size_m) {
      throw std::runtime_error(SceneMessage(scene, "probes[" + std::to_string(i) + "]", "",
                                            "lies farther than two cells from the object; expected a point of it, in the "
                                            "object frame, m"));
    }
    mapping_.Add(probe.position, anchor);
    readings_.push_back({probe.name, {}, {}});
  }
  TissueChanged();
}

void Probes::TissueChanged() {
  for (int v = 0; v < mapping_.size(); ++v) mapping_.MapInside(v);
}

const std::vector<ProbeReading>& Probes::Read(const TissueState& state) {
  for (int v = 0; v < mapping_.size(); ++v) {
    readings_[v].position = mapping_.Position(v, state.position);
    readings_[v].displacement = readings_[v].position - scene_.object.T_WO * mapping_.rest(v);
  }
  return readings_;
}

}  // namespace meshless_cutting
