// Runs a scene without tools frame by frame and records what its probes and regions show.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "simulation.h"

namespace meshless_cutting {

/// Machine, compiler, flags, commit: lines that begin with "# ".
std::string RunHeader();

/// Writes one row per frame, the state at rest first: time, energies, residual, status bits, wall time, then x, y, z of the
/// displacement of each probe, and force and torque of each held region. `progress(share)` is called after each frame.
/// Throws std::runtime_error where the simulation does.
void RunScene(const Scene& scene, int frames, std::ostream& csv, const std::function<void(double)>& progress);

}  // namespace meshless_cutting
