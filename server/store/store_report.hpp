#pragma once
/// The outcome of a check or a backup of all stored data.
#include <cstdint>
#include <string>
#include <vector>

namespace driftlab::server {

/// `faults` are sentences; empty: all is well.
struct StoreReport {
  std::int64_t blobs = 0;
  std::int64_t bytes = 0;
  std::vector<std::string> faults;
};

}  // namespace driftlab::server
