#include "server/readiness.hpp"

#include "server/observe/log.hpp"

namespace driftlab::server {
namespace {

constexpr double kLeastFreeFraction = 0.05;
constexpr std::uintmax_t kEnoughFreeBytes = 10ULL * 1024 * 1024 * 1024;
constexpr std::chrono::seconds kProbeInterval{2};

}  // namespace

std::string Readiness::why_not() const {
  if (const Status answered = store_.ping(); !answered) {
    return "The store does not answer: " + answered.error().message;
  }
  if (is_nearly_full()) {
    return "The disk is nearly full.";
  }
  return cannot_write_why();
}

bool Readiness::is_nearly_full() const {
  const auto space = blobs_.space();
  return !space || (space->free_fraction < kLeastFreeFraction && space->free_bytes < kEnoughFreeBytes);
}

std::string Readiness::cannot_write_why() const {
  const std::lock_guard<std::mutex> guard(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (probed_at_ && now - *probed_at_ < kProbeInterval) {
    return write_fault_;
  }
  const Status written = store_.write_probe();
  probed_at_ = std::chrono::steady_clock::now();
  const std::string fault = written ? "" : "The store cannot be written: " + written.error().message;
  if (fault != write_fault_) {
    fault.empty() ? log_info("the store can be written again") : log_error("bad state", Json{{"detail", fault}});
  }
  write_fault_ = fault;
  return write_fault_;
}

}  // namespace driftlab::server
