#pragma once
/// The suites that every place of blobs passes: blob_cases.cpp and blob_fault_cases.cpp run over each of
/// `all_blob_stores`.
#include "server/store/blobs.hpp"
#include "tests/unit/store/world.hpp"

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace driftlab::server {

/// What goes wrong.
enum class BlobFault {
  Cut,          ///< connections break in the middle of what they carry
  Unavailable,  ///< it says that it cannot now, or is not there
  Slow,         ///< it does not answer
  Full,         ///< it has no room
  Denied,       ///< it refuses to write
  Damaged,      ///< it has other bytes than those of the blob
  Missing,      ///< it has lost the blob
};

/// Lasts until it is dropped; but for damage and loss, which stay.
using Trouble = std::shared_ptr<void>;

struct BlobStoreUnderTest {
  std::string name;
  /// The blobs of that folder, as process number `process` reaches them.
  std::function<std::unique_ptr<BlobStore>(const std::filesystem::path& folder, int process)> open;
  /// Those that it can have here.
  std::vector<BlobFault> faults;
  /// Brings one of these about for the blobs of that folder, of which one is named.
  std::function<Trouble(const std::filesystem::path& folder, BlobFault fault, const std::string& sha256)> trouble;
  bool is_shared = false;                                ///< several processes reach them at a time
  std::function<bool()> is_there = [] { return true; };  ///< whether it is installed; says so where it is not
  friend std::ostream& operator<<(std::ostream& out, const BlobStoreUnderTest& store) { return out << store.name; }
};

/// One line for each implementation (blob_stores.cpp).
const std::vector<BlobStoreUnderTest>& all_blob_stores();

}  // namespace driftlab::server
