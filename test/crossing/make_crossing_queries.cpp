// Writes random queries with exact answers, in the format of crossing_queries.h:
//   make_crossing_queries <queries per kind> [seed] > queries.csv
// The answers come from reference_crossing.h, which shares nothing with the code that they are to test.
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "crossing/random_queries.h"
#include "crossing/reference_crossing.h"

int main(int argc, char** argv) {
  using namespace meshless_cutting::test;
  const int count = argc > 1 ? std::atoi(argv[1]) : 0;
  if (count <= 0) {
    std::fprintf(stderr, "usage: make_crossing_queries <queries per kind> [seed]\n");
    return 2;
  }
  std::mt19937_64 random(argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1);
  std::printf("# edge-edge crossing queries, written by make_crossing_queries\n");
  for (const std::string& kind : RandomKinds()) {
    for (int i = 0; i < count; ++i) {
      CrossingQuery query = RandomQuery(kind, random);
      const std::optional<double> time = meshless_cutting::test::ReferenceFirstContact(query.a, query.b);
      query.truth = time.has_value();
      query.time_of_contact = time.value_or(-1);
      std::puts(ToLine(query).c_str());
    }
  }
}
