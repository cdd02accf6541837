#include "surface_matcher.h"

#include <algorithm>
#include <cmath>

#include "position_encoding.h"

namespace meshless_cutting {
namespace {

// Topics are not in step: positions may trail the topology by some versions.
constexpr std::size_t kTopologies = 16;

template <class A, class B>
bool BelongTogether(const A& a, const B& b) {
  return a.session == b.session && a.version == b.version && a.object == b.object;
}

std::string Label(const std::string& object, std::uint32_t session, std::uint32_t version) {
  return object + ", session " + std::to_string(session) + ", version " + std::to_string(version) + ": ";
}

bool AllFinite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

}  // namespace

std::string CheckTopology(const SurfaceTopology& topology) {
  const std::string label = Label(topology.object, topology.session, topology.version);
  const std::size_t triangles = topology.triangles.size() / 3;
  if (topology.triangles.size() % 3 != 0) return label + "the number of indices is not a multiple of 3";
  if (topology.rest_positions.size() % 3 != 0) return label + "the number of rest coordinates is not a multiple of 3";
  if (topology.region.size() != triangles || topology.fragment.size() != triangles) {
    return label + "expected a region and a fragment for each of " + std::to_string(triangles) + " triangles";
  }
  const std::size_t vertices = topology.rest_positions.size() / 3;
  for (const std::uint32_t index : topology.triangles) {
    if (index >= vertices) {
      return label + "index " + std::to_string(index) + " of " + std::to_string(vertices) + " vertices";
    }
  }
  if (!AllFinite(topology.rest_positions)) return label + "a rest position is not finite";
  return {};
}

SurfaceMatcher::Outcome SurfaceMatcher::Add(const SurfaceTopologyConstPtr& topology) {
  // Sent again once a second: most often it is the one that is drawn.
  error_ = CheckTopology(*topology);
  if (!error_.empty()) return Outcome::kRefused;
  topologies_.erase(std::remove_if(topologies_.begin(), topologies_.end(),
                                   [&](const auto& known) { return BelongTogether(*known, *topology); }),
                    topologies_.end());
  topologies_.push_back(topology);
  if (topologies_.size() > kTopologies) topologies_.pop_front();
  if (!waiting_ || !BelongTogether(*waiting_, *topology)) return Outcome::kKept;
  const SurfacePositionsConstPtr positions = waiting_;
  waiting_.reset();
  return Match(positions);
}

SurfaceMatcher::Outcome SurfaceMatcher::Add(const SurfacePositionsConstPtr& positions) {
  error_.clear();
  waiting_.reset();
  return Match(positions);
}

const SurfaceTopologyConstPtr* SurfaceMatcher::Find(const SurfacePositions& positions) const {
  for (const auto& known : topologies_) {
    if (BelongTogether(*known, positions)) return &known;
  }
  return nullptr;
}

SurfaceMatcher::Outcome SurfaceMatcher::Match(const SurfacePositionsConstPtr& positions) {
  const SurfaceTopologyConstPtr* topology = Find(*positions);
  // Of another run that counts the same: its own topology is to come.
  const bool fits = topology && (*topology)->rest_positions.size() == CoordinateCount(*positions);
  if (!fits) {
    waiting_ = positions;
    return Outcome::kWaiting;
  }
  const SurfacePositionsConstPtr plain = AsFloat32(positions);
  if (plain->positions.size() != (*topology)->rest_positions.size()) {
    error_ = Label(positions->object, positions->session, positions->version) + "encoding " +
             std::to_string(positions->encoding) + " is not known";
    return Outcome::kRefused;
  }
  if (!AllFinite(plain->positions)) {
    error_ = Label(positions->object, positions->session, positions->version) + "a position is not finite";
    return Outcome::kRefused;
  }
  surface_ = {*topology, plain};
  return Outcome::kShown;
}

void SurfaceMatcher::Clear() { *this = SurfaceMatcher(); }

}  // namespace meshless_cutting
