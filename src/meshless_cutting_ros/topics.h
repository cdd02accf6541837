// Names of topics, services and parameters, relative to the simulator's private namespace.
#pragma once

namespace meshless_cutting {

// In, per tool: <tool>/measured_cp is named by the scene.
inline constexpr char kEdgeTopic[] = "edge";  // <tool>/edge
// Out, per tool whose scene has it.
inline constexpr char kForceTopic[] = "measured_cf";  // <tool>/measured_cf

// Out.
inline constexpr char kTopologyTopic[] = "surface/topology";
inline constexpr char kPositionsTopic[] = "surface/positions";
inline constexpr char kCutEventsTopic[] = "cut_events";
inline constexpr char kStatisticsTopic[] = "statistics";
inline constexpr char kInputsTopic[] = "inputs";
inline constexpr char kSessionTopic[] = "session";
inline constexpr char kMarkerTopic[] = "marker";
inline constexpr char kSurroundingsTopic[] = "surroundings";
inline constexpr char kMappingMarkerTopic[] = "mapping_marker";

// Services.
inline constexpr char kResetService[] = "reset";
inline constexpr char kPauseService[] = "pause";
inline constexpr char kStepService[] = "step";
inline constexpr char kLoadSceneService[] = "load_scene";
inline constexpr char kSaveSurfaceService[] = "save_surface";

// Parameters.
inline constexpr char kSceneParameter[] = "scene";               // path or package:// URL
inline constexpr char kStartPausedParameter[] = "start_paused";  // bool, false
inline constexpr char kInputDelayParameter[] = "input_delay_s";  // a frame waits this long for the last of its samples
inline constexpr char kMaxLagParameter[] = "max_lag_s";          // further behind than this, simulated time slips
inline constexpr char kEncodingParameter[] = "encoding";         // of positions: float32 or uint16
// Topics of the simulator, separated by blanks: the first frame waits until each has a listener, e.g. a recorder.
inline constexpr char kWaitForListenersParameter[] = "wait_for_listeners";
inline constexpr char kStartWithSamplesParameter[] = "start_with_samples";  // bool, false: a session begins with a sample
inline constexpr char kRobotDescriptionParameter[] = "/robot_description";

// What `replay` and the players call the simulator unless told otherwise.
inline constexpr char kDefaultSimulatorName[] = "/simulator";

// Samples of a tool that may wait in a queue: 20 s of a 1 kHz device.
inline constexpr int kInputQueue = 20000;
inline constexpr double kMarkerRateHz = 15;

}  // namespace meshless_cutting
