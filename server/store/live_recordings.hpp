#pragma once
/// Recordings that are still being made: samples arrive in numbered pieces, each on the disk before it is acknowledged.
///
///   <directory>/live_….about    columns and hash of the secret, then what the recording is in one line of JSON
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
                                             std::size_t columns);
  /// Errors: NotFound.
  [[nodiscard]] Result<LiveRecording> find(std::string_view id) const;
  /// Ids whose last piece came before `before`.
  [[nodiscard]] std::vector<std::string> untouched_since(UtcMicros before) const;

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
  };
  void load(const std::filesystem::path& about);
  [[nodiscard]] std::filesystem::path path_of(std::string_view id, std::string_view suffix) const;

  std::filesystem::path directory_;
  const Clock& clock_;
  mutable std::mutex mutex_;
  std::map<std::string, Kept, std::less<>> kept_;
};

}  // namespace driftlab::server
