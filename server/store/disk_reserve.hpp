#pragma once
/// Space that is kept so that deleting works on a full disk: removing a row writes to the database's log first.
#include "core/signal/result.hpp"

#include <cstdint>
#include <filesystem>
#include <mutex>

namespace driftlab::server {

/// A file of zeros whose blocks are allocated. Thread safe.
class DiskReserve {
 public:
  /// Keeps nothing yet.
  DiskReserve(std::filesystem::path file, std::int64_t bytes) : file_(std::move(file)), bytes_(bytes) {}
  /// Makes the file where it is not there. Errors: DiskFull, Io; nothing is left then.
  [[nodiscard]] Status hold();
  /// Gives the space back. False: there was none.
  bool release();

 private:
  std::mutex mutex_;
  const std::filesystem::path file_;
  const std::int64_t bytes_;
};

}  // namespace driftlab::server
