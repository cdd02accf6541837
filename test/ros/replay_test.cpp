// The program `replay` as a user runs it: exit status, one line on stderr, output or none.
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/wait.h>
#include <tf2_msgs/TFMessage.h>
#include <topic_tools/shape_shifter.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "messages.h"
#include "position_encoding.h"
#include "strokes.h"

namespace meshless_cutting {
namespace {

namespace fs = std::filesystem;

class ReplayTest : public testing::Test {
 protected:
  ReplayTest() { fs::create_directories(folder_); }
  ~ReplayTest() override {
    fs::permissions(folder_, fs::perms::owner_all);
    fs::remove_all(folder_);
  }

  struct Outcome {
    int status = 0;
    std::string out, err;
  };

  Outcome Replay(const std::string& arguments) const {
    const std::string command =
        REPLAY_PROGRAM " " + arguments + " > " + (folder_ / "out").string() + " 2> " + (folder_ / "err").string();
    Outcome outcome;
    const int status = std::system(command.c_str());
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    outcome.out = Text(folder_ / "out");
    outcome.err = Text(folder_ / "err");
    return outcome;
  }

  std::string Arguments(const std::string& input = "in.bag", const std::string& scene = BlockScene()) const {
    return "--scene " + scene + " --input " + (folder_ / input).string() + " --output " +
           (folder_ / "out.bag").string();
  }

  // Replaying must fail with one line that has all of `parts` in it, and leave no output.
  void ExpectRefusal(const std::string& arguments, const std::vector<std::string>& parts) const {
    const Outcome outcome = Replay(arguments);
    EXPECT_EQ(outcome.status, 1) << arguments;
    for (const std::string& part : parts) EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      EXPECT_EQ(entry.path().filename().string().find("out.bag"), std::string::npos) << "left behind: " << entry.path();
    }
  }

  static std::string Text(const fs::path& file) {
    std::ifstream stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  template <class Message>
  void WriteBag(const std::vector<Message>& messages, const std::string& topic) const {
    rosbag::Bag bag((folder_ / "in.bag").string(), rosbag::bagmode::Write);
    for (const Message& message : messages) bag.write(topic, message.header.stamp, message);
  }

  void WriteStroke() const { WriteBag(Stroke(ros::Time(10), 0.0627), "/simulator/scalpel/measured_cp"); }

  template <class Message>
  std::vector<boost::shared_ptr<Message>> Read(const std::string& topic) const {
    const rosbag::Bag bag((folder_ / "out.bag").string(), rosbag::bagmode::Read);
    rosbag::View view(bag, rosbag::TopicQuery(topic));
    std::vector<boost::shared_ptr<Message>> messages;
    for (const rosbag::MessageInstance& message : view) messages.push_back(message.instantiate<Message>());
    return messages;
  }

  // Every message as bytes.
  static std::vector<std::string> Contents(const fs::path& file) {
    const rosbag::Bag bag(file.string(), rosbag::bagmode::Read);
    rosbag::View view(bag);
    std::vector<std::string> contents;
    for (const rosbag::MessageInstance& message : view) {
      std::string bytes(message.size(), '\0');
      ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), message.size());
      message.write(stream);
      contents.push_back(message.getTopic() + " " + std::to_string(message.getTime().toNSec()) + " " + bytes);
    }
    return contents;
  }

  const fs::path folder_ = testing::TempDir() + "replay_" + std::to_string(getpid());
};

TEST_F(ReplayTest, CutsTheBlockInTwo) {
  WriteStroke();
  const Outcome outcome = Replay(Arguments());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("25 frames, 0.500 s; 1 strokes"), std::string::npos) << outcome.out;

  const auto topologies = Read<SurfaceTopology>("/simulator/surface/topology");
  const auto positions = Read<SurfacePositions>("/simulator/surface/positions");
  const auto statistics = Read<StepStatistics>("/simulator/statistics");
  const auto events = Read<CutEvent>("/simulator/cut_events");
  const auto sessions = Read<SessionInfo>("/simulator/session");
  ASSERT_EQ(sessions.size(), 1u);
  EXPECT_EQ(sessions[0]->scene_text, Text(BlockScene()));
  EXPECT_TRUE(sessions[0]->has_gravity && sessions[0]->has_tools && !sessions[0]->has_obstacles);
  ASSERT_EQ(positions.size(), 26u) << "as loaded, and 25 frames";
  ASSERT_EQ(statistics.size(), 25u);
  EXPECT_EQ(statistics.back()->fragments, 2u);
  EXPECT_EQ(positions.back()->header.stamp, ros::Time(10.5)) << "the time base is the first sample";
  std::set<std::uint32_t> versions;
  for (const auto& topology : topologies) versions.insert(topology->version);
  for (const auto& position : positions) EXPECT_TRUE(versions.count(position->version)) << position->version;
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.front()->event, CutEvent::STARTED);
  EXPECT_EQ(events.front()->tool, "scalpel");
  bool separated = false;
  for (const auto& event : events) separated = separated || event->event == CutEvent::SEPARATED;
  EXPECT_TRUE(separated);
}

