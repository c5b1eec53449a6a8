#pragma once
/// Recordings that are still being made: samples arrive in numbered pieces, each on the disk before it is acknowledged.
///
///   <directory>/live_….about    columns and hash of the secret, then what the recording is in one line of JSON, then
///                               the token that began it
///   <directory>/live_….samples  the pieces as they came, appended: number, rows, then rows of time and values
///
/// A piece that comes again changes nothing; one that comes late is put in its place when the samples are read. A piece
/// that was cut off by a crash is dropped. Thread safe.
#include "core/signal/result.hpp"
#include "server/store/clock.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

/// Time stamps and one list of values for each column, in the order of time.
struct LiveSamples {
  std::vector<double> time_s;
  std::vector<std::vector<double>> columns;
};

struct LiveRecording {
  std::string id;            ///< `live_...`
  std::string about_json;    ///< as given to `create`
  std::string token_sha256;  ///< of the secret that whoever records must show
  std::string owner;         ///< public id of the token that began it; empty where none was asked for
  std::size_t columns = 0;
  std::size_t samples = 0;
  std::size_t pieces = 0;
  UtcMicros touched_at = 0;  ///< when the last piece came
};

class LiveRecordings {
 public:
  /// Recordings of an earlier run of the daemon are there again. The clock must outlive this object.
  LiveRecordings(std::filesystem::path directory, const Clock& clock);

  /// Errors: Io, DiskFull.
  [[nodiscard]] Result<LiveRecording> create(std::string_view about_json, std::string_view token_sha256,
                                             std::size_t columns, std::string_view owner);
  /// Errors: NotFound.
  [[nodiscard]] Result<LiveRecording> find(std::string_view id) const;
  /// Ids whose last piece came before `before`.
  [[nodiscard]] std::vector<std::string> untouched_since(UtcMicros before) const;
  /// Of these, those that are not put off.
  [[nodiscard]] std::vector<std::string> due_since(UtcMicros before) const;
  /// What was to be done with it failed: it is not due for a minute, then for two, twice as long each time, up to six
  /// hours. Forgotten when the daemon ends.
  void put_off(std::string_view id);
  struct Open {
    std::int64_t all = 0;
    std::int64_t of_owner = 0;
  };
  [[nodiscard]] Open open_of(std::string_view owner) const;

  /// Rows of one time [s] and `columns` values each, little-endian: a float64 and float32s. False where the piece is
  /// there already. Errors: NotFound; InvalidArgument (the bytes are no whole rows, a time is not finite or does not
  /// rise within the piece); LimitExceeded (10^8 values); Io, DiskFull.
  [[nodiscard]] Result<bool> add(std::string_view id, std::uint32_t number, std::span<const std::byte> rows);
  /// Errors: NotFound, Io.
  [[nodiscard]] Result<LiveSamples> samples(std::string_view id) const;
  [[nodiscard]] Status remove(std::string_view id);

 private:
  struct Kept {
    LiveRecording recording;
    std::set<std::uint32_t> numbers;
    int failures = 0;
    UtcMicros put_off_to = 0;
  };
  void load(const std::filesystem::path& about);
  [[nodiscard]] std::filesystem::path path_of(std::string_view id, std::string_view suffix) const;

  std::filesystem::path directory_;
  const Clock& clock_;
  mutable std::mutex mutex_;
  std::map<std::string, Kept, std::less<>> kept_;
};

}  // namespace driftlab::server
