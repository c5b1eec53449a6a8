#include "server/store/blobs.hpp"

#include "server/store/checksums.hpp"
#include "server/store/crash_point.hpp"
#include "server/store/digest.hpp"
#include "server/store/files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <system_error>

namespace driftlab::server {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kColumnsSuffix = ".columns";

class BlobDirectory;

class IncomingFile final : public IncomingBlob {
 public:
  IncomingFile(BlobDirectory& directory, FileHandle file, fs::path path)
      : directory_(directory), file_(std::move(file)), path_(std::move(path)) {}
  IncomingFile(const IncomingFile&) = delete;
  IncomingFile& operator=(const IncomingFile&) = delete;
  ~IncomingFile() override {
    (void)remove_file(path_);
    for (const fs::path& columns : {columns_path(), pyramid_path(columns_path())}) {
      (void)remove_file(columns);
      (void)remove_file(columns_checksum_path(columns));
    }
  }

  [[nodiscard]] Status append(std::span<const std::byte> bytes) override;
  [[nodiscard]] Status seal() override;
  [[nodiscard]] const std::string& sha256() const override { return sha256_; }
  [[nodiscard]] std::size_t size() const override { return size_; }
  [[nodiscard]] const fs::path& path() const override { return path_; }
  [[nodiscard]] fs::path columns_path() const override {
    fs::path columns = path_;
    columns += kColumnsSuffix;
    return columns;
  }
  [[nodiscard]] Status keep() override;

 private:
  BlobDirectory& directory_;
  FileHandle file_;
  fs::path path_;
  Sha256 digest_;
  std::string sha256_;
  std::size_t size_ = 0;
};

class BlobDirectory final : public BlobStore {
 public:
  /// `incoming`: where this process writes. `names`: a file whose lock processes that share the root take.
  BlobDirectory(fs::path root, fs::path incoming, fs::path names, std::vector<FileHandle> locks)
      : root_(std::move(root)), incoming_(std::move(incoming)), shared_(std::move(names)), locks_(std::move(locks)) {}

  [[nodiscard]] Result<std::unique_ptr<IncomingBlob>> begin() override;
  [[nodiscard]] fs::path bytes_path(std::string_view sha256) const override { return bytes_below(root_, sha256); }
  [[nodiscard]] fs::path columns_path(std::string_view sha256) const override { return columns_below(root_, sha256); }
  [[nodiscard]] Status remove(std::string_view sha256) override;
  [[nodiscard]] Result<bool> remove_if_older(std::string_view sha256, std::chrono::microseconds age) override;
  [[nodiscard]] Result<std::vector<std::string>> hashes_older_than(std::chrono::microseconds age) override;
  [[nodiscard]] Result<Space> space() const override;

  /// Gives the files of an upload their final names. Excludes the sweeper.
  [[nodiscard]] Status place(const IncomingFile& incoming);

 private:
  [[nodiscard]] Status remove_both(std::string_view sha256);
  /// What the file system would date a file now that long ago.
  [[nodiscard]] UtcMicros dated_before(std::chrono::microseconds age) const;

  /// Held while final names appear or disappear.
  struct NamesGuard {
    std::unique_lock<std::mutex> here;
    FileHandle everywhere;
  };
  [[nodiscard]] Result<NamesGuard> guard_names();

