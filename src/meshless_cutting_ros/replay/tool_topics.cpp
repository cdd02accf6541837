#include "replay/tool_topics.h"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace meshless_cutting {
namespace {

std::string Join(const std::set<std::string>& topics) {
  std::string joined;
  for (const std::string& topic : topics) joined += (joined.empty() ? "" : ", ") + topic;
  return joined.empty() ? "none" : joined;
}

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string FindTopic(const std::set<std::string>& poses, const std::string& name, const TopicChoice& choice,
                      const std::string& tool, const std::string& bag) {
  if (const auto given = choice.given.find(tool); given != choice.given.end()) {
    const std::string topic = given->second.front() == '/' ? given->second : "/" + given->second;
    for (const std::string& candidate : {given->second, topic}) {
      if (poses.count(candidate)) return candidate;
    }
    throw std::runtime_error(bag + ": no poses on " + topic + ", given for tool " + tool +
                             "; expected one of the pose topics: " + Join(poses));
  }
  const bool absolute = name.front() == '/';
  const std::string below = name.front() == '~' ? name.substr(1) : name;
  for (const std::string& candidate : {absolute ? name : choice.simulator + "/" + below, "/" + below, below}) {
    if (poses.count(candidate)) return candidate;
  }
  std::set<std::string> fitting;
  for (const std::string& topic : poses) {
    if (EndsWith(topic, absolute ? name : "/" + below)) fitting.insert(topic);
  }
  if (fitting.size() > 1) {
    throw std::runtime_error(bag + ": several topics fit tool " + tool + ": " + Join(fitting) +
                             "; expected one: choose with --tool " + tool + ":=TOPIC");
  }
  return fitting.empty() ? "" : *fitting.begin();
}

}  // namespace

std::vector<std::string> FindToolTopics(const std::vector<const rosbag::ConnectionInfo*>& connections,
                                        const Scene& scene, const TopicChoice& choice, const std::string& bag) {
  std::set<std::string> poses, all;
  for (const rosbag::ConnectionInfo* connection : connections) {
    const bool pose =
        connection->datatype == "geometry_msgs/PoseStamped" || connection->datatype == "geometry_msgs/TransformStamped";
    if (pose) poses.insert(connection->topic);
    all.insert(connection->topic);
  }
  for (const auto& given : choice.given) {
    const bool known = std::any_of(scene.tools.begin(), scene.tools.end(),
                                   [&given](const ToolConfig& tool) { return tool.name == given.first; });
    if (!known)
      throw std::runtime_error("--tool " + given.first + ": expected the name of a tool of " + scene.file.string());
  }
  std::vector<std::string> topics;
  std::string wanted;
  bool has_source = false, found = false;
  for (const ToolConfig& tool : scene.tools) {
    topics.emplace_back();
    if (const auto* source = std::get_if<TopicPoseSource>(&tool.pose_source)) {
      topics.back() = FindTopic(poses, source->topic, choice, tool.name, bag);
      has_source = true;
      found = found || !topics.back().empty();
      wanted += (wanted.empty() ? "" : ", ") + source->topic;
    } else if (std::holds_alternative<TfPoseSource>(tool.pose_source)) {
      has_source = true;
      found = found || all.count("/tf") || all.count("tf");
      wanted += (wanted.empty() ? "" : ", ") + std::string("/tf");
    }
  }
  if (has_source && !found) {
    throw std::runtime_error(bag + ": no tool topic; expected " + wanted + " of " + scene.file.string() +
                             "; pose topics in the bag: " + Join(poses) + "; choose one with --tool NAME:=TOPIC");
  }
  return topics;
}

}  // namespace meshless_cutting
