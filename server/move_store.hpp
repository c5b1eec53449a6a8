#pragma once
/// Moves a lab between an SQLite store and a PostgreSQL database: rows and recordings, in either direction.
///
/// Both stores are locked meanwhile, so that no daemon works with them. The same command continues a run that was
/// interrupted; a file `moving` in the directory of the SQLite store says that it is under way, and no daemon starts
/// there before it has ended. At the end everything is compared: rows by number and SHA-256, recordings by their
/// checksums. The source stays as it is.
#include "core/signal/result.hpp"
#include "server/settings.hpp"

#include <cstdint>
#include <string>

namespace driftlab::server {

struct MovedStore {
  int tables = 0;
  std::int64_t rows = 0;
  std::int64_t new_rows = 0;  ///< copied in this run
  std::int64_t blobs = 0;
  std::int64_t new_blobs = 0;
};

/// One of `from` and `to` is a directory, the other postgresql://...; where the recordings of the latter are kept say
/// --blobs and --data of `settings`. Errors: InvalidArgument (not one of each); Conflict (in use; a target with other
/// rows; what was copied is not the same); those of the stores.
[[nodiscard]] Result<MovedStore> move_store(const Settings& settings, const std::string& from, const std::string& to);

/// Copies the recordings alone, while daemons and workers go on with the source: the move itself then takes what came
/// after, and is sooner over. May be run again at any time before that. What is damaged at the source is passed over.
/// Errors: as move_store; NotFound (no store in the directory).
[[nodiscard]] Result<MovedStore> move_recordings_ahead(const Settings& settings, const std::string& from,
                                                       const std::string& to);

/// The file that says that a store is being moved.
constexpr const char* kMovingFile = "moving";

}  // namespace driftlab::server
