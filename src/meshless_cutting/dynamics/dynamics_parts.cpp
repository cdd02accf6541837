#include "dynamics/dynamics_parts.h"

#include <algorithm>
#include <cmath>

namespace meshless_cutting {
namespace {

/// Energies below this share of modulus times volume are nothing to worry about.
constexpr double kEnergyFloor = 1e-3;

/// Differences of energies below this share of modulus times volume are rounding.
constexpr double kEnergyRounding = 1e-15;

/// Forces below this share of (shear modulus) (cross section of the object) are rounding.
constexpr double kForceRounding = 1e-8;

std::vector<MaterialConfig> MaterialsOf(const DynamicsConfig& config) {
  std::vector<MaterialConfig> materials{config.material};
  materials.insert(materials.end(), config.region_materials.begin(), config.region_materials.end());
  return materials;
}

/// Edge of the largest cell: the grid's, of which many are full.
double CellOf(const Tissue& tissue) {
  double volume = 0;
  for (double v : tissue.point_volume) volume = std::max(volume, v);
  return std::cbrt(volume);
}

ContactScale ContactScaleOf(const DynamicsConfig& config, const Tissue& tissue, const LameConstants& lame) {
  ContactScale scale;
  scale.modulus_pa = lame.lambda + 2 * lame.mu;
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& X : tissue.particle_rest) bounds.extend(X);
  scale.cell_m = CellOf(tissue);
  const double gravity = config.gravity_m_s2 ? config.gravity_m_s2->norm() : 0;
  scale.own_pressure_pa = config.material.density_kg_m3 * gravity * bounds.sizes().maxCoeff();
  return scale;
}

SolverChoice ChooseSolverFor(const DynamicsConfig& config, const Tissue& tissue, const LameConstants& stiffest,
                             double contact_stiffness, double instantaneous_shear) {
  SolverSituation situation;
  situation.cell_m = CellOf(tissue);
  situation.p_wave_modulus_pa = stiffest.lambda + 2 * stiffest.mu + 4.0 / 3 * instantaneous_shear;
  situation.density_kg_m3 = config.material.density_kg_m3;
  for (const MaterialConfig& material : config.region_materials) {
    situation.density_kg_m3 = std::min(situation.density_kg_m3, material.density_kg_m3);
  }
  situation.stiffness_damping_s = config.damping ? config.damping->stiffness_s : 0;
  situation.step_s = config.time_step_s / config.solver.sub_steps;
  situation.contact_ratio = contact_stiffness * situation.cell_m / situation.p_wave_modulus_pa;
  return ChooseSolver(config.solver, situation);
}

}  // namespace

Dynamics::Parts::Parts(const DynamicsConfig& config_, const Tissue& tissue)
    : config(config_),
      pool(config.solver.threads),
      points(MaterialsOf(config), config.stabilisation, pool),
      elastic(points),
      potential(elastic, terms, pool),
      newton(potential, config.solver.relative_tolerance, config.solver.newton_iterations) {
  if (!config.obstacles.empty()) {
    terms.push_back(&contact.emplace(config.obstacles, ContactScaleOf(config, tissue, points.lame())));
  }
  const std::vector<MaterialConfig> materials = MaterialsOf(config);
  if (ViscousTerm::IsNeeded(materials)) terms.push_back(&viscous.emplace(materials, pool));
  choice = ChooseSolverFor(config, tissue, points.lame(), contact ? contact->stiffness_per_area() : 0,
                           viscous ? viscous->instantaneous_shear_pa() : 0);
  if (choice.integrator == Integrator::kExplicit) {
    explicit_steps.emplace(points, terms, potential);
  } else if (config.damping) {
    elastic.SetDamping(config.damping->stiffness_s);
  }
}

void Dynamics::Parts::TissueChanged(const Tissue& tissue, const std::function<void()>& beside) {
  particles = tissue.particle_count();
  skin_changed = true;
  asleep = false;
  elastic_force_is = ElasticForceIs::kOfAnotherState;
  cell = CellOf(tissue);
  pool.ForEach(4, [&](int task) {  // the dearest first
    if (task == 0) beside();
    if (task == 1) {
      fragments.Build(tissue);
      grains.Build(tissue, fragments);
    }
    if (task == 2) {
      points.TissueChanged(tissue);
      elastic.TissueChanged();
    }
    if (task == 3) light.Build(tissue, cell);
  });
  for (ForceTerm* term : terms) term->TissueChanged(particles);
  if (viscous) viscous->TissueChanged(tissue);
  potential.Resize(particles);
  for (Field* field :
       {&position, &velocity, &acceleration, &start_position, &start_velocity, &start_acceleration, &end_position,
        &end_velocity, &end_acceleration, &stage, &steady, &still, &scratch, &elastic_force}) {
    ResizeWithRoom(*field, particles);
  }
  chunk_sums.resize(ChunkCount(particles, kParticlesPerChunk));
  for (int j = 0; j < particles; ++j) {
    // A particle without mass is one that all its points have left for a twin.
    potential.free[j] = !tissue.particle_fixed[j] && tissue.particle_mass[j] > 0 ? 1 : 0;
  }
  WeighFragments(tissue);
  double volume = 0;
  for (double v : tissue.point_volume) volume += v;
  newton.TissueChanged(tissue);
  const double modulus = points.lame().lambda + 2 * points.lame().mu;
  energy_floor = kEnergyFloor * modulus * volume;
  newton.SetEnergyRounding(kEnergyRounding * modulus * volume);
  driven.clear();
  driven_end.clear();
  force.clear();
  forces = 0;
  WeighLoad(tissue);
}

void Dynamics::Parts::WeighFragments(const Tissue& tissue) {
  // Each piece is a problem of its own. Measured by the forces in the largest, the residual of a small one would always
  // be small, and its motion whatever the solver happened to leave.
  std::vector<double>& mass = fragment_mass;
  mass.assign(fragments.count(), 0);
  for (int j = 0; j < particles; ++j) mass[fragments.of_particle[j]] += tissue.particle_mass[j];
  const double largest = *std::max_element(mass.begin(), mass.end());
  for (int j = 0; j < particles; ++j) {
    const int f = fragments.of_particle[j];
    const bool counts = mass[f] > 0 && !grains.IsGrain(f);
    potential.weight[j] = counts ? std::pow(largest / mass[f], 2) : 1;
  }
}

void Dynamics::Parts::WeighLoad(const Tissue& tissue) {
  const double gravity = config.gravity_m_s2 ? config.gravity_m_s2->norm() : 0;
  double weight = 0, volume = 0;
  for (int j = 0; j < particles; ++j) {
    if (potential.free[j]) weight += potential.weight[j] * std::pow(gravity * tissue.particle_mass[j], 2);
  }
  for (double v : tissue.point_volume) volume += v;
  load = std::sqrt(weight) + kForceRounding * points.lame().mu * std::pow(volume, 2.0 / 3) + forces;
}

}  // namespace meshless_cutting
