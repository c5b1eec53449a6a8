#pragma once
/// Moves a lab between an SQLite store and a PostgreSQL database: rows and recordings, in either direction.
///
/// Most of it goes ahead, while the daemons of the source work: everything that is there, and in later runs what has
/// changed since. The move itself then has the rest. Both stores are locked meanwhile, so that no daemon works with
/// them. The same command continues a run that was interrupted; a file `moving` in the directory of the SQLite store
/// says that it is under way, and no daemon starts there before it has ended, nor with a target that is filled in part.
/// Everything is compared: rows value by value and by their number, recordings by their checksums. The source stays as
/// it is.
#include "core/signal/result.hpp"
#include "server/move_rows.hpp"
#include "server/settings.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace driftlab::server {

struct MovedStore {
  MovedRows rows;
  std::int64_t blobs = 0;
  std::int64_t new_blobs = 0;
  std::string rows_left;  ///< ahead: why the rows are left for the move itself; empty where they went too
};

/// One of `from` and `to` is a directory, the other postgresql://...; where the recordings of the latter are kept say
/// --blobs and --data of `settings`. Errors: InvalidArgument (not one of each); Conflict (in use; a target with other
/// rows; what was copied is not the same); those of the stores.
[[nodiscard]] Result<MovedStore> move_store(const Settings& settings, const std::string& from, const std::string& to);

/// Brings the target to what the source holds while daemons and workers go on with the source: the move itself is
/// sooner over then. May be run again at any time before that. What is damaged at the source is passed over, and rows
/// whose tables are another release's. Errors: as move_store; NotFound (no store in the directory).
[[nodiscard]] Result<MovedStore> move_ahead(const Settings& settings, const std::string& from, const std::string& to);

/// Whether the directory holds a part of a store that is being moved there from a database.
[[nodiscard]] bool is_filled_ahead(const std::filesystem::path& data);

/// The file that says that a store is being moved.
constexpr const char* kMovingFile = "moving";

}  // namespace driftlab::server
