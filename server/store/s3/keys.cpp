#include "server/store/s3/keys.hpp"

#include "core/signal/text.hpp"

#include <cstdlib>
#include <fstream>
#include <memory>
#include <mutex>
#include <system_error>

namespace driftlab::server::s3 {
namespace {

namespace fs = std::filesystem;

/// A file that people and services replace while a daemon runs.
class KeyFile {
 public:
  KeyFile(fs::path path, Credentials first) : path_(std::move(path)), known_(std::move(first)) { seen_ = written(); }

  Result<Credentials> key() {
    const std::lock_guard<std::mutex> guard(mutex_);
    const auto now = written();
    if (now != seen_) {
      // Half of a new file is no reason to forget the key.
      if (auto read = read_key_file(path_)) {
        known_ = std::move(*read);
        seen_ = now;
      }
    }
    return known_;
  }

 private:
  [[nodiscard]] fs::file_time_type written() const {
    std::error_code none;
    return fs::last_write_time(path_, none);
  }

  fs::path path_;
  std::mutex mutex_;
  Credentials known_;
  fs::file_time_type seen_{};
};

std::string variable(const char* name) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): before any thread
  return value == nullptr ? "" : value;
}

tl::unexpected<Error> incomplete(const fs::path& path) {
  return fail(ErrorCode::ParseError,
              "The file " + path.string() + " has no aws_access_key_id and aws_secret_access_key under [default].",
              {{"parameter", "blobs-credentials"}});
}

}  // namespace

Result<Credentials> read_key_file(const fs::path& path) {
  std::ifstream stream(path);
  if (!stream) {
    std::error_code none;
    const bool there = fs::exists(path, none);
    return fail(
        there ? ErrorCode::Io : ErrorCode::NotFound,
        "The file " + path.string() + " of the key of --blobs " + (there ? "cannot be read." : "does not exist."),
        {{"parameter", "blobs-credentials"}});
  }
  Credentials found;
  bool ours = true;
  std::string line;
  while (std::getline(stream, line)) {
    if (!line.empty() && line.back() == '\r') {
      line.pop_back();
    }
    const std::string_view text = trimmed(line);
    if (text.starts_with('[')) {
      ours = text == "[default]";
    }
    const std::size_t equals = text.find('=');
    if (!ours || equals == std::string_view::npos || text.starts_with('#')) {
      continue;
    }
    const std::string_view name = trimmed(text.substr(0, equals));
    const std::string_view value = trimmed(text.substr(equals + 1));
    std::string* const member = name == "aws_access_key_id"       ? &found.key_id
                                : name == "aws_secret_access_key" ? &found.secret
                                : name == "aws_session_token"     ? &found.session_token
                                                                  : nullptr;
    if (member != nullptr) {
      *member = std::string(value);
    }
  }
  return found.key_id.empty() || found.secret.empty() ? Result<Credentials>(incomplete(path)) : found;
}

Result<Client::KeyRing> find_key(const fs::path& file) {
  if (!file.empty()) {
    auto first = read_key_file(file);
    if (!first) {
      return fail(first.error());
    }
    return [ring = std::make_shared<KeyFile>(file, std::move(*first))] { return ring->key(); };
  }
  Credentials found{variable("AWS_ACCESS_KEY_ID"), variable("AWS_SECRET_ACCESS_KEY"), variable("AWS_SESSION_TOKEN")};
  if (found.key_id.empty() || found.secret.empty()) {
    return fail(ErrorCode::InvalidArgument,
                "The object storage of --blobs needs a key: name its file with --blobs-credentials, or set "
                "AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY.",
                {{"parameter", "blobs-credentials"}});
  }
  return [found]() -> Result<Credentials> { return found; };
}

}  // namespace driftlab::server::s3
