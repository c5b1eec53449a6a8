#include "clients/cli/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace driftlab::cli {

ProgressBar::ProgressBar() : terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (drawn_) {
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
  }
}

void ProgressBar::show(std::string_view stage, double fraction) {
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_ || (drawn_ && now - last_ < std::chrono::milliseconds(50) && fraction < 1.0)) {
    return;
  }
  last_ = now;
  drawn_ = true;
  constexpr int kWidth = 30;
  const int full = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * kWidth);
  std::string bar;
  for (int i = 0; i < kWidth; ++i) {
    bar += i < full ? "█" : "░";
  }
  const std::string shown(stage.substr(0, 40));
  std::fprintf(stderr, "\r\033[K%s %3.0f %%  %s", bar.c_str(), 100.0 * fraction, shown.c_str());
  std::fflush(stderr);
}

}  // namespace driftlab::cli
