#include "server/http/chunked.hpp"

#include <algorithm>
#include <charconv>

namespace driftlab::server {
namespace {

constexpr std::size_t kLongestLine = 256;
constexpr std::size_t kMostDigits = 16;  // of 2^64
constexpr std::string_view kLineEnd = "\r\n";

tl::unexpected<Error> malformed(const char* sentence) { return fail(ErrorCode::ParseError, sentence); }

bool is_hexadecimal(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }

}  // namespace

Result<ChunkedBody::Step> ChunkedBody::step(std::string_view arrived) {
  switch (stage_) {
    case Stage::Size:
      return read_size(arrived);
    case Stage::Data: {
      const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left_, arrived.size()));
      left_ -= count;
      stage_ = left_ == 0 ? Stage::DataEnd : Stage::Data;
      return Step{count, arrived.substr(0, count)};
    }
    case Stage::DataEnd:
      return read_line_end(arrived, Stage::Size, "A chunk is longer or shorter than its size line says.");
    case Stage::LastLine:
      return read_line_end(arrived, Stage::Done, "Trailers after the last chunk are not taken.");
    case Stage::Done:
      break;
  }
  return Step{};
}

Result<ChunkedBody::Step> ChunkedBody::read_size(std::string_view arrived) {
  const std::string_view line = arrived.substr(0, kLongestLine + kLineEnd.size());
  const auto control = std::find_if(
      line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) < 32 && c != '\t') || c == 127; });
  const auto length = static_cast<std::size_t>(control - line.begin());
  const std::string_view end = line.substr(length, kLineEnd.size());
  if (length > kLongestLine || !kLineEnd.starts_with(end)) {
    return malformed("The size line of a chunk is longer than 256 bytes or does not end with CR and LF.");
  }
  if (end.size() < kLineEnd.size()) {
    return Step{};
  }
  const std::string_view digits =
      line.substr(0, static_cast<std::size_t>(std::find_if_not(line.begin(), control, is_hexadecimal) - line.begin()));
  const std::string_view extension = line.substr(digits.size(), length - digits.size());
  if (digits.empty() || digits.size() > kMostDigits || !(extension.empty() || extension.starts_with(';'))) {
    return malformed("The size of a chunk must be 1 to 16 hexadecimal digits.");
  }
  std::from_chars(digits.data(), digits.data() + digits.size(), left_, 16);
  stage_ = left_ == 0 ? Stage::LastLine : Stage::Data;
  return Step{length + kLineEnd.size(), {}};
}

Result<ChunkedBody::Step> ChunkedBody::read_line_end(std::string_view arrived, Stage next, const char* otherwise) {
  const std::string_view end = arrived.substr(0, kLineEnd.size());
  if (!kLineEnd.starts_with(end)) {
    return malformed(otherwise);
  }
  if (end.size() < kLineEnd.size()) {
    return Step{};
  }
  stage_ = next;
  return Step{kLineEnd.size(), {}};
}

}  // namespace driftlab::server
