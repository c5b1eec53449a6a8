#pragma once
/// Opens the store of a test on the server of this process.
#include "server/store/postgres/postgres_store.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace driftlab::server {

/// A schema's name for a temporary folder: the same for the same folder.
[[nodiscard]] std::string schema_for(const std::filesystem::path& directory);

/// The store in the schema of that folder.
[[nodiscard]] std::unique_ptr<Store> open_postgres_under_test(const std::filesystem::path& directory,
                                                              const Clock& clock);

}  // namespace driftlab::server
