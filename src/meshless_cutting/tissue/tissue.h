// The meshless tissue: particles, integration points and what joins them. Written at load and at a cut, read by the dynamics.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace meshless_cutting {

/// The discretised object of element-free Galerkin, total Lagrangian. Point p integrates the strain energy of volume V_p at
/// the rest position X_p with F = sum_k x_jk (x) dphi_k/dX over its `support_size` particles.
/// A cut changes links and volumes of a few points and adds particles (twins) and points; nothing is ever removed.
struct Tissue {
  int support_size = 8;  // K, particles per integration point, the same for all

  // Particles, j.
  std::vector<Eigen::Vector3d> particle_rest;  // X_j, m, object frame; twins share it
  std::vector<double> particle_mass;           // kg, lumped from the points
  std::vector<std::uint8_t> particle_fixed;    // 1: held where it is

  // Integration points, p; K entries per point in the two arrays of links.
  std::vector<int> point_material;              // 0, or 1 + region; empty: all 0
  std::vector<double> point_volume;             // V_p, m^3, at rest
  std::vector<Eigen::Vector3d> point_rest;      // X_p, m, object frame: centroid of the material of the point
  std::vector<int> point_particles;             // K per point
  std::vector<Eigen::Vector3d> point_gradients;  // K per point, dphi/dX at X_p, 1/m

  std::vector<int> point_origin;                 // the point that it was split from, lower than its own index, or -1; empty: all -1

  int origin(int p) const { return point_origin.empty() ? -1 : point_origin[p]; }
  int material(int p) const { return point_material.empty() ? 0 : point_material[p]; }

  std::uint64_t version = 0;  // +1 whenever anything above changed

  int particle_count() const { return static_cast<int>(particle_rest.size()); }
  int point_count() const { return static_cast<int>(point_volume.size()); }
};

/// Positions and velocities of the particles, scene frame.
struct TissueState {
  std::vector<Eigen::Vector3d> position;      // x_j, m
  std::vector<Eigen::Vector3d> velocity;      // v_j, m/s
  std::vector<Eigen::Vector3d> acceleration;  // a_j, m/s^2 at the end of the last step, for schemes that need it
};

/// Vertices that follow the tissue: x_v = sum_k phi_k x_jk, K entries per vertex. Contact acts on these.
struct SurfacePoints {
  int support_size = 8;
  std::vector<int> particles;    // K per vertex
  std::vector<double> weights;   // K per vertex, sum 1
  int count() const { return static_cast<int>(particles.size()) / support_size; }
};

}  // namespace meshless_cutting
