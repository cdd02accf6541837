// A box of equal cells as tissue, for tests of the dynamics without a mesh.
#pragma once

#include <Eigen/Core>

#include "tissue/tissue.h"

namespace meshless_cutting {

/// cells(0) x cells(1) x cells(2) cells on [0, size]; particles at the corners, x fastest; one integration point per cell with the
/// gradients of its trilinear functions at the centre; an eighth of a cell's mass to each corner.
struct BoxTissueConfig {
  Eigen::Vector3i cells = Eigen::Vector3i(4, 4, 4);
  Eigen::Vector3d size = Eigen::Vector3d(0.1, 0.1, 0.1);  // m
  double density_kg_m3 = 1000;
  bool clamp_x0 = false;  // holds the particles at x = 0
};
Tissue MakeBoxTissue(const BoxTissueConfig& config);

/// Index of the particle at grid position (i, j, k).
int BoxParticle(const BoxTissueConfig& config, int i, int j, int k);

/// At rest in its rest position.
TissueState RestState(const Tissue& tissue);

/// One vertex on every particle of the surface of the box.
SurfacePoints MakeBoxSkin(const BoxTissueConfig& config);

/// The same tissue with every support padded to `support_size` by the nearest other particles and gradients of moving least squares
/// with equal weights: takes the loops for general supports.
Tissue WidenSupports(const Tissue& tissue, int support_size);

}  // namespace meshless_cutting
