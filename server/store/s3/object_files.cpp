#include "server/store/s3/object_files.hpp"

#include "server/store/checksums.hpp"
#include "server/store/digest.hpp"
#include "server/store/files.hpp"
#include "server/store/s3/xml.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <optional>
#include <set>
#include <system_error>

namespace driftlab::server::s3 {
namespace {

namespace fs = std::filesystem;

constexpr std::array<FileKind, 5> kKinds{kPyramidSum, kPyramid, kColumnsSum, kColumns, kBytes};
constexpr const char* kMark = "postgresql-store";
constexpr const char* kSumHeader = "x-amz-meta-sha256";
constexpr std::uintmax_t kMostParts = 10'000;
/// What was removed while it was uploaded is written again so often.
constexpr int kRounds = 3;

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

bool is_missing(const Error& error) { return error.code == ErrorCode::NotFound; }

/// The time of the storage's own clock, by which it dates objects.
UtcMicros storage_time(const Reply& reply) { return read_time(reply.header("date")).value_or(SystemClock().now()); }

/// The hash that a key names; empty for one of another kind.
std::string hash_in(const std::string& key) {
  const std::string name = key.substr(key.rfind('/') + 1).substr(0, 64);
  return is_sha256_hex(name) ? name : std::string();
}

/// Whoever asks whether it answers does not wait as long as an upload does.
ClientOptions soon(ClientOptions options) {
  constexpr std::chrono::milliseconds kSoon{3000};
  options.patience.connecting = std::min(options.patience.connecting, kSoon);
  options.patience.answering = std::min(options.patience.answering, kSoon);
  options.patience.moving = std::min(options.patience.moving, kSoon);
  return options;
}

Status read_piece(std::ifstream& stream, std::vector<char>& piece, std::size_t bytes, const fs::path& path) {
  piece.resize(bytes);
  stream.read(piece.data(), static_cast<std::streamsize>(bytes));
  return static_cast<std::size_t>(stream.gcount()) == bytes ? Status{} : Status(fail(file_error(EIO, "read", path)));
}

}  // namespace

ObjectFiles::ObjectFiles(Place place, Client::KeyRing keys, NamesLock names, ClientOptions options,
                         std::size_t part_bytes, int page_keys)
    : client_(place, keys, options),
      probe_(std::move(place), std::move(keys), soon(options)),
      names_(std::move(names)),
      part_bytes_(part_bytes),
      page_keys_(std::to_string(page_keys)) {}

std::string ObjectFiles::key_of(const std::string& blob, FileKind kind) const {
  const std::string folder = "/" + blob.substr(0, 2) + "/" + blob;
  std::string key = client_.place().prefix;
  if (kind == kBytes) {
    return key + "blobs" + folder;
  }
  key += "columns" + folder + ".columns";
  return key + (kind == kColumns      ? ""
                : kind == kColumnsSum ? ".sha256"
                : kind == kPyramid    ? ".pyramid"
                                      : ".pyramid.sha256");
}

Status ObjectFiles::store(const std::string& blob, std::span<const LocalFile> files) {
  std::vector<Written> all;
  for (const LocalFile& file : files) {
    auto written = put_file(key_of(blob, file.kind), file.path);
    if (!written) {
      return fail(written.error());
    }
    all.push_back(std::move(*written));
  }
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::size_t> lost;
    const Status looked = names_(blob, [&]() -> Status {
      lost.clear();
      for (std::size_t i = 0; i < all.size(); ++i) {
        const auto there = holds(all[i]);
        if (!there) {
          return fail(there.error());
        }
        if (!*there) {
          lost.push_back(i);
        }
      }
      return {};
    });
    if (!looked || lost.empty()) {
      return looked;
    }
    for (const std::size_t i : lost) {
      if (auto again = put_file(all[i].key, files[i].path); !again) {
        return fail(again.error());
      }
    }
  }
  return fail(ErrorCode::Io,
              "The object storage at " + client_.place().authority() + " does not keep what was written to it.",
              {{"blob", blob}});
}

Result<bool> ObjectFiles::holds(const Written& written) const {
  const auto found = client_.send({"HEAD", written.key, {}, {}, {}});
  if (!found) {
    return is_missing(found.error()) ? Result<bool>(false) : fail(found.error());
  }
  return found->header("content-length") == std::to_string(written.bytes) &&
         found->header(kSumHeader) == written.sha256;
}

