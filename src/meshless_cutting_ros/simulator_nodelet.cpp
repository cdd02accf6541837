// The nodelet meshless_cutting/Simulator: the class of the node in a nodelet manager.
#include <nodelet/nodelet.h>

#include <exception>
#include <memory>
#include <pluginlib/class_list_macros.hpp>

#include "simulator_ros.h"

namespace meshless_cutting {

class SimulatorNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      simulator_ = std::make_unique<SimulatorRos>(getPrivateNodeHandle());
    } catch (const std::exception& error) {
      NODELET_FATAL("%s", error.what());
      throw;  // the manager then refuses the nodelet
    }
  }

  std::unique_ptr<SimulatorRos> simulator_;
};

}  // namespace meshless_cutting

PLUGINLIB_EXPORT_CLASS(meshless_cutting::SimulatorNodelet, nodelet::Nodelet)
