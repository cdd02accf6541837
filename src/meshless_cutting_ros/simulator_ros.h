// The simulator as ROS sees it: the same class in the node and in the nodelet.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <dynamic_reconfigure/server.h>
#include <meshless_cutting/LoadScene.h>
#include <meshless_cutting/SaveSurface.h>
#include <meshless_cutting/SimulatorConfig.h>
#include <meshless_cutting/Step.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "force_publisher.h"
#include "frame_clock.h"
#include "loop_monitor.h"
#include "publishers.h"
#include "session.h"
#include "tool_inputs.h"

namespace meshless_cutting {

/// Threads: callbacks of tools (a spinner of their own) file samples in a mailbox; services (another spinner) build
/// scenes and leave commands; the loop owns the session and makes the frames; the publishers' thread sends them.
class SimulatorRos {
 public:
  /// Loads the scene of parameter ~scene and starts. Throws std::runtime_error with one line: no parameter, bad scene.
  explicit SimulatorRos(const ros::NodeHandle& private_nh);
  ~SimulatorRos();

 private:
  /// A session with its inputs; replaced as a whole.
  struct Run {
    std::shared_ptr<const Scene> scene;
    std::unique_ptr<Session> session;
    std::unique_ptr<ToolInputs> inputs;
    std::unique_ptr<ForcePublisher> forces;
  };

  Run Load(const std::string& scene, std::uint32_t number) const;

  // Of the loop (simulator_ros.cpp).
  void Loop();
  /// Runs `command` in the loop, between two frames, and waits for it.
  void InLoop(const std::function<void()>& command);
  void RunCommands();
  void BeginSession();
  /// Whether the first frame still waits for listeners; starts when they are there.
  bool Waits();
  void RestartSession(const std::string& reason);
  /// Leaves samples that came in while a session was built to the session before.
  void ForgetOldSamples();
  /// Starts the session, if it may: now, or where its first sample is.
  bool Start(std::int64_t now_ns);
  /// Makes the frame that is due. How long to sleep until the next is, ns: a few ms at most, as time may be simulated.
  std::int64_t MakeFrameIfDue();
  void MakeFrame(std::int64_t input_end_ns);
  void SetPaused(bool paused);
  /// Steps by hand while paused; the number of frames made.
  std::uint32_t StepByHand(std::uint32_t frames);
  FrameView View(FrameMessages messages) const;

  // Services (simulator_services.cpp).
  void Advertise();
  bool OnReset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool OnPause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool OnStep(Step::Request& request, Step::Response& response);
  bool OnLoadScene(LoadScene::Request& request, LoadScene::Response& response);
  bool OnSaveSurface(SaveSurface::Request& request, SaveSurface::Response& response);

  // Changes at run time (simulator_reconfigure.cpp).
  void StartReconfigure();
  /// Takes what the scene has parts for, and says in `config` what was taken.
  void OnReconfigure(SimulatorConfig* config);
  /// After a scene was loaded: its values, blades on.
  void ShowTuning();

  // Once a second (simulator_diagnostics.cpp).
  void EverySecond();
  void DiagnoseLoop(diagnostic_updater::DiagnosticStatusWrapper& status);
  void DiagnoseTools(diagnostic_updater::DiagnosticStatusWrapper& status);

  ros::NodeHandle nh_;        // private
  ros::NodeHandle input_nh_;  // the same with the queue of the tools
  ros::CallbackQueue input_queue_, service_queue_;
  std::int64_t input_delay_ns_ = 0;
  std::int64_t max_lag_ns_ = 0;
  bool start_with_samples_ = false;
  PositionEncoding encoding_ = PositionEncoding::kFloat32;

  // Of the loop; the scene and the inputs are also looked at by diagnostics, under run_mutex_.
  std::mutex run_mutex_;
  Run run_;
  bool paused_ = false;
  std::vector<std::string> awaited_;  // topics without which no frame is made; empty: do not wait any more
  FrameClock clock_;
  std::int64_t last_now_ns_ = 0;
  std::uint32_t session_number_ = 1;

  std::mutex command_mutex_;
  std::condition_variable command_wake_;
  std::deque<std::function<void()>> commands_;
  std::atomic<bool> stop_{false};

  LoopMonitor monitor_;
  std::atomic<double> slip_s_{0};
  std::atomic<std::uint64_t> not_finite_{0};
  std::atomic<bool> paused_shown_{false};
  std::unique_ptr<diagnostic_updater::Updater> updater_;

  std::unique_ptr<Publishers> publishers_;
  std::vector<ros::ServiceServer> services_;
  boost::recursive_mutex reconfigure_mutex_;
  std::unique_ptr<dynamic_reconfigure::Server<SimulatorConfig>> reconfigure_;
  std::unique_ptr<ros::AsyncSpinner> input_spinner_, service_spinner_;
  std::thread loop_;
};

}  // namespace meshless_cutting
