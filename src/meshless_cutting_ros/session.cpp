#include "session.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "frame_input.h"
#include "topics.h"

namespace meshless_cutting {

Session::Session(const Scene& scene, std::uint32_t number, InputReports reports, WallTimes wall_times,
                 const Progress& progress)
    : simulation_(scene, progress),
      number_(number),
      reports_(std::move(reports)),
      wall_times_(wall_times),
      frames_per_topology_(std::max<std::uint64_t>(1, std::llround(1 / scene.time_step_s))),
      waiting_(scene.tools.size()),
      waiting_edges_(scene.tools.size()),
      waiting_buttons_(scene.tools.size()) {
  tuning_ = simulation_.tuning();
  for (const ToolConfig& tool : scene.tools) blade_on_.push_back(!tool.blade_button);  // off until it is pressed
}

FrameMessages Session::Begin(std::int64_t stamp_ns) const {
  const FrameTag tag{stamp_ns, number_, 0};
  FrameMessages messages;
  messages.session = ToSessionInfo(simulation_, tag);
  messages.topology = ToTopology(simulation_.scene(), simulation_.surface(), tag);
  messages.positions = ToPositions(simulation_.scene(), simulation_.surface(), tag, encoding_);
  return messages;
}

void Session::Add(int tool, const PoseSample& sample) {
  std::deque<PoseSample>& queue = waiting_[tool];
  if (queue.size() >= static_cast<std::size_t>(kInputQueue)) {
    queue.pop_front();
    reports_[tool]->Count(InputFault::kOverflow, std::to_string(kInputQueue) + " samples wait");
  }
  queue.push_back(sample);
}

void Session::Add(int tool, EdgeSample sample) {
  std::deque<EdgeSample>& queue = waiting_edges_[tool];
  if (queue.size() >= static_cast<std::size_t>(kInputQueue)) queue.pop_front();
  queue.push_back(std::move(sample));
}

void Session::Add(int tool, const ButtonSample& sample) {
  std::deque<ButtonSample>& queue = waiting_buttons_[tool];
  if (queue.size() >= static_cast<std::size_t>(kInputQueue)) queue.pop_front();
  queue.push_back(sample);
}

bool Session::BladeOn(int tool, std::int64_t stamp_ns) {
  std::deque<ButtonSample>& queue = waiting_buttons_[tool];
  for (; !queue.empty() && queue.front().stamp_ns <= stamp_ns; queue.pop_front()) {
    blade_on_[tool] = queue.front().pressed;
  }
  return blade_on_[tool];
}

std::optional<std::int64_t> Session::EarliestWaiting() const {
  std::optional<std::int64_t> earliest;
  for (const auto& queue : waiting_) {
    if (!queue.empty() && (!earliest || queue.front().stamp_ns < *earliest)) earliest = queue.front().stamp_ns;
  }
  return earliest;
}

void Session::Start(std::int64_t start_ns) { clock_ = SessionClock(start_ns, simulation_.scene().time_step_s); }

void Session::Resume(std::int64_t now_ns) {
  for (auto& queue : waiting_) {
    while (!queue.empty() && queue.front().stamp_ns < now_ns) queue.pop_front();
  }
  for (auto& queue : waiting_edges_) {
    // The last edge from before still holds.
    while (queue.size() > 1 && queue[1].stamp_ns < now_ns) queue.pop_front();
  }
  if (!clock_) return;
  clock_->Rebase(now_ns);
  resumed_ns_ = now_ns;
}

FrameInputPtr Session::Gather(std::int64_t input_end_ns) {
  const auto input = boost::make_shared<FrameInput>();
  input->session = number_;
  input->step = step_ + 1;
  input->start = ToTime(clock_->start_ns());
  input->input_until = ToTime(input_end_ns);
  input->resumed = ToTime(resumed_ns_);
  SetTuning(tuning_, input.get());
  for (int tool = 0; tool < static_cast<int>(waiting_.size()); ++tool) {
    std::deque<PoseSample>& queue = waiting_[tool];
    for (; !queue.empty() && queue.front().stamp_ns <= input_end_ns; queue.pop_front()) {
      AddSample(tool, queue.front(), BladeOn(tool, queue.front().stamp_ns) && blades_on_, input.get());
    }
    BladeOn(tool, input_end_ns);
    std::deque<EdgeSample>& edges = waiting_edges_[tool];
    for (; !edges.empty() && edges.front().stamp_ns <= input_end_ns; edges.pop_front()) {
      AddEdge(tool, edges.front().points, input.get());
    }
  }
  return input;
}

void Session::HandOver(const FrameInput& input) {
  for (std::size_t i = 0; i < input.sample_tool.size(); ++i) {
    const int tool = input.sample_tool[i];
    const PoseSample sample = SampleOf(input, i);
    const SampleVerdict verdict = simulation_.AddToolSample(
        tool, {clock_->SessionTime(sample.stamp_ns), sample.position_m, sample.orientation_xyzw,
               1e-9 * static_cast<double>(sample.stamp_ns - clock_->start_ns()), input.sample_blade_on[i] != 0});
    if (verdict != SampleVerdict::kAccepted) reports_[tool]->Count(FaultOf(verdict), Words(sample));
  }
  std::size_t point = 0;
  for (std::size_t i = 0; i < input.edge_tool.size(); ++i) {
    const std::vector<Eigen::Vector3d> edge = EdgeOf(input, i, &point);
    if (simulation_.SetToolEdge(input.edge_tool[i], edge)) continue;
    reports_[input.edge_tool[i]]->Count(InputFault::kBadEdge, std::to_string(edge.size()) + " points");
  }
}

FrameMessages Session::Step(std::int64_t input_end_ns) { return Make(Gather(input_end_ns)); }

FrameMessages Session::StepAgain(const FrameInput& input) {
  const std::string problem = CheckFrameInput(input, simulation_.scene());
  if (!problem.empty()) throw std::runtime_error(problem);
  if (input.step != step_ + 1) {
    throw std::runtime_error("frame " + std::to_string(input.step) + " after frame " + std::to_string(step_) +
                             "; expected all frames of a session, from the first on");
  }
  if (!clock_) Start(ToNanoseconds(input.start));
  if (!input.resumed.isZero()) Resume(ToNanoseconds(input.resumed));
  tuning_ = TuningOf(input);
  return Make(boost::make_shared<FrameInput>(input));
}

FrameMessages Session::Make(const FrameInputConstPtr& input) {
  if (tuning_ != simulation_.tuning()) simulation_.SetTuning(tuning_);
  const std::int64_t input_end_ns = ToNanoseconds(input->input_until);
  clock_->BeginFrame(input_end_ns);
  HandOver(*input);
  resumed_ns_ = 0;
  simulation_.Step();
  ++step_;

  const Scene& scene = simulation_.scene();
  const Surface& surface = simulation_.surface();
  const FrameTag tag{clock_->SimulatedStamp(), number_, step_};
  FrameMessages messages;
  const bool changed = step_ == 1 || surface.version != published_version_;
  if (changed || step_ % frames_per_topology_ == 0) messages.topology = ToTopology(scene, surface, tag);
  published_version_ = surface.version;
  int not_finite = 0;
  messages.positions = ToPositions(scene, surface, tag, encoding_, &not_finite);
  not_finite_ += static_cast<std::uint64_t>(not_finite);
  for (const StrokeEvent& event : simulation_.events()) messages.events.push_back(ToCutEvent(scene, event, tag));
  messages.statistics =
      ToStatistics(scene, simulation_.statistics(), tag, input_end_ns, wall_times_ == WallTimes::kInStatistics);
  const auto stamped = boost::make_shared<FrameInput>(*input);
  stamped->header = messages.positions->header;
  messages.input = stamped;
  return messages;
}

void Session::Reset(std::uint32_t number) {
  simulation_.Reset();
  number_ = number;
  clock_.reset();
  resumed_ns_ = 0;
  step_ = 0;
  not_finite_ = 0;
  for (auto& queue : waiting_) queue.clear();
  for (auto& queue : waiting_edges_) queue.clear();
  for (int tool = 0; tool < static_cast<int>(waiting_buttons_.size()); ++tool) {
    BladeOn(tool, std::numeric_limits<std::int64_t>::max());
  }
}

}  // namespace meshless_cutting
