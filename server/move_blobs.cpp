#include "server/move_blobs.hpp"

#include "server/store/checksums.hpp"
#include "server/store/digest.hpp"
#include "server/store/files.hpp"

#include <fstream>
#include <span>
#include <system_error>
#include <utility>

namespace driftlab::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPieceBytes = 1U << 20U;

Status append_file(IncomingBlob& target, const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> piece(kPieceBytes);
  while (stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const auto got = static_cast<std::size_t>(stream.gcount());
    if (Status appended = target.append(std::as_bytes(std::span(piece.data(), got))); !appended) {
      return appended;
    }
  }
  return target.seal();
}

Status duplicate(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
  return error ? Status(fail(file_error(error.value(), "copy", from))) : Status{};
}

}  // namespace

BlobFiles files_of(const BlobStore& blobs) {
  return {[&blobs](const std::string& sha256) { return blobs.bytes_path(sha256); },
          [&blobs](const std::string& sha256) { return blobs.columns_path(sha256); }};
}

BlobFiles files_in(const fs::path& root) {
  return {[root](const std::string& sha256) { return bytes_below(root, sha256); },
          [root](const std::string& sha256) { return columns_below(root, sha256); }};
}

Result<std::vector<std::string>> hashes_in(const fs::path& root) {
  std::set<std::string> hashes;
  std::error_code error;
  fs::recursive_directory_iterator entry(root / "blobs", error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::string name = entry->path().filename().string();
    if (is_sha256_hex(name)) {
      hashes.insert(std::move(name));
    }
  }
  if (error) {
    return fail(file_error(error.value(), "list", root / "blobs"));
  }
  return std::vector(hashes.begin(), hashes.end());
}

bool is_sound(const BlobFiles& files, const std::string& sha256) {
  const auto bytes = check_bytes(files.bytes(sha256), sha256);
  const auto columns = check_columns(files.columns(sha256));
  return bytes && columns && *bytes == FileState::Sound && *columns == FileState::Sound;
}

Status copy_blob(const BlobFiles& from, BlobStore& to, const std::string& sha256) {
  if (!is_sound(from, sha256)) {
    return fail(ErrorCode::Io,
                "The recording " + sha256 + " is damaged where it is; heal it (driftlabd check) before it is moved.",
                {{"blob", sha256}});
  }
  auto incoming = to.begin();
  if (!incoming) {
    return fail(incoming.error());
  }
  if (Status appended = append_file(**incoming, from.bytes(sha256)); !appended) {
    return appended;
  }
  const fs::path columns = from.columns(sha256);
  if (Status copied = duplicate(columns, (*incoming)->columns_path()); !copied) {
    return copied;
  }
  std::error_code none;
  if (fs::exists(pyramid_path(columns), none)) {
    if (Status copied = duplicate(pyramid_path(columns), pyramid_path((*incoming)->columns_path())); !copied) {
      return copied;
    }
  }
  if (Status kept = (*incoming)->keep(); !kept) {
    return kept;
  }
  return is_sound(files_of(to), sha256)
             ? Status{}
             : fail(ErrorCode::Io, "The recording " + sha256 + " was not copied as it is.", {{"blob", sha256}});
}

AheadList::AheadList(fs::path path, std::string what) : path_(std::move(path)), what_(std::move(what)) {
  std::ifstream stream(path_);
  std::string line;
  begun_ = stream && std::getline(stream, line) && line == what_;
  while (begun_ && std::getline(stream, line)) {
    if (is_sha256_hex(line)) {
      hashes_.insert(line);
    }
  }
}

void AheadList::keep(const std::vector<std::string>& there) {
  std::set<std::string> kept;
  for (const std::string& sha256 : there) {
    if (holds(sha256)) {
      kept.insert(sha256);
    }
  }
  hashes_ = std::move(kept);
}

Status AheadList::begin() {
  if (!begun_) {
    if (Status begun = write_secret_file(path_, what_ + "\n"); !begun) {
      return begun;
    }
    begun_ = true;
  }
  return {};
}

Status AheadList::add(const std::string& sha256) {
  if (Status begun = begin(); !begun) {
    return begun;
  }
  std::ofstream stream(path_, std::ios::app);
  stream << sha256 << "\n" << std::flush;
  if (!stream) {
    return fail(file_error(errno, "write", path_));
  }
  hashes_.insert(sha256);
  return {};
}

Status AheadList::remove() {
  hashes_.clear();
  begun_ = false;
  return remove_file(path_);
}

}  // namespace driftlab::server
