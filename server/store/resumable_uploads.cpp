#include "server/store/resumable_uploads.hpp"

#include "server/store/files.hpp"
#include "server/store/principal.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>
#include <vector>

namespace driftlab::server {
namespace {

namespace fs = std::filesystem;

constexpr UtcMicros kKeptMicros = 24LL * 3600 * 1'000'000;

tl::unexpected<Error> unknown(std::string_view id) {
  return fail(ErrorCode::NotFound, "There is no upload \"" + std::string(id) + "\"; it may have expired.",
              {{"upload", std::string(id)}});
}

tl::unexpected<Error> elsewhere(std::string sentence, std::uint64_t offset) {
  return fail(ErrorCode::Conflict, std::move(sentence), {{"offset", std::to_string(offset)}});
}

/// Whether this thread's caller is another than who began the upload, and no admin.
bool is_foreign(const ResumableUpload& upload) {
  const Caller* const caller = caller_of_thread();
  return caller != nullptr && !upload.token.empty() && caller->principal.token != upload.token &&
         caller->principal.scope != Scope::Admin;
}

/// Microseconds of the last change of a file; 0 where there is none.
UtcMicros changed_at(const fs::path& path) {
  struct stat status{};
  if (::stat(path.c_str(), &status) != 0) {
    return 0;
  }
  return static_cast<UtcMicros>(status.st_mtim.tv_sec) * 1'000'000 + status.st_mtim.tv_nsec / 1000;
}

}  // namespace

fs::path ResumableUploads::bytes_path(std::string_view id) const { return directory_ / (std::string(id) + ".part"); }

Result<ResumableUpload> ResumableUploads::create(std::uint64_t length, std::string_view file_name) {
  if (Status made = make_directories(directory_); !made) {
    return fail(made.error());
  }
  const UtcMicros now = clock_.now();
  const Caller* const caller = caller_of_thread();
  const std::string token = caller != nullptr ? caller->principal.token : "";
  ResumableUpload upload{make_id("upl", now), length, 0, std::string(file_name), token, now + kKeptMicros};
  // One line of length and name: the name is the client's and may hold anything but a line break.
  const fs::path about = directory_ / (upload.id + ".about");
  for (const fs::path& path : {bytes_path(upload.id), about}) {
    const FileHandle file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
    if (!file) {
      return fail(file_error(errno, "create", path));
    }
  }
  std::ofstream text(about, std::ios::binary | std::ios::trunc);
  text << length << ' ' << upload.file_name << '\n' << upload.token;
  text.close();
  if (!text) {
    return fail(file_error(ENOSPC, "write", about));
  }
  for (const fs::path& path : {about, directory_}) {
    if (Status synced = sync_path(path); !synced) {
      return fail(synced.error());
    }
  }
  return upload;
}

Result<ResumableUpload> ResumableUploads::described(std::string_view id) const {
  const fs::path path = directory_ / (std::string(id) + ".about");
  std::ifstream about(path, std::ios::binary);
  ResumableUpload upload;
  upload.id = id;
  if (!(about >> upload.length)) {
    std::error_code none;  // what is there and cannot be read is not gone: the client may go on with it later
    return fs::exists(path, none) ? tl::unexpected(file_error(EIO, "read", path)) : unknown(id);
  }
  about.get();
  std::getline(about, upload.file_name);
  std::getline(about, upload.token);
  return upload;
}

Result<ResumableUpload> ResumableUploads::find(std::string_view id) {
  if (!is_id(id, "upl")) {
    return unknown(id);
  }
  auto known = described(id);
  if (!known) {
    return known;
  }
  ResumableUpload& upload = *known;
  if (is_foreign(upload)) {
    return unknown(id);
  }
  const fs::path bytes = bytes_path(id);
  std::error_code error;
  upload.offset = fs::file_size(bytes, error);
  upload.expires_at = changed_at(bytes) + kKeptMicros;
  if (error || upload.expires_at < clock_.now()) {
    return unknown(id);
  }
  const std::lock_guard lock(mutex_);
  if (const auto running = writing_.find(id); running != writing_.end()) {
    upload.offset = running->second;
  }
  return known;
}

Status ResumableUploads::remove(std::string_view id) {
  const auto known = find(id);
  if (!known) {
    return fail(known.error());
  }
  {
    const std::lock_guard lock(mutex_);
    if (const auto running = writing_.find(id); running != writing_.end()) {
      return elsewhere("The upload is being written; end that request first.", running->second);
    }
  }
  if (Status removed = remove_file(bytes_path(id)); !removed) {
    return removed;
  }
  return remove_file(directory_ / (std::string(id) + ".about"));
}

void ResumableUploads::forget_expired() {
  std::error_code error;
  std::vector<std::string> ids;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory_, error)) {
    if (entry.path().extension() == ".part" && changed_at(entry.path()) + kKeptMicros < clock_.now()) {
      ids.push_back(entry.path().stem());
    }
  }
  const std::lock_guard lock(mutex_);
  for (const std::string& id : ids) {
    if (is_id(id, "upl") && !writing_.contains(id)) {
      (void)remove_file(bytes_path(id));
      (void)remove_file(directory_ / (id + ".about"));
    }
  }
}

ResumableUploads::Open ResumableUploads::open_of(std::string_view token, std::string_view but) const {
  Open open;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory_, error)) {
    const std::string id = entry.path().stem();
    if (entry.path().extension() != ".about" || id == but || changed_at(bytes_path(id)) + kKeptMicros < clock_.now()) {
      continue;
    }
    const auto upload = described(id);
    if (upload && upload->token == token) {
      ++open.uploads;
      open.bytes += static_cast<std::int64_t>(upload->length);
    }
  }
  return open;
}

Result<std::unique_ptr<ResumableUploads::Piece>> ResumableUploads::append(std::string_view id, std::uint64_t offset) {
  const auto known = find(id);
  if (!known) {
    return fail(known.error());
  }
  const std::lock_guard lock(mutex_);
  if (const auto running = writing_.find(id); running != writing_.end()) {
    return elsewhere("Another request is writing this upload.", running->second);
  }
  std::error_code error;
  const std::uint64_t stands = fs::file_size(bytes_path(id), error);
  if (error) {
    return unknown(id);
  }
  if (stands != offset) {
    return elsewhere("The upload stands at byte " + std::to_string(stands) + ", not " + std::to_string(offset) +
                         "; go on from there.",
                     stands);
  }
  const int descriptor = ::open(bytes_path(id).c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor < 0) {
    return fail(file_error(errno, "open", bytes_path(id)));
  }
  writing_.emplace(id, offset);
  return std::make_unique<Piece>(*this, std::string(id), offset, descriptor);
}

ResumableUploads::Piece::~Piece() {
  const FileHandle file(descriptor_);
  if (!finished_ && whole_) {
    [[maybe_unused]] const int cut = ::ftruncate(file.get(), static_cast<off_t>(start_));
  }
  if (!finished_) {
    (void)::fsync(file.get());
  }
  const std::lock_guard lock(uploads_.mutex_);
  uploads_.writing_.erase(id_);
}

Status ResumableUploads::Piece::append(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written < 0) {
      return fail(file_error(errno, "write", uploads_.bytes_path(id_)));
    }
    written_ += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

Result<std::uint64_t> ResumableUploads::Piece::finish() {
  if (::fsync(descriptor_) != 0) {
    return fail(file_error(errno, "flush", uploads_.bytes_path(id_)));
  }
  finished_ = true;
  return start_ + written_;
}

}  // namespace driftlab::server
