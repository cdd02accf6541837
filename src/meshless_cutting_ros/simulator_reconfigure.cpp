// What may change at run time, through dynamic_reconfigure.
#include <cmath>

#include "simulator_ros.h"

namespace meshless_cutting {
namespace {

SimulatorConfig ToConfig(const Tuning& tuning, bool blades_on) {
  SimulatorConfig config;
  config.blades_on = blades_on;
  config.mass_damping_per_s = tuning.damping.mass_per_s;
  config.stiffness_damping_s = tuning.damping.stiffness_s;
  config.gravity_x = tuning.gravity_m_s2.x();
  config.gravity_y = tuning.gravity_m_s2.y();
  config.gravity_z = tuning.gravity_m_s2.z();
  config.newton_iterations = tuning.newton_iterations;
  return config;
}

Tuning ToTuning(const SimulatorConfig& config) {
  return {{config.gravity_x, config.gravity_y, config.gravity_z},
          {config.mass_damping_per_s, config.stiffness_damping_s},
          config.newton_iterations};
}

// `wanted` as far as the scene has the parts for it; a number that is not finite stays as it was.
Tuning Possible(const Scene& scene, const Tuning& now, const Tuning& wanted) {
  Tuning tuning = wanted;
  const auto keep = [](double* value, double old, bool possible) {
    if (!possible || !std::isfinite(*value)) *value = old;
  };
  for (int axis = 0; axis < 3; ++axis) {
    keep(&tuning.gravity_m_s2[axis], now.gravity_m_s2[axis], scene.gravity_m_s2.has_value());
  }
  keep(&tuning.damping.mass_per_s, now.damping.mass_per_s, scene.damping.has_value());
  keep(&tuning.damping.stiffness_s, now.damping.stiffness_s, scene.damping && scene.damping->stiffness_s > 0);
  return tuning;
}

}  // namespace

void SimulatorRos::StartReconfigure() {
  SimulatorConfig config = ToConfig(run_.session->tuning(), true);
  config.__fromServer__(nh_);  // what a launch file sets goes before the scene
  config.__clamp__();
  reconfigure_ = std::make_unique<dynamic_reconfigure::Server<SimulatorConfig>>(reconfigure_mutex_, nh_);
  reconfigure_->updateConfig(config);
  reconfigure_->setCallback([this](SimulatorConfig& wanted, std::uint32_t) { OnReconfigure(&wanted); });
}

void SimulatorRos::OnReconfigure(SimulatorConfig* config) {
  const Tuning wanted = ToTuning(*config);
  InLoop([&] {
    Session& session = *run_.session;
    const Tuning tuning = Possible(*run_.scene, session.tuning(), wanted);
    session.set_tuning(tuning);
    session.set_blades_on(config->blades_on);
    *config = ToConfig(tuning, config->blades_on);
  });
  if (ToTuning(*config) != wanted) {
    ROS_WARN(
        "reconfigure: a part that the scene does not name stays absent; expected gravity_m_s2, damping.mass_per_s "
        "and damping.stiffness_s above 0 in the scene file for what shall be changed");
  }
}

void SimulatorRos::ShowTuning() {
  if (reconfigure_) reconfigure_->updateConfig(ToConfig(run_.session->tuning(), true));
}

}  // namespace meshless_cutting
