#pragma once
/// Backup, restore and check of a data directory, from outside the daemon and while it runs.
///
/// The database is read through a read-only connection, which can neither write nor checkpoint; the copy is one moment
/// of it. Files of blobs are complete or not there and never change, so they are copied one by one. A backup is
///
///   <target>/driftlab.db      the copy, checked
///   <target>/blobs/...        uploaded bytes, each compared with its name
///   <target>/columns/...      decoded columns with their checksums
///   <target>/manifest.json    {"driftlab", "made_at", "database_sha256", "blobs", "bytes", "faults"}: written last
///
/// and appears under its name complete or not at all: until then it is `<target>.part`. One that was broken off is
/// replaced; what is called so and has anything else in it is somebody's, and stays (Conflict).
#include "core/signal/result.hpp"
#include "server/store/store_report.hpp"

#include <filesystem>
#include <stop_token>
#include <string>

namespace driftlab::server {

/// Reads everything: the database (integrity, foreign keys, the seals of rows), the bytes of each blob against its
/// name, its columns against their checksum, and whether anything is missing. Changes nothing. Errors: NotFound (no
/// data directory), Io.
[[nodiscard]] Result<StoreReport> check_data(const std::filesystem::path& data);

/// Errors: Conflict (the target exists), NotFound, Io, DiskFull; Cancelled, once `stop` asks: nothing stays of it. A
/// blob that is damaged is copied and told in `faults`.
[[nodiscard]] Result<StoreReport> back_up(const std::filesystem::path& data, const std::filesystem::path& target,
                                          const std::string& now, const std::stop_token& stop = {});

/// What the manifest of a backup says; of faults, how many.
[[nodiscard]] StoreReport manifest_of(const std::filesystem::path& backup);

/// Makes `data`, which must not exist or be empty, from a backup, after comparing all of it with its checksums.
/// Errors: Conflict, NotFound, Io (the backup is damaged), DiskFull.
[[nodiscard]] Result<StoreReport> restore(const std::filesystem::path& backup, const std::filesystem::path& data);

}  // namespace driftlab::server
