#pragma once
/// The suite that every place of blobs passes: blob_cases.cpp runs over each of `all_blob_stores`.
#include "server/store/blobs.hpp"
#include "tests/unit/store/world.hpp"

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace driftlab::server {

struct BlobStoreUnderTest {
  std::string name;
  /// The blobs of that folder, as process number `process` reaches them.
  std::function<std::unique_ptr<BlobStore>(const std::filesystem::path& folder, int process)> open;
  bool is_shared = false;  ///< several processes reach them at a time
  friend std::ostream& operator<<(std::ostream& out, const BlobStoreUnderTest& store) { return out << store.name; }
};

/// One line for each implementation (blob_stores.cpp).
const std::vector<BlobStoreUnderTest>& all_blob_stores();

}  // namespace driftlab::server
