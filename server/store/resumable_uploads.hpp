#pragma once
/// Uploads that may stop and go on: bytes in a file that only grows, beside what is known of it.
///
///   <directory>/upl_….about  length and file name, one line; the token that began it, another
///   <directory>/upl_….part   the bytes so far; its size is the offset
///
/// The offset advances after the bytes are flushed to disk, so what was acknowledged survives power loss. An upload
/// without a new piece for a day is removed. An upload is visible to the token that began it and to admins; for other
/// tokens it does not exist. Thread safe; one writer at a time for each upload.
#include "core/signal/result.hpp"
#include "server/store/clock.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>

namespace driftlab::server {

struct ResumableUpload {
  std::string id;  ///< `upl_...`
  std::uint64_t length = 0;
  std::uint64_t offset = 0;
  std::string file_name;  ///< as the client calls it; may be empty
  std::string token;      ///< public id of the token that began it; empty where none was asked for
  UtcMicros expires_at = 0;
};

class ResumableUploads {
 public:
  /// `directory` is made when the first upload is. `clock`: that which dates its files; it must outlive this object.
  ResumableUploads(std::filesystem::path directory, const Clock& clock)
      : directory_(std::move(directory)), clock_(clock) {}

  /// Errors: Io, DiskFull.
  [[nodiscard]] Result<ResumableUpload> create(std::uint64_t length, std::string_view file_name);
  /// Errors: NotFound; Io.
  [[nodiscard]] Result<ResumableUpload> find(std::string_view id);
  [[nodiscard]] Status remove(std::string_view id);
  [[nodiscard]] std::filesystem::path bytes_path(std::string_view id) const;
  /// Removes uploads without a new piece for a day.
  void forget_expired();
  struct Open {
    std::int64_t uploads = 0;
    std::int64_t bytes = 0;  ///< that they were said to have
  };
  /// What this token began and neither recorded nor removed, without the upload `but`. An upload that was forgotten
  /// counts no more.
  [[nodiscard]] Open open_of(std::string_view token, std::string_view but = "") const;

  /// Bytes at the end of one upload. Destroyed without `finish`: what came is kept, or, of a piece whose checksum is
  /// still to come, taken back.
  class Piece {
   public:
    Piece(ResumableUploads& uploads, std::string id, std::uint64_t start, int descriptor)
        : uploads_(uploads), id_(std::move(id)), start_(start), descriptor_(descriptor) {}
    Piece(const Piece&) = delete;
    Piece& operator=(const Piece&) = delete;
    ~Piece();
    /// Keep all of it or nothing.
    void whole() { whole_ = true; }
    [[nodiscard]] Status append(std::span<const std::byte> bytes);
    /// Flushes. The new offset.
    [[nodiscard]] Result<std::uint64_t> finish();

   private:
    ResumableUploads& uploads_;
    std::string id_;
    std::uint64_t start_;
    std::uint64_t written_ = 0;
    int descriptor_;
    bool whole_ = false;
    bool finished_ = false;
  };
  /// Errors: NotFound; Conflict (field "offset") where the upload stands elsewhere or is being written; Io.
  [[nodiscard]] Result<std::unique_ptr<Piece>> append(std::string_view id, std::uint64_t offset);

 private:
  /// What its description says; offset and expiry are not part of it. Errors: NotFound; Io.
  [[nodiscard]] Result<ResumableUpload> described(std::string_view id) const;

  std::filesystem::path directory_;
  const Clock& clock_;
  std::mutex mutex_;
  std::map<std::string, std::uint64_t, std::less<>> writing_;  ///< the offset at which the running piece began
};

}  // namespace driftlab::server
