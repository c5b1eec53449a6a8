#pragma once
/// multipart/form-data (RFC 7578) read as it streams in: memory holds one piece and one part header, never a part.
#include "core/signal/result.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace driftlab::server {

/// The boundary of a Content-Type of multipart/form-data, or nothing for another type or a missing boundary.
[[nodiscard]] std::optional<std::string> multipart_boundary(std::string_view content_type);

class MultipartReader {
 public:
  struct Callbacks {
    /// The names of form field and file in Content-Disposition; without a file the second is empty.
    std::function<Status(const std::string& name, const std::string& file_name)> begin_part;
    std::function<Status(std::span<const std::byte>)> data;  ///< consecutive pieces of the part begun last
  };

  MultipartReader(std::string_view boundary, Callbacks callbacks);

  /// The next bytes of the body. Errors: ParseError (a part header that is malformed or longer than 8 KiB), and those
  /// of the callbacks.
  [[nodiscard]] Status feed(std::span<const std::byte> bytes);
  /// After the last byte. Error: Truncated where the closing boundary never came.
  [[nodiscard]] Status finish() const;

 private:
  enum class Stage { Content, AfterBoundary, Header, Epilogue };

  [[nodiscard]] Result<bool> step();
  [[nodiscard]] Result<bool> step_content();
  [[nodiscard]] Result<bool> step_after_boundary();
  [[nodiscard]] Result<bool> step_header();

  std::string delimiter_;
  Callbacks callbacks_;
  std::string pending_ = "\r\n";  // the first boundary may stand at the very start
  Stage stage_ = Stage::Content;
  bool in_part_ = false;
};

}  // namespace driftlab::server
