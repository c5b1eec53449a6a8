#pragma once
/// An SQLite store that another process may have open, for reading alone: without its lock and without a writer.
#include "core/signal/result.hpp"
#include "server/store/sql/database.hpp"

#include <filesystem>
#include <memory>

namespace driftlab::server {

/// The database at `file`, whose writes fail (Conflict). Errors: Io.
[[nodiscard]] Result<std::unique_ptr<Database>> open_sqlite_reading(const std::filesystem::path& file);

}  // namespace driftlab::server