TEST_F(ReplayTest, TwoReplaysAreIdentical) {
  WriteStroke();
  ASSERT_EQ(Replay(Arguments()).status, 0);
  const auto first = Contents(folder_ / "out.bag");
  ASSERT_EQ(Replay(Arguments()).status, 0);
  EXPECT_TRUE(first == Contents(folder_ / "out.bag"));
}

TEST_F(ReplayTest, WhatAReplayWroteCanBeReplayedToTheBit) {
  WriteStroke();
  ASSERT_EQ(Replay(Arguments()).status, 0);
  const auto first = Contents(folder_ / "out.bag");
  std::filesystem::rename(folder_ / "out.bag", folder_ / "recorded.bag");
  ASSERT_EQ(Replay(Arguments("recorded.bag") + " --as-recorded").status, 0);
  EXPECT_TRUE(first == Contents(folder_ / "out.bag"));
}

TEST_F(ReplayTest, SixteenBitsAreNearEnoughAndHalfTheSize) {
  WriteStroke();
  ASSERT_EQ(Replay(Arguments()).status, 0);
  const auto exact = Read<SurfacePositions>("/simulator/surface/positions");
  ASSERT_EQ(Replay(Arguments() + " --encoding uint16").status, 0);
  const auto packed = Read<SurfacePositions>("/simulator/surface/positions");
  ASSERT_EQ(exact.size(), packed.size());
  for (std::size_t i = 0; i < exact.size(); ++i) {
    EXPECT_TRUE(packed[i]->positions.empty());
    const std::vector<float> positions = Decode(*packed[i]);
    ASSERT_EQ(positions.size(), exact[i]->positions.size());
    for (std::size_t k = 0; k < positions.size(); ++k) {
      ASSERT_NEAR(positions[k], exact[i]->positions[k], packed[i]->box_size[k % 3] / 131070 + 1e-7);
    }
  }
}

TEST_F(ReplayTest, TransformsOnAnotherTopicCutTheSame) {
  WriteStroke();
  ASSERT_EQ(Replay(Arguments()).status, 0);
  const auto poses = Contents(folder_ / "out.bag");
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (const auto& pose : Stroke(ros::Time(10), 0.0627)) transforms.push_back(ToTransform(pose));
  WriteBag(transforms, "/raven/left");
  const Outcome outcome = Replay(Arguments() + " --tool scalpel:=/raven/left");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(poses == Contents(folder_ / "out.bag"));
}

TEST_F(ReplayTest, CutsWithAFrameOfTf) {
  rosbag::Bag bag((folder_ / "in.bag").string(), rosbag::bagmode::Write);
  for (const auto& pose : Stroke(ros::Time(10), 0.0627)) {
    tf2_msgs::TFMessage tf;
    tf.transforms = {ToTransform(pose, "blade")};
    bag.write("/tf", pose.header.stamp, tf);
  }
  bag.close();
  const std::string scene = MESHLESS_CUTTING_TEST_DIR "/data/block_tf.yaml";
  ExpectRefusal(Arguments("in.bag", scene),
                {"block_tf.yaml:14: key `tools[0].urdf_link`: blade: expected a robot description"});
  const Outcome outcome = Replay(Arguments("in.bag", scene) + " --urdf " MESHLESS_CUTTING_TEST_DIR "/data/blade.urdf");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(Read<StepStatistics>("/simulator/statistics").back()->fragments, 2u);
}

TEST_F(ReplayTest, ReportsBadSamplesAndGoesOn) {
  auto poses = Stroke(ros::Time(10), 0.0627);
  poses[3].pose.position.y = std::nan("");
  poses[7].pose.orientation.w = 0;
  poses[20].header.stamp = poses[5].header.stamp;
  rosbag::Bag bag((folder_ / "in.bag").string(), rosbag::bagmode::Write);
  ros::Time time(10);
  for (const auto& pose : poses) bag.write("/simulator/scalpel/measured_cp", time += ros::Duration(0.005), pose);
  bag.close();
  const Outcome outcome = Replay(Arguments());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* fault : {"not finite, 1 samples", "zero quaternion, 1 samples", "back in time, 1 samples"}) {
    EXPECT_NE(outcome.out.find(fault), std::string::npos) << outcome.out;
  }
  EXPECT_EQ(Read<StepStatistics>("/simulator/statistics").back()->fragments, 2u);
}

