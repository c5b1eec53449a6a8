#include "server/readiness.hpp"

#include "server/store/told_error.hpp"

namespace driftlab::server {
namespace {

constexpr double kLeastFreeFraction = 0.05;
constexpr std::uintmax_t kEnoughFreeBytes = 10ULL * 1024 * 1024 * 1024;

}  // namespace

std::string Readiness::told(BadState state, const std::string& what, const Status& checked) const {
  if (checked) {
    states_.end(state);
    return {};
  }
  const std::string_view cause = cause_of(checked.error());
  states_.begin(state, cause, what + checked.error().message);
  return what + without_paths(checked.error()).message + " (state " + std::string(name_of(state)) + ", cause " +
         std::string(cause) + ")";
}

std::string Readiness::why_not() const { return look(true); }

void Readiness::look_after() const { (void)look(!states_.standing().empty()); }

std::string Readiness::look(bool tries_to_write) const {
  const std::string silent = told(BadState::StoreSilent, "The store does not answer: ", store_.ping());
  const Status room =
      is_nearly_full() ? Status(fail(ErrorCode::DiskFull, "less than it needs is free, or nobody can say.")) : Status{};
  const std::string full = told(BadState::DiskNearlyFull, "The disk is nearly full: ", room);
  const std::string unwritable =
      tries_to_write ? told(BadState::StoreUnwritable,
                            "The store cannot be written: ", writable_.ask([&] { return store_.write_probe(); }))
                     : "";
  const std::string unreachable =
      told(BadState::BlobsSilent, "Recordings cannot be reached: ", reachable_.ask([&] { return blobs_.ping(); }));
  return !silent.empty() ? silent : !full.empty() ? full : !unwritable.empty() ? unwritable : unreachable;
}

bool Readiness::is_nearly_full() const {
  const auto space = blobs_.space();
  return !space || (space->free_fraction < kLeastFreeFraction && space->free_bytes < kEnoughFreeBytes);
}

Status Readiness::Probe::ask(const std::function<Status()>& question) {
  const std::lock_guard<std::mutex> guard(mutex_);
  if (!asked_at_ || std::chrono::steady_clock::now() - *asked_at_ >= interval_) {
    answer_ = question();
    asked_at_ = std::chrono::steady_clock::now();
  }
  return answer_;
}

}  // namespace driftlab::server
