#pragma once
/// A world for tests of server/: a clock that obeys, a directory that vanishes, rows to begin with.
#include "server/store/principal.hpp"
#include "server/store/store.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <string>

namespace driftlab::server {

inline constexpr std::int64_t kSecond = 1'000'000;
inline constexpr std::int64_t kMinute = 60 * kSecond;
inline constexpr std::int64_t kHour = 60 * kMinute;
inline constexpr std::int64_t kLease = kMinute;

class FakeClock final : public Clock {
 public:
  [[nodiscard]] UtcMicros now() const override { return now_; }
  void advance(std::int64_t micros) { now_ += micros; }

 private:
  std::atomic<UtcMicros> now_{1'795'000'000'000'000};  // 2026-11-18
};

class TemporaryDirectory {
 public:
  TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  ~TemporaryDirectory();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Files below a directory, at any depth, without those that end in `.lock`.
std::vector<std::string> files_below(const std::filesystem::path& directory);

/// A text of 64 hexadecimal digits that depends on `seed`.
std::string hash_of(const std::string& seed);

Device add_device(Store& store, const std::string& name = "phone-07");
Recording add_recording(Store& store, const Device& device, const std::string& seed = "bytes",
                        const std::string& condition = "static");
/// A token of its own, and the caller who holds it.
Caller add_caller(Store& store, const std::string& id);
Job add_job(Store& store, const std::string& unique_key, int priority = 5);
Job claim_one(Store& store);
inline Lease lease_of(const Job& job) { return {job.id, job.attempt}; }
/// One channel with two fits.
JobResults results_for(const Job& job, const Recording& recording, const std::string& channel = "gz");

}  // namespace driftlab::server
