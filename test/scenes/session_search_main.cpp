// session_search [--sessions N] [--frames F] [--seed S] [--scene FILE.yaml]: random sessions, each frame checked (see
// session_search.h). The seeds of those that fail are printed; they belong into random_sessions_test.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

#include "scenes/session_search.h"

int main(int argc, char** argv) {
  long sessions = 100, frames = 480;
  std::uint64_t seed = 1;
  std::string scene;
  for (int i = 1; i < argc; i += 2) {
    const char* value = i + 1 < argc ? argv[i + 1] : "";
    char* end = nullptr;
    const unsigned long long number = std::strtoull(value, &end, 10);
    const bool is_number = end != value && *end == '\0' && *value != '-';
    if (is_number && std::strcmp(argv[i], "--sessions") == 0) {
      sessions = static_cast<long>(number);
    } else if (is_number && std::strcmp(argv[i], "--frames") == 0) {
      frames = static_cast<long>(number);
    } else if (is_number && std::strcmp(argv[i], "--seed") == 0) {
      seed = number;
    } else if (*value != '\0' && std::strcmp(argv[i], "--scene") == 0) {
      scene = value;
    } else {
      std::fprintf(stderr, "%s %s: expected --sessions, --frames or --seed and a whole number, or --scene and a file\n", argv[i], value);
      return 1;
    }
  }
  meshless_cutting::SessionCounts counts;
  long failures = 0;
  for (long n = 0; n < sessions; ++n) {
    std::string error;
    try {
      error = meshless_cutting::SearchSession(seed + n, static_cast<int>(frames), counts, scene);
    } catch (const std::runtime_error& unreadable) {
      std::fprintf(stderr, "%s\n", unreadable.what());
      return 1;
    }
    if (error.empty()) continue;
    ++failures;
    std::printf("FAILED seed %llu: %s\n", static_cast<unsigned long long>(seed + n), error.c_str());
    std::fflush(stdout);
  }
  std::printf("%ld sessions, %ld frames, %ld strokes, up to %ld fragments, %ld hard frames, %ld failures\n", counts.sessions,
              counts.frames, counts.strokes, counts.most_fragments, counts.hard_frames, failures);
  return failures == 0 ? 0 : 1;
}