Result<ObjectFiles::Written> ObjectFiles::put_file(const std::string& key, const fs::path& path) {
  auto sha256 = sha256_of_file(path);
  if (!sha256) {
    return fail(sha256.error());
  }
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(path, error);
  if (error) {
    return fail(file_error(error.value(), "read", path));
  }
  Written written{key, std::move(*sha256), bytes};
  if (bytes > part_bytes_) {
    const Status put = put_parts(written, path);
    return put ? Result<Written>(std::move(written)) : fail(put.error());
  }
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> content;
  if (Status read = read_piece(stream, content, static_cast<std::size_t>(bytes), path); !read) {
    return fail(read.error());
  }
  const auto put = client_.send({"PUT", key, {}, {{kSumHeader, written.sha256}}, std::as_bytes(std::span(content))});
  return put ? Result<Written>(std::move(written)) : fail(put.error());
}

Status ObjectFiles::put_parts(const Written& written, const fs::path& path) {
  const auto begun = client_.send({"POST", written.key, {{"uploads", ""}}, {{kSumHeader, written.sha256}}, {}});
  if (!begun) {
    return fail(begun.error());
  }
  const auto upload = element_text(begun->body, "UploadId");
  if (!upload || upload->empty()) {
    return fail(ErrorCode::Io,
                "The object storage at " + client_.place().authority() + " does not begin an upload in parts.");
  }
  std::string parts;
  Status put = put_each_part(written.key, *upload, path, written.bytes, parts);
  if (put) {
    put = complete(written, *upload, parts);
  }
  if (!put) {
    (void)client_.send_once({"DELETE", written.key, {{"uploadId", *upload}}, {}, {}});
  }
  return put;
}

Status ObjectFiles::put_each_part(const std::string& key, const std::string& upload, const fs::path& path,
                                  std::uintmax_t bytes, std::string& parts) {
  const std::uintmax_t part_bytes = std::max<std::uintmax_t>(part_bytes_, bytes / kMostParts + 1);
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> piece;
  int number = 0;
  for (std::uintmax_t at = 0; at < bytes; at += part_bytes) {
    const auto size = static_cast<std::size_t>(std::min(part_bytes, bytes - at));
    if (Status read = read_piece(stream, piece, size, path); !read) {
      return read;
    }
    const std::string name = std::to_string(++number);
    const auto put =
        client_.send({"PUT", key, {{"partNumber", name}, {"uploadId", upload}}, {}, std::as_bytes(std::span(piece))});
    if (!put) {
      return fail(put.error());
    }
    parts.append("<Part><PartNumber>" + name + "</PartNumber><ETag>" + put->header("etag") + "</ETag></Part>");
  }
  return {};
}

/// An answer that was lost, or came late, leaves open whether it is done: the object says.
Status ObjectFiles::complete(const Written& written, const std::string& upload, const std::string& parts) {
  const std::string body = "<CompleteMultipartUpload>" + parts + "</CompleteMultipartUpload>";
  const auto done = client_.send({"POST", written.key, {{"uploadId", upload}}, {}, bytes_of(body)});
  if (done) {
    return {};
  }
  const auto there = holds(written);
  if (there && *there) {
    return {};
  }
  Error error = done.error();
  error.code = is_missing(error) ? ErrorCode::Io : error.code;
  return fail(std::move(error));
}

Result<std::string> ObjectFiles::read(const std::string& blob, FileKind kind, const Sink& sink) const {
  const auto got = client_.send({"GET", key_of(blob, kind), {}, {}, {}}, sink);
  if (!got) {
    return fail(got.error());
  }
  const std::string told = got->header(kSumHeader);
  return kind == kBytes ? blob : is_sha256_hex(told) ? told : std::string();
}

Status ObjectFiles::remove(const std::string& blob) {
  for (const FileKind kind : kKinds) {
    if (const auto gone = client_.send({"DELETE", key_of(blob, kind), {}, {}, {}});
        !gone && !is_missing(gone.error())) {
      return fail(gone.error());
    }
  }
  return {};
}

Result<bool> ObjectFiles::remove_if_older(const std::string& blob, std::chrono::microseconds age) {
  bool removed = false;
  const Status done = names_(blob, [&]() -> Status {
    removed = false;
    bool old = false;
    for (const FileKind kind : kKinds) {
      const auto found = client_.send({"HEAD", key_of(blob, kind), {}, {}, {}});
      if (!found && !is_missing(found.error())) {
        return fail(found.error());
      }
      if (found) {
        const UtcMicros now = storage_time(*found);
        old = read_time(found->header("last-modified")).value_or(now) < now - age.count();
        if (!old) {
          return {};
        }
      }
    }
    removed = old;
    return old ? remove(blob) : Status{};
  });
  return done ? Result<bool>(removed) : fail(done.error());
}