TEST_F(ReplayTest, ABagCutOffInTheMiddleIsUsedAsFarAsItGoes) {
  WriteStroke();
  fs::resize_file(folder_ / "in.bag", fs::file_size(folder_ / "in.bag") * 6 / 10);
  const Outcome outcome = Replay(Arguments());
  EXPECT_EQ(outcome.status, 1) << "the loss is an error all the same";
  EXPECT_NE(outcome.err.find("in.bag: damaged or not closed; used the "), std::string::npos) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_GT(Read<SurfacePositions>("/simulator/surface/positions").size(), 5u);
}

TEST_F(ReplayTest, RefusesInOneLine) {
  WriteStroke();
  ExpectRefusal(Arguments("missing.bag"), {"missing.bag: no such file; expected a bag"});
  ExpectRefusal(Arguments("in.bag", "nowhere.yaml"), {"nowhere.yaml: no such file; expected a scene file"});
  ExpectRefusal(Arguments() + " --tool knife:=/a", {"--tool knife: expected the name of a tool"});
  ExpectRefusal(Arguments() + " --tool scalpel:=/a",
                {"no poses on /a, given for tool scalpel", "/simulator/scalpel/measured_cp"});
  ExpectRefusal(Arguments() + " --speed 2", {"--speed: unknown argument"});
  ExpectRefusal("--scene a --input b", {"--output: missing"});
  ExpectRefusal(Arguments() + " --as-recorded", {"no message on /simulator/inputs", "call ~reset once the recorder"});
  ExpectRefusal(Arguments() + " --as-recorded --tool scalpel:=/a", {"--tool with --as-recorded: expected one of them"});
  ExpectRefusal(Arguments() + " --encoding zip", {"--encoding: `zip`: expected float32"});
  ExpectRefusal("--scene " + BlockScene() + " --input " + (folder_ / "in.bag").string() + " --output " +
                    (folder_ / "no/such/folder/out.bag").string(),
                {"out.bag: cannot be written; expected a path in a folder that exists"});
}

TEST_F(ReplayTest, RefusesABagWithoutToolTopic) {
  WriteBag(Stroke(ros::Time(10), 0.0627), "/other/pose");
  ExpectRefusal(Arguments(), {"in.bag: no tool topic; expected scalpel/measured_cp, probe/measured_cp", "/other/pose"});
}

TEST_F(ReplayTest, RefusesWhatIsNoBag) {
  std::ofstream(folder_ / "in.bag") << "not a bag";
  ExpectRefusal(Arguments(), {"in.bag: not a bag"});
  std::ofstream(folder_ / "in.bag") << "";
  ExpectRefusal(Arguments(), {"in.bag: not a bag"});
}

TEST_F(ReplayTest, KeepsTheOldOutputWhenItFails) {
  WriteStroke();
  ASSERT_EQ(Replay(Arguments()).status, 0);
  const auto before = Contents(folder_ / "out.bag");
  EXPECT_EQ(Replay(Arguments() + " --tool scalpel:=/a").status, 1);
  EXPECT_TRUE(before == Contents(folder_ / "out.bag"));
}

TEST_F(ReplayTest, ReplaysWhatTheToolPlayerWrites) {
  std::ofstream(folder_ / "path.yaml")
      << "tool_path_version: 1\nwaypoints:\n"
         "  - {time_s: 0, position_m: [0.0627, 0, 0.06], orientation_xyzw: [0, 0, 0, 1]}\n"
         "  - {time_s: 0.5, position_m: [0.0627, 0, -0.03], orientation_xyzw: [0, 0, 0, 1]}\n";
  const std::string command = TOOL_PLAYER_PROGRAM " --path " + (folder_ / "path.yaml").string() + " --bag " +
                              (folder_ / "in.bag").string() + " --rate 1000 > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const Outcome outcome = Replay(Arguments());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("501 samples of /simulator/scalpel/measured_cp"), std::string::npos) << outcome.out;
  EXPECT_EQ(Read<StepStatistics>("/simulator/statistics").back()->fragments, 2u);
}

}  // namespace
}  // namespace meshless_cutting
