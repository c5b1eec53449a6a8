#pragma once
/// Reads back all stored files and rows in a slow, endless loop, so that damage is found before what is damaged is
/// needed. Damaged columns are healed; damage that cannot be healed is logged once, counted and shown by /readyz. An
/// exception while one file is read leaves the others to be read (server/store/guarded_round.hpp).
#include "core/read/byte_source.hpp"
#include "server/api/stored_blob.hpp"
#include "server/store/bad_states.hpp"
#include "server/store/sql/sql_store.hpp"

#include <cstdint>
#include <functional>
#include <mutex>
#include <set>
#include <stop_token>
#include <string>
#include <thread>

namespace driftlab::server {

class Scrubber {
 public:
  /// References must outlive this object. `bytes_per_second` 0: nothing is read in the background. Damaged files are
  /// bad states.
  /// `is_mine`: whether this process reads, of several on the same files; empty: it is the only one.
  Scrubber(SqlStore& store, BlobStore& blobs, BadStates& states, DecodeLimits limits, std::int64_t bytes_per_second,
           std::function<bool()> is_mine = {})
      : store_(store),
        blobs_(blobs),
        states_(states),
        limits_(limits),
        bytes_per_second_(bytes_per_second),
        is_mine_(std::move(is_mine)) {}
  Scrubber(const Scrubber&) = delete;
  Scrubber& operator=(const Scrubber&) = delete;
  ~Scrubber() = default;

  void start();
  void stop();

  /// For jobs (server/jobs/job_kind.hpp): the columns before they are used. Error: Io, naming the blob.
  [[nodiscard]] Status verify_columns(const std::string& sha256);

  /// The same for what is only looked at and must come at once: columns of more than 64 MiB are refused where damage
  /// was found by a job or in the background, and count as sound before.
  [[nodiscard]] Status expect_sound_columns(const std::string& sha256);

  /// A row that somebody found damaged, as `table/key`. Its state ends some seconds after the row is sound, or gone,
  /// whoever reads in the background.
  void note_damaged_row(const std::string& row);

  struct Findings {
    std::uint64_t bytes_read = 0;
    std::uint64_t healed = 0;
    std::uint64_t passes = 0;  ///< over everything that is stored
    std::size_t damaged = 0;   ///< blobs that are damaged now
  };
  [[nodiscard]] Findings findings() const;

 private:
  void run(const std::stop_token& stop);
  /// Reads everything that is stored, once, where this process does that. False: another one does.
  [[nodiscard]] bool read_all(const std::stop_token& stop, const ReadingPace& pace);
  void read_rows(const std::stop_token& stop, const ReadingPace& pace);
  void end(const std::string& row);
  /// Reads the rows that are known to be damaged again.
  void look_again(const std::stop_token& stop);
  void read_back(const std::string& sha256, const std::stop_token& stop, const ReadingPace& pace);
  void note(const std::string& sha256, BlobState state);

  SqlStore& store_;
  BlobStore& blobs_;
  BadStates& states_;
  const DecodeLimits limits_;
  const std::int64_t bytes_per_second_;
  const std::function<bool()> is_mine_;
  mutable std::mutex mutex_;
  Findings findings_;
  std::set<std::string> damaged_;
  std::set<std::string> damaged_rows_;
  std::jthread thread_;
  std::jthread looking_;
};

}  // namespace driftlab::server
