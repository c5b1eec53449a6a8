#pragma once
/// The chunked transfer coding (RFC 9112 section 7.1), read as it streams in.
///
/// Beast 1.81 lets chunk extensions and trailers grow without bound and takes trailers as headers, so that one could
/// add an Authorization. This reader holds nothing back, takes size lines of up to 256 bytes, skips extensions and
/// refuses trailers. Lines end with CR and LF: readers that take one of the two alone disagree about where a request
/// ends.
#include "core/signal/result.hpp"

#include <cstdint>
#include <string_view>

namespace driftlab::server {

class ChunkedBody {
 public:
  struct Step {
    std::size_t taken = 0;  ///< bytes of what arrived that are done with
    std::string_view data;  ///< what of them is content
  };
  /// Looks at the bytes that have arrived since those taken last. Nothing taken before `done`: more must come first.
  /// Error: ParseError; the connection cannot go on.
  [[nodiscard]] Result<Step> step(std::string_view arrived);
  [[nodiscard]] bool done() const { return stage_ == Stage::Done; }

 private:
  enum class Stage { Size, Data, DataEnd, LastLine, Done };

  [[nodiscard]] Result<Step> read_size(std::string_view arrived);
  [[nodiscard]] Result<Step> read_line_end(std::string_view arrived, Stage next, const char* otherwise);

  Stage stage_ = Stage::Size;
  std::uint64_t left_ = 0;  ///< of the chunk
};

}  // namespace driftlab::server
