#include <string>

#include "scene/scene.h"

namespace meshless_cutting {
namespace {

// "a.b[2].c" -> "a.b[2]" -> "a.b" -> "a" -> "".
std::string Parent(const std::string& key) {
  const auto end = key.find_last_of(".[");
  return end == std::string::npos ? std::string() : key.substr(0, end);
}

}  // namespace

std::string SceneMessage(const SourceFile& source, const std::string& key, const std::string& value,
                         const std::string& expected) {
  int line = 1;
  for (std::string section = key; !section.empty(); section = Parent(section)) {
    if (const auto found = source.lines.find(section); found != source.lines.end()) {
      line = found->second;
      break;
    }
  }
  std::string message = source.file.string() + ":" + std::to_string(line) + ": ";
  if (!key.empty()) message += "key `" + key + "`: ";
  if (!value.empty()) message += value + ": ";
  return message + expected;
}

}  // namespace meshless_cutting
