#pragma once
/// A temporary directory for decoded columns.
#include "core/signal/result.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

namespace driftlab::cli {

/// A directory of our own for decoded columns, gone at the end.
class Workspace {
 public:
  static Result<Workspace> make() {
    std::error_code error;
    std::string pattern = (std::filesystem::temp_directory_path(error) / "driftlab-XXXXXX").string();
    if (error || mkdtemp(pattern.data()) == nullptr) {
      return fail(ErrorCode::Io, "No temporary directory can be made; set TMPDIR to one that can be written.");
    }
    return Workspace(pattern);
  }
  Workspace(Workspace&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  Workspace& operator=(Workspace&&) = delete;
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
  ~Workspace() {
    if (!path_.empty()) {
      std::error_code ignored;
      std::filesystem::remove_all(path_, ignored);
    }
  }
  [[nodiscard]] std::filesystem::path file() const { return path_ / "columns"; }

 private:
  explicit Workspace(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

}  // namespace driftlab::cli
