// The services of the simulator.
#include <filesystem>
#include <utility>

#include "lattice/triangle_mesh.h"
#include "simulator_ros.h"
#include "topics.h"

namespace meshless_cutting {
namespace {

constexpr std::uint32_t kMostFrames = 100000;

}  // namespace

void SimulatorRos::Advertise() {
  services_ = {nh_.advertiseService(kResetService, &SimulatorRos::OnReset, this),
               nh_.advertiseService(kPauseService, &SimulatorRos::OnPause, this),
               nh_.advertiseService(kStepService, &SimulatorRos::OnStep, this),
               nh_.advertiseService(kLoadSceneService, &SimulatorRos::OnLoadScene, this),
               nh_.advertiseService(kSaveSurfaceService, &SimulatorRos::OnSaveSurface, this)};
}

bool SimulatorRos::OnReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  InLoop([&] {
    RestartSession("reset");
    ForgetOldSamples();
    response.message = "session " + std::to_string(session_number_);
  });
  response.success = true;
  return true;
}

bool SimulatorRos::OnPause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  InLoop([&] { SetPaused(request.data); });
  response.success = true;
  response.message = request.data ? "paused" : "running";
  return true;
}

bool SimulatorRos::OnStep(Step::Request& request, Step::Response& response) {
  if (request.frames < 1 || request.frames > kMostFrames) {
    response.message = "frames: " + std::to_string(request.frames) + ": expected 1 to " + std::to_string(kMostFrames);
    return true;
  }
  InLoop([&] {
    if (!paused_) {
      response.message =
          "running: expected a paused simulation; call " + nh_.resolveName(kPauseService) + " with true first";
      return;
    }
    const std::uint32_t made = StepByHand(request.frames);
    response.success = made == request.frames;
    response.message = std::to_string(made) + " frames made";
    response.step = run_.session->step();
    response.stamp = ToTime(run_.session->simulated_stamp());
  });
  return true;
}

bool SimulatorRos::OnLoadScene(LoadScene::Request& request, LoadScene::Response& response) {
  try {
    const std::string scene = request.scene.empty() ? run_.scene->file.string() : request.scene;
    Run fresh = Load(scene, 0);  // here: meanwhile the loop goes on with the old one
    InLoop([&] {
      run_.forces->Zero(ros::Time::now());
      fresh.session->Reset(++session_number_);
      fresh.inputs->set_check_age(!paused_);
      {
        const std::lock_guard<std::mutex> lock(run_mutex_);
        if (awaited_.empty()) fresh.inputs->Listen();
        std::swap(run_, fresh);
      }
      monitor_.Restart();
      BeginSession();
    });
    ShowTuning();
    response.success = true;
    response.session = session_number_;
    response.message = "session " + std::to_string(session_number_) + ": " + run_.scene->object.name + " of " + scene;
  } catch (const std::exception& error) {
    response.session = session_number_;
    response.message = error.what();
    ROS_ERROR("%s", error.what());
  }
  return true;
}

bool SimulatorRos::OnSaveSurface(SaveSurface::Request& request, SaveSurface::Response& response) {
  TriangleMesh mesh;
  InLoop([&] {
    const Surface& surface = run_.session->simulation().surface();
    mesh.vertices = surface.positions;
    for (const auto& triangle : surface.triangles) {
      mesh.triangles.push_back(
          {static_cast<int>(triangle[0]), static_cast<int>(triangle[1]), static_cast<int>(triangle[2])});
    }
  });
  if (!std::filesystem::path(request.path).is_absolute()) {
    response.message = "path: " + request.path + ": expected an absolute path that ends in .obj, .ply or .stl";
    return true;
  }
  try {
    WriteTriangleMesh(mesh, request.path);
    response.success = true;
    response.vertices = static_cast<std::uint32_t>(mesh.vertices.size());
    response.triangles = static_cast<std::uint32_t>(mesh.triangles.size());
    response.message = request.path + ": " + std::to_string(mesh.triangles.size()) + " triangles";
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  return true;
}

}  // namespace meshless_cutting