Status ObjectFiles::list(const std::string& folder,
                         const std::function<void(std::string_view item, UtcMicros now)>& found) const {
  const Pairs first{{"list-type", "2"}, {"max-keys", page_keys_}, {"prefix", client_.place().prefix + folder}};
  Pairs query = first;
  while (true) {
    const auto page = client_.send({"GET", "", query, {}, {}});
    if (!page) {
      return fail(page.error());
    }
    for (const std::string_view item : elements(page->body, "Contents")) {
      found(item, storage_time(*page));
    }
    const auto next = element_text(page->body, "NextContinuationToken");
    if (!next || next->empty() || element_text(page->body, "IsTruncated") != "true") {
      return {};
    }
    query = first;
    query.emplace_back("continuation-token", *next);
  }
}

Result<std::vector<std::string>> ObjectFiles::hashes_older_than(std::chrono::microseconds age) {
  std::set<std::string> hashes;
  for (const char* folder : {"blobs/", "columns/"}) {
    const Status listed = list(folder, [&](std::string_view item, UtcMicros now) {
      const std::string hash = hash_in(element_text(item, "Key").value_or(""));
      const auto modified = read_time(element_text(item, "LastModified").value_or(""));
      if (!hash.empty() && modified && *modified < now - age.count()) {
        hashes.insert(hash);
      }
    });
    if (!listed) {
      return fail(listed.error());
    }
  }
  if (Status ended = end_uploads_older_than(age); !ended) {
    return fail(ended.error());
  }
  return std::vector<std::string>(hashes.begin(), hashes.end());
}

/// Of processes that were killed: their parts take room that no object shows.
Status ObjectFiles::end_uploads_older_than(std::chrono::microseconds age) {
  const auto page = client_.send({"GET", "", {{"uploads", ""}, {"prefix", client_.place().prefix}}, {}, {}});
  if (!page) {
    return fail(page.error());
  }
  for (const std::string_view item : elements(page->body, "Upload")) {
    const auto key = element_text(item, "Key");
    const auto upload = element_text(item, "UploadId");
    const auto begun = read_time(element_text(item, "Initiated").value_or(""));
    if (key && upload && begun && !hash_in(*key).empty() && *begun < storage_time(*page) - age.count()) {
      const auto ended = client_.send({"DELETE", *key, {{"uploadId", *upload}}, {}, {}});
      if (!ended && !is_missing(ended.error())) {
        return fail(ended.error());
      }
    }
  }
  return {};
}

Status ObjectFiles::ping() const {
  const auto got = probe_.send_once({"GET", client_.place().prefix + kMark, {}, {}, {}});
  if (got) {
    return {};
  }
  return is_missing(got.error())
             ? Status(fail(ErrorCode::Io,
                           "The bucket " + client_.place().bucket + " no longer has the mark of this database.",
                           {{"storage", client_.place().authority()}}))
             : fail(got.error());
}

Result<std::string> ObjectFiles::mark() const {
  auto got = client_.send({"GET", client_.place().prefix + kMark, {}, {}, {}});
  if (!got) {
    return is_missing(got.error()) ? Result<std::string>("") : fail(got.error());
  }
  std::string word = std::move(got->body);
  word.erase(word.find_last_not_of(" \r\n") + 1);
  return word.empty() ? "unreadable" : word;
}

Status ObjectFiles::write_mark(const std::string& word) {
  const std::string line = word + "\n";
  return client_.send({"PUT", client_.place().prefix + kMark, {}, {}, bytes_of(line)}).map([](const Reply&) {});
}

Result<bool> ObjectFiles::is_empty() const {
  for (const char* folder : {"blobs/", "columns/"}) {
    const auto page = client_.send(
        {"GET", "", {{"list-type", "2"}, {"max-keys", "1"}, {"prefix", client_.place().prefix + folder}}, {}, {}});
    if (!page) {
      return fail(page.error());
    }
    if (!elements(page->body, "Contents").empty()) {
      return false;
    }
  }
  return true;
}

}  // namespace driftlab::server::s3
