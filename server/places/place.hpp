#pragma once
/// Places of recordings, one of which --blobs names. A further one is one file and one line of `all_blob_places`.
#include "core/signal/result.hpp"
#include "server/open_store.hpp"
#include "server/settings.hpp"
#include "server/store/blobs.hpp"
#include "server/store/remote_files.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

struct BlobPlace {
  /// As the sentence of a wrong --blobs lists it: `the absolute path of a folder`.
  std::string_view meaning;
  /// Whether that value of --blobs means this place, well written or not.
  std::function<bool(const std::string& value)> is_meant;
  /// Empty where it is well written, else how it has to be: `must name a bucket.` Never repeats what may be a secret.
  std::function<std::string(const std::string& value)> fault;
  /// The folder of this machine that it is, where a database's mark or an SQLite store lies; nothing: it is elsewhere.
  std::function<std::optional<std::filesystem::path>(const Settings& settings)> folder;
  /// Opens it beside a store that was opened by the same settings. Recordings belong to one database: a place that
  /// keeps those of another is refused, for the sweeper would take them for rubbish. Errors: Conflict, Io, DiskFull,
  /// InvalidArgument.
  std::function<Result<std::unique_ptr<BlobStore>>(const Settings& settings, OpenedStore& store)> open;
};

/// Every place, once. The first one that is meant is it.
[[nodiscard]] const std::vector<BlobPlace>& all_blob_places();
/// That of a value; nullptr: none is meant.
[[nodiscard]] const BlobPlace* find_blob_place(const std::string& value);
/// What --blobs may be, as the end of a sentence: `nothing for --data, database, or ...`.
[[nodiscard]] std::string meanings_of_blob_places();

/// Files under a directory that this daemon has alone: --data, where --blobs says nothing.
[[nodiscard]] BlobPlace own_directory();
/// A folder that daemons and workers share.
[[nodiscard]] BlobPlace shared_folder();
/// Parts of 1 MiB in the database.
[[nodiscard]] BlobPlace in_database();
/// Objects of an S3-compatible storage.
[[nodiscard]] BlobPlace in_object_storage();

/// Blobs of a storage that is no folder, with their copies in `copies` under --data.
[[nodiscard]] Result<std::unique_ptr<BlobStore>> open_copied(const Settings& settings,
                                                             std::unique_ptr<RemoteFiles> remote);

/// The word of its database that a place keeps.
struct PlaceMark {
  std::string place;                          ///< in a sentence: `the directory /srv/driftlab`
  std::string stranger;                       ///< whose recordings lie where there is no mark: `an SQLite store`
  std::function<Result<std::string>()> read;  ///< empty: there is none
  std::function<Result<bool>()> is_empty;     ///< holds no recording
  std::function<Status(const std::string& word)> write;
};
/// Ties a place to the database of the store, or neither has a recording yet. Errors: Conflict; those of the mark.
[[nodiscard]] Status bind_place(const PlaceMark& mark, OpenedStore& store);

}  // namespace driftlab::server
