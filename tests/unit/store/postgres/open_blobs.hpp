#pragma once
/// Blobs in the database of a test on the server of this process.
#include "server/store/blobs.hpp"
#include "tests/unit/store/blob_suite.hpp"

#include <filesystem>
#include <memory>

namespace driftlab::server {

/// In the schema of that folder, with the local copies of process number `process`; they may take 10 000 bytes.
[[nodiscard]] std::unique_ptr<BlobStore> open_database_blobs_under_test(const std::filesystem::path& folder,
                                                                        int process);

[[nodiscard]] Trouble database_in_trouble(const std::filesystem::path& folder, BlobFault fault,
                                          const std::string& sha256);

}  // namespace driftlab::server
