#pragma once
/// How long writes take, from being asked for until they are on disk.
#include <array>
#include <chrono>
#include <cstdint>
#include <mutex>

namespace driftlab::server {

/// Cumulative counts by upper bound. Thread safe.
class WriteTimes {
 public:
  static constexpr std::array<double, 8> kBounds{0.001, 0.005, 0.02, 0.05, 0.2, 1.0, 5.0, 20.0};  // [s]

  struct Counts {
    std::array<std::uint64_t, kBounds.size()> at_most{};
    std::uint64_t count = 0;
    double seconds = 0.0;  ///< of all together
  };

  void add(double seconds) {
    const std::lock_guard<std::mutex> guard(mutex_);
    for (std::size_t i = 0; i < kBounds.size(); ++i) {
      counts_.at_most[i] += seconds <= kBounds[i] ? 1 : 0;
    }
    ++counts_.count;
    counts_.seconds += seconds;
  }

  [[nodiscard]] Counts counts() const {
    const std::lock_guard<std::mutex> guard(mutex_);
    return counts_;
  }

  /// Adds the time of its own life.
  class Watch {
   public:
    explicit Watch(WriteTimes& times) : times_(times) {}
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;
    ~Watch() { times_.add(std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count()); }

   private:
    WriteTimes& times_;
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  };

 private:
  mutable std::mutex mutex_;
  Counts counts_;
};

}  // namespace driftlab::server
