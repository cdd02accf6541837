#include "progress_bar.h"

#include <unistd.h>

#include <algorithm>

namespace meshless_cutting {
namespace {

constexpr int kWidth = 40;

}  // namespace

ProgressBar::ProgressBar(std::FILE* stream) : stream_(stream), is_terminal_(isatty(fileno(stream)) != 0) {}

ProgressBar::~ProgressBar() {
  if (is_terminal_) std::fputs("\r\033[K", stream_);
}

void ProgressBar::Show(double share, const std::string& what) {
  if (!is_terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  const int filled = static_cast<int>(std::clamp(share, 0.0, 1.0) * kWidth);
  std::fprintf(stream_, "\r[%s%s] %3.0f %%  %s\033[K", std::string(filled, '#').c_str(),
               std::string(kWidth - filled, ' ').c_str(), 100 * std::clamp(share, 0.0, 1.0), what.c_str());
  std::fflush(stream_);
}

}  // namespace meshless_cutting
