#include "server/store/live_recordings.hpp"

#include "server/store/files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <numeric>
#include <system_error>

namespace driftlab::server {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "pieces are kept as they come");

constexpr std::size_t kMostValues = 100'000'000;
constexpr UtcMicros kFirstPause = 60'000'000;
constexpr UtcMicros kLongestPause = 6LL * 3600 * 1'000'000;

struct PieceHead {
  std::uint32_t number = 0;
  std::uint32_t rows = 0;
};

std::size_t row_bytes(std::size_t columns) { return sizeof(double) + columns * sizeof(float); }

tl::unexpected<Error> unknown_live(std::string_view id) {
  return fail(ErrorCode::NotFound, "There is no live recording \"" + std::string(id) + "\"; it may have been finished.",
              {{"live_recording", std::string(id)}});
}

double time_in(std::span<const std::byte> row) {
  double time = 0.0;
  std::memcpy(&time, row.data(), sizeof time);
  return time;
}

Status check_rows(std::span<const std::byte> rows, std::size_t columns) {
  const std::size_t length = row_bytes(columns);
  if (rows.empty() || rows.size() % length != 0) {
    return fail(ErrorCode::InvalidArgument, "A piece is whole rows of " + std::to_string(length) +
                                                " bytes: a float64 time in seconds and " + std::to_string(columns) +
                                                " float32 values.");
  }
  double before = -std::numeric_limits<double>::infinity();
  for (std::size_t at = 0; at < rows.size(); at += length) {
    const double time = time_in(rows.subspan(at));
    if (!std::isfinite(time) || time <= before) {
      return fail(ErrorCode::InvalidArgument, "The times of a piece are finite and rise.",
                  {{"row", std::to_string(at / length)}});
    }
    before = time;
  }
  return {};
}

/// The file of the pieces, piece by piece: `take(head, rows)` for each that is whole. Where the last whole one ends.
template <class Take>
std::uint64_t each_piece(const fs::path& path, std::size_t columns, const Take& take) {
  std::ifstream file(path, std::ios::binary);
  std::uint64_t end = 0;
  PieceHead head;
  std::vector<std::byte> rows;
  while (file.read(reinterpret_cast<char*>(&head), sizeof head)) {
    rows.resize(head.rows * row_bytes(columns));
    if (!file.read(reinterpret_cast<char*>(rows.data()), static_cast<std::streamsize>(rows.size()))) {
      break;
    }
    take(head, std::span<const std::byte>(rows));
    end += sizeof head + rows.size();
  }
  return end;
}

Status write_whole(const fs::path& path, int flags, std::span<const std::byte> bytes) {
  const FileHandle file(::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | flags, 0600));
  if (!file) {
    return fail(file_error(errno, "open", path));
  }
  const off_t before = ::lseek(file.get(), 0, SEEK_END);
  std::span<const std::byte> rest = bytes;
  while (!rest.empty()) {
    const ssize_t written = ::write(file.get(), rest.data(), rest.size());
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written < 0) {
      const Error error = file_error(errno, "write", path);
      [[maybe_unused]] const int cut = ::ftruncate(file.get(), before);
      return fail(error);
    }
    rest = rest.subspan(static_cast<std::size_t>(written));
  }
  return ::fdatasync(file.get()) == 0 ? Status() : Status(fail(file_error(errno, "flush", path)));
}

}  // namespace

LiveRecordings::LiveRecordings(fs::path directory, const Clock& clock)
    : directory_(std::move(directory)), clock_(clock) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory_, error)) {
    if (entry.path().extension() == ".about") {
      load(entry.path());
    }
  }
}

void LiveRecordings::load(const fs::path& about) {
  std::ifstream text(about, std::ios::binary);
  Kept kept;
  kept.recording.id = about.stem();
  if (!is_id(kept.recording.id, "live") || !(text >> kept.recording.columns >> kept.recording.token_sha256)) {
    return;
  }
  text.get();
  std::getline(text, kept.recording.about_json);
  std::getline(text, kept.recording.owner);
  const fs::path samples = path_of(kept.recording.id, ".samples");
  const std::uint64_t end =
      each_piece(samples, kept.recording.columns, [&](const PieceHead& head, std::span<const std::byte>) {
        kept.numbers.insert(head.number);
        kept.recording.samples += head.rows;
        ++kept.recording.pieces;
      });
  std::error_code error;
  fs::resize_file(samples, end, error);
  kept.recording.touched_at = clock_.now();
  kept_.emplace(kept.recording.id, std::move(kept));
}

fs::path LiveRecordings::path_of(std::string_view id, std::string_view suffix) const {
  return directory_ / (std::string(id) + std::string(suffix));
}

Result<LiveRecording> LiveRecordings::create(std::string_view about_json, std::string_view token_sha256,
                                             std::size_t columns, std::string_view owner) {
  if (Status made = make_directories(directory_); !made) {
    return fail(made.error());
  }
  const UtcMicros now = clock_.now();
  LiveRecording recording{
      make_id("live", now), std::string(about_json), std::string(token_sha256), std::string(owner), columns, 0, 0, now};
  const std::string text = std::to_string(columns) + ' ' + recording.token_sha256 + '\n' + recording.about_json + '\n' +
                           recording.owner + '\n';
  if (Status written = write_whole(path_of(recording.id, ".about"), O_EXCL, std::as_bytes(std::span(text))); !written) {
    return fail(written.error());
  }
  if (Status synced = sync_path(directory_); !synced) {
    return fail(synced.error());
  }
  const std::lock_guard lock(mutex_);
  kept_.emplace(recording.id, Kept{recording, {}, 0, 0});
  return recording;
}

