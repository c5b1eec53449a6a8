#include "server/store/copied_blobs.hpp"

#include "server/store/checksums.hpp"
#include "server/store/digest.hpp"
#include "server/store/files.hpp"
#include "server/store/retry_policy.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <functional>
#include <system_error>
#include <thread>
#include <utility>

namespace driftlab::server {
namespace {

namespace fs = std::filesystem;

/// Copies that were used a moment ago are not removed: somebody is about to open them.
constexpr auto kJustUsed = std::chrono::minutes(5);

void mark_used(const fs::path& path) { (void)::utimensat(AT_FDCWD, path.c_str(), nullptr, 0); }

/// What an upload writes: into the local directory first, then into the storage.
class IncomingCopy final : public IncomingBlob {
 public:
  IncomingCopy(CopiedBlobs& blobs, std::unique_ptr<IncomingBlob> local) : blobs_(blobs), local_(std::move(local)) {}
  [[nodiscard]] Status append(std::span<const std::byte> bytes) override { return local_->append(bytes); }
  [[nodiscard]] Status seal() override { return local_->seal(); }
  [[nodiscard]] const std::string& sha256() const override { return local_->sha256(); }
  [[nodiscard]] std::size_t size() const override { return local_->size(); }
  [[nodiscard]] const fs::path& path() const override { return local_->path(); }
  [[nodiscard]] fs::path columns_path() const override { return local_->columns_path(); }
  [[nodiscard]] Status keep() override {
    if (Status kept = local_->keep(); !kept) {
      return kept;
    }
    return blobs_.store_files(local_->sha256());
  }