  fs::path root_;
  fs::path incoming_;
  fs::path shared_;  ///< empty: the directory is this process's alone
  std::vector<FileHandle> locks_;
  std::mutex names_;
  std::atomic<std::uint64_t> counter_{0};
};

Status write_all(int descriptor, std::span<const std::byte> bytes, const fs::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) {
        continue;
      }
      return fail(file_error(errno, "write", path));
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

Status IncomingFile::append(std::span<const std::byte> bytes) {
  if (Status written = write_all(file_.get(), bytes, path_); !written) {
    return written;
  }
  digest_.update(bytes);
  size_ += bytes.size();
  crash_point("upload.streaming");
  return {};
}

Status IncomingFile::seal() {
  if (::fsync(file_.get()) != 0) {
    return fail(file_error(errno, "flush", path_));
  }
  file_ = FileHandle();
  sha256_ = digest_.finish();
  crash_point("upload.sealed");
  return {};
}

Status IncomingFile::keep() {
  if (sha256_.empty()) {
    return fail(ErrorCode::Internal, "An upload was kept before it was sealed.");
  }
  return directory_.place(*this);
}

/// Modification time in microseconds; nothing where the file is absent.
std::optional<UtcMicros> modified_at(const fs::path& path) {
  struct ::stat found{};
  if (::stat(path.c_str(), &found) != 0) {
    return std::nullopt;
  }
  return UtcMicros{found.st_mtim.tv_sec} * 1'000'000 + found.st_mtim.tv_nsec / 1000;
}

/// Moves `from` to `to`, in place of an equal file that may be there (readers that mapped it keep theirs; a damaged one
/// is healed). Without `from`: marks `to` as new.
Status move_or_refresh(const fs::path& from, const fs::path& to) {
  if (::access(from.c_str(), F_OK) != 0) {
    return ::utimensat(AT_FDCWD, to.c_str(), nullptr, 0) == 0 ? Status{} : fail(file_error(errno, "mark as new", to));
  }
  if (Status made = make_directories(to.parent_path()); !made) {
    return made;
  }
  return rename_durably(from, to);
}

/// Moves the pyramid that was written beside incoming columns, if there is one, with its checksum.
Status move_pyramid(const fs::path& from, const fs::path& to) {
  if (::access(from.c_str(), F_OK) != 0) {
    return {};
  }
  if (Status summed = write_columns_checksum(from); !summed) {
    return summed;
  }
  if (Status moved = rename_durably(from, to); !moved) {
    return moved;
  }
  return rename_durably(columns_checksum_path(from), columns_checksum_path(to));
}

/// Waits for the lock of a file that is there or made.
Result<FileHandle> wait_for_lock(const fs::path& path, int kind) {
  FileHandle file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  if (!file) {
    return fail(file_error(errno, "open the lock file", path));
  }
  while (::flock(file.get(), kind) != 0) {
    if (errno != EINTR) {
      return fail(file_error(errno, "lock", path));
    }
  }
  return file;
}

Result<BlobDirectory::NamesGuard> BlobDirectory::guard_names() {
  NamesGuard guard{std::unique_lock<std::mutex>(names_), FileHandle()};
  if (shared_.empty()) {
    return guard;
  }
  auto locked = wait_for_lock(shared_, LOCK_EX);
  if (!locked) {
    return fail(locked.error());
  }
  guard.everywhere = std::move(*locked);
  return guard;
}

Status BlobDirectory::place(const IncomingFile& incoming) {
  const fs::path from = incoming.columns_path();
  const fs::path columns = columns_path(incoming.sha256());
  const bool decoded = ::access(from.c_str(), F_OK) == 0;
  if (decoded) {
    if (Status flushed = sync_path(from); !flushed) {
      return flushed;
    }
    if (Status summed = write_columns_checksum(from); !summed) {
      return summed;
    }
  }
  const auto guard = guard_names();
  if (!guard) {
    return fail(guard.error());
  }
  if (!decoded && ::access(columns.c_str(), F_OK) != 0) {
    return fail(ErrorCode::Internal, "An upload was kept before its columns were written.");
  }
  if (Status moved = move_or_refresh(incoming.path(), bytes_path(incoming.sha256())); !moved) {
    return moved;
  }
  crash_point("upload.kept_bytes");
  if (Status moved = move_or_refresh(from, columns); !moved) {
    return moved;
  }
  // Columns whose checksum is missing, or that of columns that were damaged, are made anew before their next use.
  if (Status moved = decoded ? rename_durably(columns_checksum_path(from), columns_checksum_path(columns)) : Status{};
      !moved) {
    return moved;
  }
  crash_point("upload.kept");
  return decoded ? move_pyramid(pyramid_path(from), pyramid_path(columns)) : Status{};
}

Result<std::unique_ptr<IncomingBlob>> BlobDirectory::begin() {
  fs::path path = incoming_ / std::to_string(counter_.fetch_add(1));
  FileHandle file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (!file) {
    return fail(file_error(errno, "make", path));
  }
  return std::make_unique<IncomingFile>(*this, std::move(file), std::move(path));
}

Status BlobDirectory::remove_both(std::string_view sha256) {
  if (!is_sha256_hex(sha256)) {
    return fail(ErrorCode::InvalidArgument, "A blob is named by 64 hexadecimal digits.", {{"parameter", "sha256"}});
  }
  const fs::path columns = columns_path(sha256);
  const fs::path pyramid = pyramid_path(columns);
  for (const fs::path& path : {columns_checksum_path(pyramid), pyramid, columns_checksum_path(columns), columns}) {
    if (Status removed = remove_file(path); !removed) {
      return removed;
    }
  }
  return remove_file(bytes_path(sha256));
}

Status BlobDirectory::remove(std::string_view sha256) {
  const auto guard = guard_names();
  if (!guard) {
    return fail(guard.error());
  }
  return remove_both(sha256);
}

UtcMicros BlobDirectory::dated_before(std::chrono::microseconds age) const {
  (void)::utimensat(AT_FDCWD, incoming_.c_str(), nullptr, 0);
  return modified_at(incoming_).value_or(SystemClock().now()) - age.count();
}

Result<bool> BlobDirectory::remove_if_older(std::string_view sha256, std::chrono::microseconds age) {
  const auto guard = guard_names();
  if (!guard) {
    return fail(guard.error());
  }
  const UtcMicros before = dated_before(age);
  for (const fs::path& path : {bytes_path(sha256), columns_path(sha256)}) {
    if (modified_at(path).value_or(before - 1) >= before) {
      return false;
    }
  }
  return remove_both(sha256).map([] { return true; });
}

Result<std::vector<std::string>> BlobDirectory::hashes_older_than(std::chrono::microseconds age) {
  const UtcMicros before = dated_before(age);
  std::set<std::string> hashes;
  for (const char* folder : {"blobs", "columns"}) {
    std::error_code error;
    fs::recursive_directory_iterator entry(root_ / folder, error);
    for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
      std::string name = entry->path().filename().string();
      if (name.ends_with(kColumnsSuffix)) {
        name.resize(name.size() - kColumnsSuffix.size());
      }
      const std::optional<UtcMicros> modified = modified_at(entry->path());
      if (is_sha256_hex(name) && modified && *modified < before) {
        hashes.insert(std::move(name));
      }
    }
    if (error) {
      return fail(file_error(error.value(), "list", root_ / folder));
    }
  }
  return std::vector<std::string>(hashes.begin(), hashes.end());
}