Result<LiveRecording> LiveRecordings::find(std::string_view id) const {
  const std::lock_guard lock(mutex_);
  const auto found = kept_.find(id);
  return found == kept_.end() ? Result<LiveRecording>(unknown_live(id)) : found->second.recording;
}

std::vector<std::string> LiveRecordings::untouched_since(UtcMicros before) const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> ids;
  for (const auto& [id, kept] : kept_) {
    if (kept.recording.touched_at < before) {
      ids.push_back(id);
    }
  }
  return ids;
}

std::vector<std::string> LiveRecordings::due_since(UtcMicros before) const {
  std::vector<std::string> ids = untouched_since(before);
  const std::lock_guard lock(mutex_);
  std::erase_if(ids, [&](const std::string& id) {
    const auto found = kept_.find(id);
    return found == kept_.end() || found->second.put_off_to > clock_.now();
  });
  return ids;
}

void LiveRecordings::put_off(std::string_view id) {
  const std::lock_guard lock(mutex_);
  if (const auto found = kept_.find(id); found != kept_.end()) {
    UtcMicros pause = kFirstPause;
    for (int failure = 0; failure < found->second.failures && pause < kLongestPause; ++failure) {
      pause *= 2;
    }
    ++found->second.failures;
    found->second.put_off_to = clock_.now() + std::min(pause, kLongestPause);
  }
}

LiveRecordings::Open LiveRecordings::open_of(std::string_view owner) const {
  const std::lock_guard lock(mutex_);
  Open open;
  for (const auto& [id, kept] : kept_) {
    ++open.all;
    open.of_owner += kept.recording.owner == owner ? 1 : 0;
  }
  return open;
}

Result<bool> LiveRecordings::add(std::string_view id, std::uint32_t number, std::span<const std::byte> rows) {
  const std::lock_guard lock(mutex_);
  const auto found = kept_.find(id);
  if (found == kept_.end()) {
    return unknown_live(id);
  }
  LiveRecording& recording = found->second.recording;
  if (Status sound = check_rows(rows, recording.columns); !sound) {
    return fail(sound.error());
  }
  recording.touched_at = clock_.now();
  if (found->second.numbers.contains(number)) {
    return false;
  }
  const std::size_t count = rows.size() / row_bytes(recording.columns);
  if ((recording.samples + count) * recording.columns > kMostValues) {
    return fail(ErrorCode::LimitExceeded, "A live recording holds 100 million values at most; finish it.");
  }
  const PieceHead head{number, static_cast<std::uint32_t>(count)};
  std::vector<std::byte> bytes(sizeof head + rows.size());
  std::memcpy(bytes.data(), &head, sizeof head);
  std::memcpy(bytes.data() + sizeof head, rows.data(), rows.size());
  if (Status written = write_whole(path_of(id, ".samples"), O_APPEND, bytes); !written) {
    return fail(written.error());
  }
  found->second.numbers.insert(number);
  recording.samples += count;
  ++recording.pieces;
  return true;
}

Result<LiveSamples> LiveRecordings::samples(std::string_view id) const {
  const auto recording = find(id);
  if (!recording) {
    return fail(recording.error());
  }
  LiveSamples raw;
  raw.columns.resize(recording->columns);
  each_piece(path_of(id, ".samples"), recording->columns, [&](const PieceHead&, std::span<const std::byte> rows) {
    const std::size_t length = row_bytes(recording->columns);
    for (std::size_t at = 0; at < rows.size(); at += length) {
      raw.time_s.push_back(time_in(rows.subspan(at)));
      for (std::size_t c = 0; c < recording->columns; ++c) {
        float value = 0.0F;
        std::memcpy(&value, rows.data() + at + sizeof(double) + c * sizeof(float), sizeof value);
        raw.columns[c].push_back(static_cast<double>(value));
      }
    }
  });
  std::vector<std::size_t> order(raw.time_s.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return raw.time_s[a] != raw.time_s[b] ? raw.time_s[a] < raw.time_s[b] : a < b;
  });
  LiveSamples sorted;
  sorted.columns.resize(recording->columns);
  for (const std::size_t row : order) {
    if (!sorted.time_s.empty() && raw.time_s[row] <= sorted.time_s.back()) {
      continue;  // the same instant again
    }
    sorted.time_s.push_back(raw.time_s[row]);
    for (std::size_t c = 0; c < recording->columns; ++c) {
      sorted.columns[c].push_back(raw.columns[c][row]);
    }
  }
  return sorted;
}

Status LiveRecordings::remove(std::string_view id) {
  const std::lock_guard lock(mutex_);
  if (kept_.erase(std::string(id)) == 0) {
    return unknown_live(id);
  }
  if (Status removed = remove_file(path_of(id, ".about")); !removed) {
    return removed;
  }
  return remove_file(path_of(id, ".samples"));
}

}  // namespace driftlab::server
