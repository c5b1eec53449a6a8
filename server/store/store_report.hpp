#pragma once
/// What was found or copied of everything that is stored.
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
