// A line that says how far a long job is, on a terminal only.
#pragma once

#include <chrono>
#include <cstdio>
#include <string>

namespace meshless_cutting {

class ProgressBar {
 public:
  /// Shows nothing when `stream` is not a terminal.
  explicit ProgressBar(std::FILE* stream);
  /// Clears the line.
  ~ProgressBar();

  /// `share` in [0, 1]. Draws at most ten times a second.
  void Show(double share, const std::string& what);

 private:
  std::FILE* stream_;
  bool is_terminal_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace meshless_cutting
