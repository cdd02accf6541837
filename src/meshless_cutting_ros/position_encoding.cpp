#include "position_encoding.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace meshless_cutting {
namespace {

constexpr double kSteps = 65535;

void EncodeInBox(const std::vector<Eigen::Vector3d>& positions, SurfacePositions* message) {
  Eigen::Vector3d min = positions.front(), max = positions.front();
  for (const Eigen::Vector3d& p : positions) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  Eigen::Vector3d scale;
  for (int axis = 0; axis < 3; ++axis) {
    message->box_min[axis] = min[axis];
    message->box_size[axis] = max[axis] - min[axis];
    scale[axis] = message->box_size[axis] > 0 ? kSteps / message->box_size[axis] : 0;
  }
  message->box_positions.resize(3 * positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double value = std::clamp((positions[i][axis] - min[axis]) * scale[axis], 0.0, kSteps);
      message->box_positions[3 * i + axis] = static_cast<std::uint16_t>(std::lround(value));
    }
  }
}

}  // namespace

PositionEncoding ParseEncoding(const std::string& key, const std::string& text) {
  if (text == "float32") return PositionEncoding::kFloat32;
  if (text == "uint16") return PositionEncoding::kUint16;
  throw std::runtime_error(key + ": `" + text + "`: expected float32 (exact) or uint16 (half the size)");
}

void Encode(const std::vector<Eigen::Vector3d>& positions, PositionEncoding encoding, SurfacePositions* message) {
  const bool finite =
      std::all_of(positions.begin(), positions.end(), [](const Eigen::Vector3d& p) { return p.allFinite(); });
  if (encoding == PositionEncoding::kUint16 && finite && !positions.empty()) {
    message->encoding = SurfacePositions::UINT16;
    return EncodeInBox(positions, message);
  }
  message->encoding = SurfacePositions::FLOAT32;
  message->positions.resize(3 * positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) message->positions[3 * i + axis] = static_cast<float>(positions[i][axis]);
  }
}

std::size_t CoordinateCount(const SurfacePositions& message) {
  return message.encoding == SurfacePositions::UINT16 ? message.box_positions.size() : message.positions.size();
}

std::vector<float> Decode(const SurfacePositions& message) {
  if (message.encoding == SurfacePositions::FLOAT32) return message.positions;
  if (message.encoding != SurfacePositions::UINT16) return {};
  std::vector<float> positions(message.box_positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const std::size_t axis = i % 3;
    positions[i] =
        static_cast<float>(message.box_min[axis] + message.box_size[axis] * message.box_positions[i] / kSteps);
  }
  return positions;
}

SurfacePositionsConstPtr AsFloat32(const SurfacePositionsConstPtr& message) {
  if (message->encoding == SurfacePositions::FLOAT32) return message;
  const auto plain = boost::make_shared<SurfacePositions>(*message);
  plain->positions = Decode(*message);
  plain->encoding = SurfacePositions::FLOAT32;
  plain->box_positions.clear();
  return plain;
}

}  // namespace meshless_cutting