Result<BlobStore::Space> BlobDirectory::space() const {
  struct ::statvfs found{};
  if (::statvfs(root_.c_str(), &found) != 0) {
    return fail(file_error(errno, "examine the file system of", root_));
  }
  const double total = static_cast<double>(found.f_blocks);
  return Space{static_cast<std::uintmax_t>(found.f_bavail) * found.f_frsize,
               total > 0.0 ? static_cast<double>(found.f_bavail) / total : 0.0};
}

/// Folders of processes that are gone, whose locks (NAME.lock) nobody holds.
Status clear_abandoned(const fs::path& incoming) {
  std::error_code error;
  for (fs::directory_iterator entry(incoming, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    const fs::path lock = entry->path();
    if (lock.extension() != ".lock" || !wait_for_lock(lock, LOCK_EX | LOCK_NB)) {
      continue;
    }
    fs::remove_all(incoming / lock.stem(), error);
    if (Status removed = remove_file(lock); !removed) {
      return removed;
    }
  }
  return error ? Status(fail(file_error(error.value(), "clear", incoming))) : Status{};
}

struct OwnIncoming {
  fs::path folder;
  FileHandle lock;
};

/// A folder of this process's own, locked before it is there.
Result<OwnIncoming> own_incoming(const fs::path& incoming) {
  std::random_device device;
  const std::string name = std::to_string(::getpid()) + "-" + std::to_string(device()) + std::to_string(device());
  auto lock = wait_for_lock(incoming / (name + ".lock"), LOCK_EX);
  if (!lock) {
    return fail(lock.error());
  }
  if (Status made = make_directories(incoming / name); !made) {
    return fail(made.error());
  }
  return OwnIncoming{incoming / name, std::move(*lock)};
}

}  // namespace

fs::path pyramid_path(const fs::path& columns) {
  fs::path path = columns;
  path += ".pyramid";
  return path;
}

fs::path bytes_below(const fs::path& root, std::string_view sha256) {
  return root / "blobs" / sha256.substr(0, 2) / sha256;
}

fs::path columns_below(const fs::path& root, std::string_view sha256) {
  return root / "columns" / sha256.substr(0, 2) / (std::string(sha256) + std::string(kColumnsSuffix));
}

Result<std::unique_ptr<BlobStore>> open_blob_directory(const fs::path& root) {
  for (const char* folder : {"blobs", "columns", "incoming"}) {
    if (Status made = make_directories(root / folder); !made) {
      return fail(made.error());
    }
  }
  Result<FileHandle> lock = lock_directory(root, "blobs.lock");
  if (!lock) {
    return fail(lock.error());
  }
  std::error_code error;
  for (fs::directory_iterator entry(root / "incoming", error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    fs::remove_all(entry->path(), error);
  }
  if (error) {
    return fail(file_error(error.value(), "clear", root / "incoming"));
  }
  std::vector<FileHandle> locks;
  locks.push_back(std::move(*lock));
  return std::make_unique<BlobDirectory>(root, root / "incoming", fs::path(), std::move(locks));
}

Result<std::unique_ptr<BlobStore>> open_shared_blob_directory(const fs::path& root) {
  for (const char* folder : {"blobs", "columns", "incoming"}) {
    if (Status made = make_directories(root / folder); !made) {
      return fail(made.error());
    }
  }
  auto together = wait_for_lock(root / "blobs.lock", LOCK_SH | LOCK_NB);
  if (!together) {
    return fail(ErrorCode::Conflict,
                "A driftlab daemon has the directory " + root.string() + " alone, as its --data; name another one.",
                {{"path", root.string()}});
  }
  if (Status cleared = clear_abandoned(root / "incoming"); !cleared) {
    return fail(cleared.error());
  }
  auto own = own_incoming(root / "incoming");
  if (!own) {
    return fail(own.error());
  }
  std::vector<FileHandle> locks;
  locks.push_back(std::move(*together));
  locks.push_back(std::move(own->lock));
  return std::make_unique<BlobDirectory>(root, own->folder, root / "names.lock", std::move(locks));
}

}  // namespace driftlab::server
