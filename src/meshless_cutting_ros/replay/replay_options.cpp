#include "replay/replay_options.h"

#include <stdexcept>

#include "topics.h"

namespace meshless_cutting {

const char kReplayUsage[] =
    "usage: replay --scene SCENE.yaml --input IN.bag --output OUT.bag [--tool NAME:=TOPIC]... [--name /simulator] "
    "[--urdf FILE] [--encoding float32|uint16] [--as-recorded]\n"
    "\n"
    "Steps the scene over the tool poses of IN.bag, from the first to the last, and writes every message that the node "
    "would\n"
    "publish to OUT.bag. No master, no clock; two runs give identical messages.\n"
    "\n"
    "  --scene   scene file: a path or package://name/path\n"
    "  --tool    topic of a tool; default: /simulator/<topic of the scene>, or the only topic that ends with it\n"
    "  --name    name of the simulator whose topics are read and written; default /simulator\n"
    "  --urdf    robot description, for scenes that take a cutting edge from a link\n"
    "  --encoding  of positions: float32 (default; the node's bits) or uint16 (half the size)\n"
    "  --as-recorded  the frames of a recorded node to the bit, late ones included: from /simulator/inputs, not from "
    "the drivers\n"
    "\n"
    "Exit status 0, or 1 with one line on stderr. A bag that is damaged is used as far as it can be read; the loss is "
    "said and\n"
    "the exit status is 1.\n";

ReplayOptions ParseReplayOptions(const std::vector<std::string>& arguments) {
  ReplayOptions options;
  std::string encoding = "float32";
  options.name = kDefaultSimulatorName;
  const std::map<std::string, std::string*> texts = {{"--scene", &options.scene},   {"--input", &options.input},
                                                     {"--output", &options.output}, {"--name", &options.name},
                                                     {"--urdf", &options.urdf},     {"--encoding", &encoding}};
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    std::string argument = arguments[i];
    if (argument == "--help" || argument == "-h") {
      options.help = true;
      return options;
    }
    if (argument == "--as-recorded") {
      options.as_recorded = true;
      continue;
    }
    const auto text = texts.find(argument);
    if (text == texts.end() && argument != "--tool") {
      throw std::runtime_error(argument +
                               ": unknown argument; expected --scene, --input, --output, --tool, --name, --urdf, "
                               "--encoding or --as-recorded");
    }
    if (i + 1 == arguments.size()) throw std::runtime_error(argument + ": expected a value after it");
    const std::string& value = arguments[++i];
    if (text != texts.end()) {
      *text->second = value;
      continue;
    }
    const auto split = value.find(":=");
    if (split == std::string::npos || split == 0 || split + 2 == value.size()) {
      throw std::runtime_error("--tool " + value + ": expected NAME:=TOPIC");
    }
    options.topics[value.substr(0, split)] = value.substr(split + 2);
  }
  if (options.as_recorded && !options.topics.empty()) {
    throw std::runtime_error("--tool with --as-recorded: expected one of them; what was recorded names its tools");
  }
  for (const char* name : {"--scene", "--input", "--output"}) {
    if (texts.at(name)->empty()) throw std::runtime_error(std::string(name) + ": missing; see replay --help");
  }
  options.encoding = ParseEncoding("--encoding", encoding);
  if (options.name.front() != '/') options.name = "/" + options.name;
  return options;
}

}  // namespace meshless_cutting