 private:
  CopiedBlobs& blobs_;
  std::unique_ptr<IncomingBlob> local_;
};

/// The files of a blob beside its bytes, columns last: once they are there, the others are.
std::vector<LocalFile> files_of_columns(const fs::path& columns) {
  const fs::path pyramid = pyramid_path(columns);
  return {{kPyramidSum, columns_checksum_path(pyramid)},
          {kPyramid, pyramid},
          {kColumnsSum, columns_checksum_path(columns)},
          {kColumns, columns}};
}

/// What the file beside a copy says of it; empty where there is none.
std::string sum_beside(FileKind kind, const fs::path& path) {
  std::string sum;
  if (kind == kColumns || kind == kPyramid) {
    std::ifstream(columns_checksum_path(path)) >> sum;
  }
  return sum;
}

}  // namespace

Result<std::unique_ptr<IncomingBlob>> CopiedBlobs::begin() {
  auto local = local_->begin();
  if (!local) {
    return local;
  }
  return std::make_unique<IncomingCopy>(*this, std::move(*local));
}

/// Whoever opens the path where nothing could be fetched finds that there is nothing; `reach` says why.
fs::path CopiedBlobs::bytes_path(std::string_view sha256) const {
  (void)reach(sha256, BlobPart::Bytes);
  return local_->bytes_path(sha256);
}

fs::path CopiedBlobs::columns_path(std::string_view sha256) const {
  (void)reach(sha256, BlobPart::Columns);
  return local_->columns_path(sha256);
}

Status CopiedBlobs::reach(std::string_view sha256, BlobPart part) const {
  if (part == BlobPart::Bytes) {
    return fetch(std::string(sha256), kBytes, local_->bytes_path(sha256)).map([](Fetched) {});
  }
  const fs::path columns = local_->columns_path(sha256);
  if (is_there(columns)) {
    mark_used(columns);
    return {};
  }
  for (const LocalFile& file : files_of_columns(columns)) {
    if (const auto fetched = fetch(std::string(sha256), file.kind, file.path); !fetched) {
      return fail(fetched.error());
    }
  }
  return {};
}

/// A storage that is restarted meanwhile is no damage of a recording, and neither is a byte that was lost on the way.
Result<CopiedBlobs::Fetched> CopiedBlobs::fetch(const std::string& sha256, FileKind kind, const fs::path& path) const {
  if (!is_sha256_hex(sha256)) {
    return Fetched::Missing;
  }
  const std::lock_guard<std::mutex> guard(fetching_.at(std::hash<std::string>{}(sha256) % fetching_.size()));
  if (is_there(path)) {
    mark_used(path);
    return Fetched::There;
  }
  make_room(sha256);
  const auto until = std::chrono::steady_clock::now() + patience_.in_all;
  auto fetched = fetch_once(sha256, kind, path);
  auto pause = patience_.first_pause;
  for (int attempt = 1; attempt < patience_.attempts && std::chrono::steady_clock::now() < until; ++attempt) {
    const bool passing = fetched ? *fetched == Fetched::Damaged : fetched.error().code == ErrorCode::Io;
    if (!passing) {
      break;
    }
    std::this_thread::sleep_for(draw_pause(pause));
    pause *= 2;
    fetched = fetch_once(sha256, kind, path);
  }
  return fetched;
}

Result<CopiedBlobs::Fetched> CopiedBlobs::fetch_once(const std::string& sha256, FileKind kind,
                                                     const fs::path& path) const {
  if (Status made = make_directories(path.parent_path()); !made) {
    return fail(made.error());
  }
  const fs::path temporary = root_ / "incoming" / ("fetched-" + sha256 + "." + std::string(kind));
  Sha256 digest;
  Result<std::string> wanted;
  {
    std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
    const auto broken = [&] { return fail(file_error(errno == 0 ? EIO : errno, "write", temporary)); };
    wanted = remote_->read(sha256, kind, [&](std::span<const std::byte> bytes) -> Status {
      digest.update(bytes);
      errno = 0;
      stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
      return stream ? Status{} : broken();
    });
    stream.close();
    if (wanted && !stream) {
      wanted = broken();
    }
  }
  if (!wanted) {
    (void)remove_file(temporary);
    return wanted.error().code == ErrorCode::NotFound ? Result<Fetched>(Fetched::Missing) : fail(wanted.error());
  }
  const std::string expected = wanted->empty() ? sum_beside(kind, path) : *wanted;
  if (!expected.empty() && digest.finish() != expected) {
    (void)remove_file(temporary);
    return Fetched::Damaged;
  }
  return rename_durably(temporary, path).map([] { return Fetched::There; });
}

/// Of the local copies those that were used longest ago go until the rest is within the budget.
void CopiedBlobs::make_room(const std::string& sha256) const {
  struct Copy {
    fs::file_time_type used;
    std::uintmax_t bytes = 0;
    std::string blob;
  };
  const std::lock_guard<std::mutex> guard(making_room_);
  std::vector<Copy> copies;
  std::uintmax_t total = 0;
  for (const char* folder : {"blobs", "columns"}) {
    std::error_code error;
    fs::recursive_directory_iterator entry(root_ / folder, error);
    for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
      std::error_code gone;
      const std::uintmax_t bytes = entry->is_regular_file(gone) ? entry->file_size(gone) : 0;
      const auto used = entry->last_write_time(gone);
      const std::string name = entry->path().filename().string().substr(0, 64);
      if (!gone && is_sha256_hex(name)) {
        copies.push_back({used, bytes, name});
        total += bytes;
      }
    }
  }
  std::sort(copies.begin(), copies.end(), [](const Copy& a, const Copy& b) { return a.used < b.used; });
  const auto newest = fs::file_time_type::clock::now() - kJustUsed;
  for (auto copy = copies.begin(); copy != copies.end() && total > cache_bytes_ && copy->used < newest; ++copy) {
    if (copy->blob != sha256 && local_->remove(copy->blob)) {
      for (const Copy& each : copies) {
        total -= each.blob == copy->blob ? std::min(total, each.bytes) : 0;
      }
    }
  }
}

Status CopiedBlobs::store_files(const std::string& sha256) {
  std::vector<LocalFile> files{{kBytes, local_->bytes_path(sha256)}};
  for (LocalFile& file : files_of_columns(local_->columns_path(sha256))) {
    if (is_there(file.path)) {
      files.push_back(std::move(file));
    }
  }
  if (Status stored = remote_->store(sha256, files); !stored) {
    return stored;
  }
  make_room(sha256);
  return {};
}

Status CopiedBlobs::remove(std::string_view sha256) {
  if (!is_sha256_hex(sha256)) {
    return fail(ErrorCode::InvalidArgument, "A blob is named by 64 hexadecimal digits.", {{"parameter", "sha256"}});
  }
  if (Status removed = remote_->remove(std::string(sha256)); !removed) {
    return removed;
  }
  return local_->remove(sha256);
}

Result<bool> CopiedBlobs::remove_if_older(std::string_view sha256, std::chrono::microseconds age) {
  auto removed = remote_->remove_if_older(std::string(sha256), age);
  if (!removed || !*removed) {
    return removed;
  }
  return local_->remove(sha256).map([] { return true; });
}

}  // namespace driftlab::server
