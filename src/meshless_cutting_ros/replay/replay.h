// Bag in, bag out: the frames of the node without a master and without a clock.
#pragma once

#include <functional>
#include <string>

#include "replay/replay_options.h"

namespace meshless_cutting {

struct ReplayResult {
  std::string summary;  // a few lines for stdout
  std::string loss;     // what of the input could not be read; empty: nothing
};

/// Share done in [0, 1] and what is being done. Returns false to give up.
using ReplayProgress = std::function<bool(double share, const std::string& what)>;

/// Writes options.output, or leaves nothing behind and throws std::runtime_error with one line.
ReplayResult RunReplay(const ReplayOptions& options, const ReplayProgress& progress);

}  // namespace meshless_cutting
