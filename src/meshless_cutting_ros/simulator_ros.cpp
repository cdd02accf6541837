#include "simulator_ros.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <utility>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include "scene_loading.h"
#include "topics.h"

namespace meshless_cutting {
namespace {

constexpr std::int64_t kLongestSleep_ns = 5000000;
// Time that goes back by more starts a new session.
constexpr std::int64_t kTimeJump_ns = 100000000;

std::int64_t ToNanoseconds(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

/// To the system, what the allocator keeps of a session that has ended: otherwise a process that runs for days holds the
/// most that any of its sessions and queues ever needed at once.
void ReturnFreeMemory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace

SimulatorRos::SimulatorRos(const ros::NodeHandle& private_nh) : nh_(private_nh), input_nh_(private_nh) {
  nh_.setCallbackQueue(&service_queue_);
  input_nh_.setCallbackQueue(&input_queue_);
  std::string scene;
  if (!nh_.getParam(kSceneParameter, scene) || scene.empty()) {
    throw std::runtime_error("parameter " + nh_.resolveName(kSceneParameter) +
                             ": missing; expected the path or package:// URL of a scene file, e.g. "
                             "_scene:=package://meshless_cutting/launch/liver.yaml");
  }
  paused_ = nh_.param<bool>(kStartPausedParameter, false);
  paused_shown_ = paused_;
  input_delay_ns_ = ToNanoseconds(nh_.param<double>(kInputDelayParameter, 0.003));
  max_lag_ns_ = ToNanoseconds(nh_.param<double>(kMaxLagParameter, 0.05));
  start_with_samples_ = nh_.param<bool>(kStartWithSamplesParameter, false);
  std::istringstream awaited(nh_.param<std::string>(kWaitForListenersParameter, ""));
  awaited_.assign(std::istream_iterator<std::string>(awaited), {});
  encoding_ = ParseEncoding("parameter " + nh_.resolveName(kEncodingParameter),
                            nh_.param<std::string>(kEncodingParameter, "float32"));
  run_ = Load(scene, session_number_);
  run_.inputs->set_check_age(!paused_);

  updater_ = std::make_unique<diagnostic_updater::Updater>(ros::NodeHandle(), nh_, nh_.getNamespace());
  updater_->setHardwareID("none");
  updater_->add("loop", this, &SimulatorRos::DiagnoseLoop);
  updater_->add("tools", this, &SimulatorRos::DiagnoseTools);
  publishers_ = std::make_unique<Publishers>(nh_, [this] { EverySecond(); });
  try {
    publishers_->HaveListeners(awaited_);
  } catch (const std::exception& error) {
    throw std::runtime_error("parameter " + nh_.resolveName(kWaitForListenersParameter) + ": " + error.what());
  }
  if (awaited_.empty()) {
    run_.inputs->Listen();
  } else {
    ROS_INFO("waiting for listeners, as parameter %s says", nh_.resolveName(kWaitForListenersParameter).c_str());
  }
  Advertise();
  BeginSession();
  loop_ = std::thread([this] { Loop(); });
  input_spinner_ = std::make_unique<ros::AsyncSpinner>(1, &input_queue_);
  service_spinner_ = std::make_unique<ros::AsyncSpinner>(1, &service_queue_);
  input_spinner_->start();
  service_spinner_->start();
  StartReconfigure();
}

SimulatorRos::~SimulatorRos() {
  stop_ = true;  // a long ~step ends
  command_wake_.notify_all();
  services_.clear();
  service_spinner_->stop();  // the loop still answers what was asked
  reconfigure_.reset();
  {
    const std::lock_guard<std::mutex> lock(command_mutex_);
    commands_.emplace_back();  // empty: the loop's end
  }
  command_wake_.notify_all();
  loop_.join();
  run_.forces->Zero(ros::Time::now());
  input_spinner_->stop();
  publishers_.reset();
}

SimulatorRos::Run SimulatorRos::Load(const std::string& scene, std::uint32_t number) const {
  std::string robot_description;
  nh_.getParam(kRobotDescriptionParameter, robot_description);
  Run run;
  run.scene = std::make_shared<const Scene>(LoadSceneFile(scene, robot_description));
  InputReports reports;
  for (const ToolConfig& tool : run.scene->tools) {
    reports.push_back(std::make_shared<InputReport>(tool.name, SourceName(nh_, tool), tool.max_speed_m_s));
  }
  std::string told;
  run.session = std::make_unique<Session>(*run.scene, number, reports, Session::WallTimes::kInStatistics,
                                          [&](const std::string& stage, double) {
                                            if (stage == told) return;
                                            told = stage;
                                            ROS_INFO("Loading %s: %s", run.scene->object.name.c_str(), stage.c_str());
                                          });
  run.session->set_encoding(encoding_);
  run.inputs = std::make_unique<ToolInputs>(input_nh_, *run.scene, reports);
  run.forces = std::make_unique<ForcePublisher>(nh_, *run.scene);
  const Simulation& simulation = run.session->simulation();
  ROS_INFO("Scene %s: object %s, %zu triangles, %d particles, %d integration points, %zu tools; %s", scene.c_str(),
           run.scene->object.name.c_str(), simulation.surface().triangles.size(), simulation.statistics().particles,
           simulation.statistics().integration_points, run.scene->tools.size(), simulation.solver_summary().c_str());
  return run;
}

void SimulatorRos::InLoop(const std::function<void()>& command) {
  std::promise<void> done;
  {
    const std::lock_guard<std::mutex> lock(command_mutex_);
    commands_.emplace_back([&] {
      command();
      done.set_value();
    });
  }
  command_wake_.notify_all();
  done.get_future().wait();
}

void SimulatorRos::Loop() {
  std::unique_lock<std::mutex> lock(command_mutex_);
  while (true) {
    while (!commands_.empty()) {
      const std::function<void()> command = std::move(commands_.front());
      commands_.pop_front();
      if (!command) return;
      lock.unlock();
      command();
      lock.lock();
    }
    std::int64_t sleep_ns = kLongestSleep_ns;
    if (!stop_) {
      lock.unlock();
      if (!Waits() && !paused_) sleep_ns = MakeFrameIfDue();
      lock.lock();
    }
    if (sleep_ns > 0 && commands_.empty()) command_wake_.wait_for(lock, std::chrono::nanoseconds(sleep_ns));
  }
}

bool SimulatorRos::Start(std::int64_t now_ns) {
  if (start_with_samples_) {
    run_.inputs->HandOver(run_.session.get());
    const auto first = run_.session->EarliestWaiting();
    if (!first) return false;
    now_ns = *first;
  }
  run_.session->Start(now_ns);
  return true;
}

std::int64_t SimulatorRos::MakeFrameIfDue() {
  if (!clock_.valid()) return kLongestSleep_ns;
  const std::int64_t now = clock_.Now();
  if (now < last_now_ns_ - kTimeJump_ns) RestartSession("time went back");
  last_now_ns_ = now;
  Session& session = *run_.session;
  if (!session.started() && !Start(now)) return kLongestSleep_ns;
  const std::int64_t present = now - input_delay_ns_;
  const std::int64_t lag = present - session.NextInputEnd();
  if (lag < 0) return std::min(kLongestSleep_ns, -lag);
  // Behind by a little: frames follow each other at once. By more: simulated time slips instead of bursting; the one
  // frame takes all samples up to the present, so that no part of a tool's path is lost.
  MakeFrame(lag > max_lag_ns_ ? present : session.NextInputEnd());
  return 0;
}

bool SimulatorRos::Waits() {
  if (awaited_.empty()) return false;
  if (!publishers_->HaveListeners(awaited_)) return true;
  awaited_.clear();
  {
    const std::lock_guard<std::mutex> lock(run_mutex_);
    run_.inputs->Listen();  // not before: a player that waits for the simulator begins now
  }
  ROS_INFO("all listeners are there: session %u starts", session_number_);
  BeginSession();
  return false;
}

FrameView SimulatorRos::View(FrameMessages messages) const {
  const Simulation& simulation = run_.session->simulation();
  FrameView view;
  view.messages = std::move(messages);
  view.scene = run_.scene;
  for (int tool = 0; tool < static_cast<int>(run_.scene->tools.size()); ++tool) {
    view.tools.push_back({simulation.tool(tool).pose(), simulation.blade(tool)});
  }
  if (publishers_->mapping_wanted()) view.mapping = {simulation.IntegrationPointPositions(), simulation.MappedPoints()};
  return view;
}

void SimulatorRos::MakeFrame(std::int64_t input_end_ns) {
  Session& session = *run_.session;
  run_.inputs->HandOver(&session);
  FrameMessages messages = session.Step(input_end_ns);
  run_.forces->Publish(session.simulation(), messages.positions->header.stamp);
  const FrameStatistics& statistics = session.simulation().statistics();
  monitor_.Add(1e-9 * static_cast<double>(ros::SteadyTime::now().toNSec()), statistics.total_s, run_.scene->time_step_s,
               statistics.status);
  slip_s_ = session.slip_s();
  not_finite_ = session.not_finite();
  publishers_->Push(View(std::move(messages)));
}

void SimulatorRos::BeginSession() { publishers_->Push(View(run_.session->Begin(clock_.valid() ? clock_.Now() : 0))); }

void SimulatorRos::RestartSession(const std::string& reason) {
  run_.forces->Zero(ros::Time::now());
  run_.session->Reset(++session_number_);
  ReturnFreeMemory();
  ROS_INFO("Session %u: %s", session_number_, reason.c_str());
  monitor_.Restart();
  BeginSession();
}

void SimulatorRos::ForgetOldSamples() {
  if (paused_ || !clock_.valid()) return;  // stepped by hand, a session begins with the samples that wait
  run_.inputs->HandOver(run_.session.get());
  run_.session->Resume(clock_.Now() - input_delay_ns_);
}

void SimulatorRos::SetPaused(bool paused) {
  if (paused_ && !paused && clock_.valid()) {
    last_now_ns_ = clock_.Now();
    run_.inputs->HandOver(run_.session.get());
    run_.session->Resume(last_now_ns_ - input_delay_ns_);
  }
  if (paused) run_.forces->Zero(ros::Time::now());
  paused_ = paused;
  paused_shown_ = paused;
  run_.inputs->set_check_age(!paused);
  monitor_.Restart();
}

std::uint32_t SimulatorRos::StepByHand(std::uint32_t frames) {
  Session& session = *run_.session;
  run_.inputs->HandOver(&session);
  if (!session.started()) session.Start(session.EarliestWaiting().value_or(clock_.valid() ? clock_.Now() : 0));
  std::uint32_t made = 0;
  for (; made < frames && !stop_; ++made) MakeFrame(session.NextInputEnd());
  return made;
}

}  // namespace meshless_cutting
