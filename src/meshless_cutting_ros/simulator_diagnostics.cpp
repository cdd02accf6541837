// What the simulator says about itself once a second.
#include "simulator_ros.h"

namespace meshless_cutting {

void SimulatorRos::EverySecond() {
  {
    const std::lock_guard<std::mutex> lock(run_mutex_);
    run_.inputs->Refresh();
    for (const auto& report : run_.session->reports()) {
      for (const std::string& line : report->TakeLines()) ROS_WARN("%s", line.c_str());
    }
  }
  updater_->force_update();
}

void SimulatorRos::DiagnoseLoop(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const LoopMonitor::Summary summary = monitor_.Get();
  const bool paused = paused_shown_;
  double time_step = 0;
  {
    const std::lock_guard<std::mutex> lock(run_mutex_);
    time_step = run_.scene->time_step_s;
  }
  using Status = diagnostic_msgs::DiagnosticStatus;
  if (not_finite_ > 0) {
    status.summary(Status::ERROR, "positions that are not finite were published: reset");
  } else if (paused) {
    status.summary(Status::OK, "paused");
  } else if (summary.status & kStepFrozen) {
    status.summary(Status::ERROR, "a frame could not be solved: positions were kept");
  } else if (summary.frames > 0 && summary.p50_s > time_step) {
    status.summary(Status::WARN,
                   "slower than real time: coarser cell_size_m or lattice_size_m, or a longer time_step_s");
  } else {
    status.summary(Status::OK, "running");
  }
  status.addf("step time p50 (ms)", "%.2f", 1e3 * summary.p50_s);
  status.addf("step time p99 (ms)", "%.2f", 1e3 * summary.p99_s);
  status.addf("deadline (ms)", "%.2f", 1e3 * time_step);
  status.addf("real-time factor", "%.3f", summary.real_time_factor);
  status.addf("behind the clock (s)", "%.3f", slip_s_.load());
  status.add("frames", summary.frames);
  status.add("deadlines missed", summary.missed);
  status.add("steps not converged", (summary.status & kStepNotConverged) != 0 ? "some in the last 10 s" : "none");
  status.add("non-finite positions", not_finite_.load());
}

void SimulatorRos::DiagnoseTools(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(run_mutex_);
  using Status = diagnostic_msgs::DiagnosticStatus;
  status.summary(Status::OK, run_.scene->tools.empty() ? "no tools in the scene" : "samples come in");
  for (int tool = 0; tool < static_cast<int>(run_.scene->tools.size()); ++tool) {
    const ToolConfig& config = run_.scene->tools[tool];
    const InputReport& report = *run_.session->reports()[tool];
    if (!std::holds_alternative<FixedPoseSource>(config.pose_source)) {
      const auto age = run_.inputs->Age(tool);
      if (!age || *age > config.timeout_s) {
        status.mergeSummary(Status::WARN, config.name + ": no samples on " + report.topic());
      }
      status.add(config.name + " input age (s)", age ? std::to_string(*age) : "never");
    }
    const auto counts = report.counts();
    for (int fault = 0; fault < kInputFaults; ++fault) {
      if (counts[fault] > 0) status.add(config.name + " " + Name(static_cast<InputFault>(fault)), counts[fault]);
    }
  }
}

}  // namespace meshless_cutting
