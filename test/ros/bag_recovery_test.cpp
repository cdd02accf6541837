// Bags that were not closed or were cut off in the middle.
#include "replay/bag_recovery.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "replay/bag_records.h"
#include "strokes.h"

namespace meshless_cutting {
namespace {

class BagRecoveryTest : public testing::TestWithParam<rosbag::CompressionType> {
 protected:
  BagRecoveryTest() { std::filesystem::create_directories(folder_); }
  ~BagRecoveryTest() override { std::filesystem::remove_all(folder_); }

  // 2020 poses in many small chunks.
  std::filesystem::path WriteBag() const {
    const auto file = folder_ / "whole.bag";
    rosbag::Bag bag(file.string(), rosbag::bagmode::Write);
    bag.setCompression(GetParam());
    bag.setChunkThreshold(4096);
    for (int i = 0; i < 20; ++i) {
      for (const auto& pose : Stroke(ros::Time(1 + i), 0.01 * i))
        bag.write("/arm/measured_cp", pose.header.stamp, pose);
    }
    return file;
  }

  std::filesystem::path CutOff(const std::filesystem::path& whole, double share) const {
    const auto file = folder_ / "damaged.bag";
    std::filesystem::copy_file(whole, file, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(
        file, static_cast<std::uintmax_t>(share * static_cast<double>(std::filesystem::file_size(whole))));
    return file;
  }

  const std::filesystem::path folder_ = testing::TempDir() + "bag_recovery_" + std::to_string(getpid());
};

TEST_P(BagRecoveryTest, TakesWhatIsWholeInOrder) {
  const auto whole = WriteBag();
  for (const double share : {0.1, 0.35, 0.5, 0.77, 0.99}) {
    const auto damaged = CutOff(whole, share);
    const BagRecovery recovery = RecoverBag(damaged, folder_ / "recovered.bag");
    EXPECT_GT(recovery.messages, 0u) << share;
    EXPECT_LE(recovery.messages, 2020u) << share;
    EXPECT_EQ(recovery.bytes_total, std::filesystem::file_size(damaged));
    const rosbag::Bag bag((folder_ / "recovered.bag").string(), rosbag::bagmode::Read);
    rosbag::View view(bag);
    EXPECT_EQ(view.size(), recovery.messages);
    int i = 0;
    for (const rosbag::MessageInstance& message : view) {
      const auto pose = message.instantiate<geometry_msgs::PoseStamped>();
      ASSERT_TRUE(pose);
      EXPECT_EQ(message.getTopic(), "/arm/measured_cp");
      EXPECT_EQ(pose->pose.position.x, 0.01 * (i / 101)) << i;
      EXPECT_EQ(pose->header.stamp, message.getTime()) << i;
      ++i;
    }
  }
}

TEST_P(BagRecoveryTest, LosesNothingOfAWholeBag) {
  const BagRecovery recovery = RecoverBag(WriteBag(), folder_ / "recovered.bag");
  EXPECT_EQ(recovery.messages, 2020u);
  EXPECT_EQ(recovery.bytes_lost, 0u);
}

TEST_P(BagRecoveryTest, SurvivesEveryCutNearARecord) {
  const auto whole = WriteBag();
  const auto size = static_cast<double>(std::filesystem::file_size(whole));
  for (int cut = 4000; cut < 12000; cut += 97) {
    EXPECT_NO_THROW(RecoverBag(CutOff(whole, cut / size), folder_ / "recovered.bag")) << cut;
  }
}

TEST_P(BagRecoveryTest, RefusesWhatIsNoBag) {
  std::ofstream(folder_ / "no.bag") << "scene_version: 1\n";
  EXPECT_THROW(RecoverBag(folder_ / "no.bag", folder_ / "recovered.bag"), std::runtime_error);
  EXPECT_THROW(RecoverBag(folder_ / "missing.bag", folder_ / "recovered.bag"), std::runtime_error);
}

INSTANTIATE_TEST_SUITE_P(Compressions, BagRecoveryTest,
                         testing::Values(rosbag::CompressionType::Uncompressed, rosbag::CompressionType::BZ2,
                                         rosbag::CompressionType::LZ4));

TEST(BagRecordsTest, MalformedFieldsAreRefused) {
  const char field[] = {3, 0, 0, 0, 'a', '=', 'b'};
  EXPECT_EQ(ParseFields(field, 7)->at("a"), "b");
  EXPECT_FALSE(ParseFields(field, 6)) << "cut off";
  const char no_equals[] = {1, 0, 0, 0, 'a'};
  EXPECT_FALSE(ParseFields(no_equals, 5));
  std::size_t position = 0;
  EXPECT_FALSE(NextRecord(field, 7, &position)) << "a header of 3 bytes and no data";
}

}  // namespace
}  // namespace meshless_cutting
