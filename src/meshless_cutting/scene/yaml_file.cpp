// From a file to a YAML tree whose keys know their lines.
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "scene/yaml_section.h"

namespace meshless_cutting {
namespace {

namespace fs = std::filesystem;

// Far above any key that is known; an alias that contains itself (`a: &a [*a]`) would nest without end.
constexpr std::size_t kLongestKey = 200;

std::string ReadText(const fs::path& file, const std::string& what) {
  std::error_code error;
  const bool is_file = fs::is_regular_file(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (!is_file || !stream) {
    throw std::runtime_error(file.string() + ": " + (fs::exists(file, error) ? "not a readable file" : "no such file") +
                             "; expected " + what);
  }
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void RecordLines(const YAML::Node& node, const std::string& key, SourceFile* source) {
  if (key.size() > kLongestKey) {
    throw std::runtime_error(source->file.string() + ":" + std::to_string(node.Mark().line + 1) + ": key `" +
                             key.substr(0, 40) + "...`: nested too deeply; expected at most a few levels");
  }
  if (node.IsMap()) {
    for (const auto& item : node) {
      if (!item.first.IsScalar()) continue;
      const std::string child = (key.empty() ? "" : key + ".") + item.first.Scalar();
      source->lines.emplace(child, item.first.Mark().line + 1);
      RecordLines(item.second, child, source);
    }
  } else if (node.IsSequence()) {
    for (std::size_t i = 0; i < node.size(); ++i) {
      const std::string child = key + "[" + std::to_string(i) + "]";
      source->lines.emplace(child, node[i].Mark().line + 1);
      RecordLines(node[i], child, source);
    }
  }
}

}  // namespace

YAML::Node LoadYaml(const fs::path& file, const std::string& what, SourceFile* source) {
  source->file = file;
  source->text = ReadText(file, what);
  YAML::Node tree;
  try {
    tree = YAML::Load(source->text);
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(file.string() + ":" + std::to_string(error.mark.line + 1) + ": not YAML (" + error.msg +
                             "); expected `key: value` lines, indented with spaces");
  }
  if (!tree.IsMap()) throw std::runtime_error(file.string() + ":1: " + Quote(tree) + ": expected " + what);
  RecordLines(tree, "", source);
  return tree;
}

}  // namespace meshless_cutting
