#include "position_encoding.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <limits>
#include <random>

namespace meshless_cutting {
namespace {

std::vector<Eigen::Vector3d> Cloud(int count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-0.1, 0.1);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) points.emplace_back(coordinate(random), 2 + coordinate(random), coordinate(random));
  return points;
}

TEST(PositionEncodingTest, FloatsAreExact) {
  const auto points = Cloud(100);
  SurfacePositions message;
  Encode(points, PositionEncoding::kFloat32, &message);
  EXPECT_EQ(message.encoding, SurfacePositions::FLOAT32);
  EXPECT_EQ(CoordinateCount(message), 300u);
  const std::vector<float> floats = Decode(message);
  for (std::size_t i = 0; i < 300; ++i) EXPECT_EQ(floats[i], static_cast<float>(points[i / 3][i % 3]));
}

TEST(PositionEncodingTest, StepsOfTheBoxAreAsGoodAsTheMessageSays) {
  const auto points = Cloud(2000);
  SurfacePositions message;
  Encode(points, PositionEncoding::kUint16, &message);
  EXPECT_EQ(message.encoding, SurfacePositions::UINT16);
  EXPECT_TRUE(message.positions.empty());
  ASSERT_EQ(CoordinateCount(message), 6000u);
  const std::vector<float> floats = Decode(message);
  double worst = 0;
  for (std::size_t i = 0; i < floats.size(); ++i) {
    const double exact = points[i / 3][i % 3];
    const double bound = message.box_size[i % 3] / 131070 + 1.2e-7 * std::abs(exact);  // the last bit of a float
    EXPECT_LE(std::abs(floats[i] - exact), bound);
    worst = std::max(worst, std::abs(floats[i] - exact));
  }
  EXPECT_GT(worst, 1e-6) << "it is not exact";
  EXPECT_LT(worst, 2e-6) << "1.5 um in 0.2 m";
  SurfacePositionsConstPtr shared = boost::make_shared<SurfacePositions>(message);
  EXPECT_EQ(AsFloat32(shared)->positions, floats);
  EXPECT_EQ(AsFloat32(AsFloat32(shared))->encoding, SurfacePositions::FLOAT32);
}

TEST(PositionEncodingTest, FlatEmptyAndSpoiltClouds) {
  SurfacePositions message;
  Encode({{1, 2, 3}, {1, 4, 3}}, PositionEncoding::kUint16, &message);
  EXPECT_EQ(Decode(message), (std::vector<float>{1, 2, 3, 1, 4, 3}));
  SurfacePositions empty;
  Encode({}, PositionEncoding::kUint16, &empty);
  EXPECT_TRUE(Decode(empty).empty());
  SurfacePositions spoilt;
  Encode({{1, std::numeric_limits<double>::quiet_NaN(), 3}}, PositionEncoding::kUint16, &spoilt);
  EXPECT_EQ(spoilt.encoding, SurfacePositions::FLOAT32) << "the receiver shall see that it is not finite";
}

TEST(PositionEncodingTest, NamesAreStrict) {
  EXPECT_EQ(ParseEncoding("x", "float32"), PositionEncoding::kFloat32);
  EXPECT_EQ(ParseEncoding("x", "uint16"), PositionEncoding::kUint16);
  try {
    ParseEncoding("--encoding", "Float");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()), "--encoding: `Float`: expected float32 (exact) or uint16 (half the size)");
  }
}

}  // namespace
}  // namespace meshless_cutting
