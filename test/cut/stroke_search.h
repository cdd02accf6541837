// Random strokes of random blades through bodies that move and deform at random, in search of a broken invariant.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lattice/lattice.h"

namespace meshless_cutting {

/// A body that is searched. Its lattice is small, so that many strokes fit into a second.
struct SearchBody {
  std::string name;
  double cell_size_m;
  std::function<Lattice()> make_lattice;
};

/// Block, thin plate, sphere, torus, liver, brain, and broken meshes: flipped faces, holes, noise.
const std::vector<SearchBody>& SearchBodies();

struct SearchCounts {
  long strokes = 0, frames = 0, links_cut = 0;
  long predicates = 0;  // checks of a named predicate on a whole body
  long fragments = 0;   // pieces at the end of episodes, summed
};

/// One body, cut by up to `strokes` strokes one after the other; what happens is determined by `seed`. In every frame
/// the crossing search must find exactly the links that an exhaustive exact search finds; after every cut all
/// predicates of simulation_checks.h hold, the enclosed rest volume is what it was, and mass, momentum and angular
/// momentum are what they were before the cut. Returns the first failure in words, nothing when all is well.
std::string SearchEpisode(const Lattice& lattice, double cell_size_m, std::uint64_t seed, int strokes,
                          SearchCounts& counts);

}  // namespace meshless_cutting
