// cut_search [--strokes N] [--seed S] [--body NAME] [--bugs DIR]: random strokes until N are done, each frame checked
// (see stroke_search.h). A failure is written to DIR as a file that random_strokes_test then replays for ever.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "cut/stroke_search.h"

namespace meshless_cutting {
namespace {

constexpr int kStrokesPerEpisode = 8;

struct Options {
  long strokes = 1000;
  std::uint64_t seed = 1;
  std::string body, bugs;
};

int Search(const Options& options) {
  SearchCounts counts;
  std::map<std::string, Lattice> lattices;
  long failures = 0;
  std::uint64_t seed = options.seed;
  bool found_body = false;
  while (counts.strokes < options.strokes) {
    for (const SearchBody& body : SearchBodies()) {
      if (!options.body.empty() && options.body != body.name) continue;
      found_body = true;
      auto at = lattices.find(body.name);
      if (at == lattices.end()) at = lattices.emplace(body.name, body.make_lattice()).first;
      const std::string error = SearchEpisode(at->second, body.cell_size_m, seed, kStrokesPerEpisode, counts);
      if (error.empty()) continue;
      ++failures;
      std::printf("FAILED %s seed %llu: %s\n", body.name.c_str(), static_cast<unsigned long long>(seed), error.c_str());
      if (!options.bugs.empty())
        std::ofstream(std::filesystem::path(options.bugs) / (body.name + "_" + std::to_string(seed) + ".txt"))
            << body.name << ' ' << seed << ' ' << kStrokesPerEpisode << '\n';
    }
    if (!found_body) {
      std::fprintf(stderr, "--body: '%s' is not one of the bodies:", options.body.c_str());
      for (const SearchBody& body : SearchBodies()) std::fprintf(stderr, " %s", body.name.c_str());
      std::fprintf(stderr, "\n");
      return 1;
    }
    if (++seed % 50 == 0) {
      std::printf("%ld strokes, %ld frames, %ld links cut, %ld predicates, %ld failures\n", counts.strokes,
                  counts.frames, counts.links_cut, counts.predicates, failures);
      std::fflush(stdout);
    }
  }
  std::printf("done: %ld strokes, %ld frames, %ld links cut, %ld predicates checked, %ld fragments, %ld failures\n",
              counts.strokes, counts.frames, counts.links_cut, counts.predicates, counts.fragments, failures);
  return failures == 0 ? 0 : 1;
}

}  // namespace
}  // namespace meshless_cutting

int main(int argc, char** argv) {
  meshless_cutting::Options options;
  for (int i = 1; i < argc; i += 2) {
    const std::string key = argv[i];
    if (i + 1 >= argc || (key != "--strokes" && key != "--seed" && key != "--body" && key != "--bugs")) {
      std::fprintf(stderr, "%s: expected [--strokes N] [--seed S] [--body NAME] [--bugs DIR]\n", key.c_str());
      return 1;
    }
    if (key == "--strokes") options.strokes = std::atol(argv[i + 1]);
    if (key == "--seed") options.seed = std::strtoull(argv[i + 1], nullptr, 10);
    if (key == "--body") options.body = argv[i + 1];
    if (key == "--bugs") options.bugs = argv[i + 1];
  }
  try {
    return meshless_cutting::Search(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
