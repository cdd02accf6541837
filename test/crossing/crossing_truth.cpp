// Runs FindFirstCrossing() on queries with known answers and prints misses, false hits and time per category.
//   crossing_truth queries.csv[.gz] ...
// The format is that of crossing_queries.h. Exit code 1 on any wrong answer.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "crossing/crossing_queries.h"

namespace {

using meshless_cutting::EdgeCrossing;
using meshless_cutting::FindFirstCrossing;
using meshless_cutting::test::CrossingQuery;

constexpr double kFarGap = 1e-5;        // of the extent: a false hit beyond it is no matter of rounding
constexpr double kTimeAccuracy = 1e-9;  // relative
constexpr int kRepeats = 15;            // of each category; the fastest counts, to be robust against other load

struct Score {
  int queries = 0, hits = 0, misses = 0, false_hits = 0, far_false_hits = 0, bad_values = 0;
  double ns = 0;  // all queries, one pass
};

using Queries = std::map<std::string, std::vector<CrossingQuery>>;

double Extent(const CrossingQuery& query) {
  double extent = 0;
  for (const Eigen::Vector3d* point :
       {&query.a.q_t0, &query.b.p_t0, &query.b.q_t0, &query.a.p_t1, &query.a.q_t1, &query.b.p_t1, &query.b.q_t1}) {
    extent = std::max(extent, (*point - query.a.p_t0).cwiseAbs().maxCoeff());
  }
  return extent;
}

bool IsProportion(double x) { return x >= 0 && x <= 1; }

Score Check(const std::string& category, const std::vector<CrossingQuery>& queries) {
  Score score;
  for (const CrossingQuery& query : queries) {
    const std::optional<EdgeCrossing> found = FindFirstCrossing(query.a, query.b);
    const char* wrong = nullptr;
    ++score.queries;
    score.hits += query.truth;
    if (query.truth && !found) {
      ++score.misses;
      wrong = "miss";
    } else if (!query.truth && found) {
      ++score.false_hits;
      score.far_false_hits += query.gap > kFarGap * Extent(query);
      wrong = "false hit";
    } else if (found) {
      const double error = std::abs(found->t - query.time_of_contact);
      if (!(error <= kTimeAccuracy * query.time_of_contact) || !IsProportion(found->t) || !IsProportion(found->u) ||
          !IsProportion(found->v)) {
        ++score.bad_values;
        wrong = "wrong t, u or v";
      }
    }
    if (wrong != nullptr) std::printf("%s: %s line %d\n", wrong, category.c_str(), query.line);
  }
  return score;
}

/// ns for one pass over the queries.
double Time(const std::vector<CrossingQuery>& queries) {
  double best = HUGE_VAL;
  int hits = 0;
  for (int i = 0; i < kRepeats; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    for (const CrossingQuery& query : queries) hits += FindFirstCrossing(query.a, query.b).has_value();
    const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - begin;
    best = std::min(best, elapsed.count());
  }
  return hits >= 0 ? best : 0;  // uses the hits, so that the calls stay
}

void Print(const char* name, const Score& score) {
  std::printf("%-16s %8d %8d %8d %10d %14d %10d %10.0f\n", name, score.queries, score.hits, score.misses,
              score.false_hits, score.far_false_hits, score.bad_values, score.ns / score.queries);
}

}  // namespace

int main(int argc, char** argv) {
  Queries queries;
  try {
    for (int i = 1; i < argc; ++i) {
      for (CrossingQuery& query : meshless_cutting::test::ReadCrossingQueries(argv[i])) {
        queries[query.category].push_back(std::move(query));
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "crossing_truth: %s\n", error.what());
    return 2;
  }
  if (queries.empty()) {
    std::fprintf(stderr, "usage: crossing_truth queries.csv[.gz] ...\n");
    return 2;
  }
  std::map<std::string, Score> scores;
  Score all;
  for (const auto& [category, list] : queries) {
    Score& score = scores[category] = Check(category, list);
    score.ns = Time(list);
    all.queries += score.queries;
    all.hits += score.hits;
    all.misses += score.misses;
    all.false_hits += score.false_hits;
    all.far_false_hits += score.far_false_hits;
    all.bad_values += score.bad_values;
    all.ns += score.ns;
  }
  std::printf("%-16s %8s %8s %8s %10s %14s %10s %10s\n", "category", "queries", "hits", "misses", "false hits",
              "gap > 1e-5", "bad t/u/v", "ns/query");
  for (const auto& [category, score] : scores) Print(category.c_str(), score);
  Print("all", all);
  return all.misses + all.false_hits + all.bad_values > 0 ? 1 : 0;
}
