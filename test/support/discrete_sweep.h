// What a scheme finds that is continuous in the tool only: the area that the blade sweeps during a frame, as triangles,
// against the edges of the object where they are at the end of it (the paper's section 2.1 compares itself with this).
#pragma once

#include <vector>

#include "simulation.h"

namespace meshless_cutting {

/// Call Before() and After() around each Simulation::Step().
class DiscreteSweep {
 public:
  explicit DiscreteSweep(int tool = 0) : tool_(tool) {}

  void Before(const Simulation& simulation);
  void After(const Simulation& simulation);

  // Links, over all frames so far.
  int found_by_both() const { return both_; }
  int missed() const { return missed_; }            // touched by the blade, not found by the discrete scheme in that frame
  int found_wrongly() const { return wrong_; }  // found by the discrete scheme, not touched in that frame

 private:
  int tool_;
  std::vector<Eigen::Vector3d> blade_;   // at the start of the frame
  std::vector<Eigen::Vector3d> object_;  // lattice vertices at the end of the window that the frame searches
  std::vector<char> was_cut_;
  int both_ = 0, missed_ = 0, wrong_ = 0;
};

}  // namespace meshless_cutting
