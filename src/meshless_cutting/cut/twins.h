// Particles and their twins: which particle each integration point uses at each node of its support.
#pragma once

#include <vector>

#include "cut/integration_points.h"
#include "scene/scene.h"
#include "tissue/material_regions.h"
#include "tissue/shape_functions.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

/// An integration point sees a particle that it reaches through material inside the particle's support. Where the
/// points in the support of a node fall apart into groups that share no material there, each group has a particle of
/// its own at that node, a twin. So every point always has its full set, moment matrices never become singular, and a
/// cut is a re-indexing.
///
/// A node in a box that is fixed or prescribed holds its particle. Where material falls apart there, it holds the groups that reach
/// into the box, not what is cut off beside it, which would hang on a wall that it does not touch; if none does, all of them.
///
/// Mass is lumped with the shape functions of the centre of a cell, a little further in where the boundary is near: lumping alone makes
/// moments of inertia too large by what a layer of h / 12 at the surface holds. Shares are those at load: the parts of a cut point add up to
/// what the point gave to each particle, and a cut keeps mass, momentum and angular momentum to rounding.
class Twins {
 public:
  /// Fills `tissue` at load.
  Twins(const Lattice& lattice, const BackgroundGrid& grid, const ShapeFunctions& shape,
        const IntegrationPoints& points, const ObjectConfig& config, Tissue& tissue);

  /// Call after IntegrationPoints::Update with the points that it returned. New particles start as copies of what they
  /// were split from: `source` gets one entry per new particle, the particle to copy. Returns the points whose links or
  /// shape functions changed, sorted.
  const std::vector<int>& Update(const std::vector<int>& changed_points, Tissue& tissue, std::vector<int>& source);

  /// The boxes whose nodes are held, fixed or prescribed; object frame.
  const std::vector<Box>& held() const { return held_; }

 private:
  void FillPoint(int p, Tissue& tissue);
  /// Where the mass of a point is lumped at load, m, object frame.
  Eigen::Vector3d CentreOfLumping(int p) const;
  bool IsIn(const Box& box, const Eigen::Vector3d& X) const;
  /// Whether a lattice vertex of the point's material lies in one of the boxes.
  bool ReachesInto(int point, const std::vector<const Box*>& boxes) const;
  void SplitNode(int node, Tissue& tissue, std::vector<int>& source);
  void LumpMass(Tissue& tissue) const;

  const Lattice* lattice_;
  const BackgroundGrid* grid_;
  const ShapeFunctions* shape_;
  const IntegrationPoints* points_;
  MaterialRegions materials_;
  std::vector<Box> held_;  // fixed and prescribed regions
  std::vector<double> mass_share_;  // K per point, sum 1: of its mass, to its particles
  std::vector<int> relinked_;
  std::vector<int> member_of_;  // scratch of SplitNode: per point, -1 between calls
};

}  // namespace meshless_cutting
