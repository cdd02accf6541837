// The program `replay`.
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "progress_bar.h"
#include "replay/replay.h"

namespace {

std::atomic<bool> interrupted{false};

void Interrupt(int) { interrupted = true; }

std::string OneLine(std::string text) {
  for (char& c : text) c = c == '\n' || c == '\r' ? ' ' : c;
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, Interrupt);
  std::signal(SIGTERM, Interrupt);
  try {
    const meshless_cutting::ReplayOptions options =
        meshless_cutting::ParseReplayOptions(std::vector<std::string>(argv + 1, argv + argc));
    if (options.help) {
      std::fputs(meshless_cutting::kReplayUsage, stdout);
      return 0;
    }
    meshless_cutting::ReplayResult result;
    {
      meshless_cutting::ProgressBar bar(stderr);
      result = meshless_cutting::RunReplay(options, [&bar](double share, const std::string& what) {
        bar.Show(share, what);
        return !interrupted;
      });
    }
    std::printf("%s\n", result.summary.c_str());
    if (result.loss.empty()) return 0;
    std::fprintf(stderr, "replay: %s\n", OneLine(result.loss).c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "replay: %s\n", OneLine(error.what()).c_str());
  }
  return 1;
}
