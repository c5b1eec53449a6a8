#pragma once
/// A progress bar on standard error, where that is a terminal; silence elsewhere.
#include <chrono>
#include <string>
#include <string_view>

namespace driftlab::cli {

class ProgressBar {
 public:
  ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  /// Clears the line.
  ~ProgressBar();
  /// Redraws at most twenty times a second.
  void show(std::string_view stage, double fraction);

 private:
  bool terminal_ = false;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace driftlab::cli
