#include "session.h"

#include <algorithm>
#include <cmath>
#include <utility>

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
      waiting_edges_(scene.tools.size()) {}

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
  if (clock_) clock_->Rebase(now_ns);
}

void Session::HandOver(std::int64_t input_end_ns) {
  for (int tool = 0; tool < static_cast<int>(waiting_.size()); ++tool) {
    std::deque<PoseSample>& queue = waiting_[tool];
    for (; !queue.empty() && queue.front().stamp_ns <= input_end_ns; queue.pop_front()) {
      const PoseSample& sample = queue.front();
      const SampleVerdict verdict = simulation_.AddToolSample(
          tool, {clock_->SessionTime(sample.stamp_ns), sample.position_m, sample.orientation_xyzw});
      if (verdict != SampleVerdict::kAccepted) reports_[tool]->Count(FaultOf(verdict), Words(sample));
    }
    std::deque<EdgeSample>& edges = waiting_edges_[tool];
    for (; !edges.empty() && edges.front().stamp_ns <= input_end_ns; edges.pop_front()) {
      if (simulation_.SetToolEdge(tool, edges.front().points)) continue;
      reports_[tool]->Count(InputFault::kBadEdge, std::to_string(edges.front().points.size()) + " points");
    }
  }
}

FrameMessages Session::Step(std::int64_t input_end_ns) {
  clock_->BeginFrame(input_end_ns);
  HandOver(input_end_ns);
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
  return messages;
}

void Session::Reset(std::uint32_t number) {
  simulation_.Reset();
  number_ = number;
  clock_.reset();
  step_ = 0;
  not_finite_ = 0;
  for (auto& queue : waiting_) queue.clear();
  for (auto& queue : waiting_edges_) queue.clear();
}

}  // namespace meshless_cutting
