// Points of the tissue whose displacement is recorded.
#pragma once

#include <string>
#include <vector>

#include "cut/integration_points.h"
#include "scene/scene.h"
#include "surface/vertex_mapping.h"

namespace meshless_cutting {

/// Scene frame, m. Displacement is against where the point was placed at the start.
struct ProbeReading {
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();
};

/// A probe belongs to the material of a lattice vertex: the nearest, among those on its `side` if it names one. It follows
/// the integration point of the cell that it lies in if the graph joins the two, else the nearest that is joined.
class Probes {
 public:
  Probes(const Scene& scene, const Lattice& lattice, const IntegrationPoints& points, const ShapeFunctions& shape,
         const Tissue& tissue);

  void TissueChanged();
  const std::vector<ProbeReading>& Read(const TissueState& state);

 private:
  const Scene& scene_;
  VertexMapping mapping_;
  std::vector<ProbeReading> readings_;
};

}  // namespace meshless_cutting
