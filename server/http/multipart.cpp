#include "server/http/multipart.hpp"

#include "core/signal/text.hpp"
#include "server/http/names.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

constexpr std::size_t kLongestHeader = std::size_t{8} * 1024;

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

/// The value of `key=value` or `key="value"` in a header with parameters.
std::optional<std::string> header_parameter(std::string_view header, std::string_view key) {
  for (const std::string_view piece : split(header, ';')) {
    const std::string_view entry = trimmed(piece);
    const std::size_t equals = entry.find('=');
    if (equals == std::string_view::npos || !same_name(trimmed(entry.substr(0, equals)), key)) {
      continue;
    }
    std::string_view value = trimmed(entry.substr(equals + 1));
    if (value.size() >= 2 && value.front() == '"' && value.back() == '"') {
      value = value.substr(1, value.size() - 2);
    }
    return std::string(value);
  }
  return std::nullopt;
}

/// Content-Disposition of a part header, without its name; empty where there is none.
std::string_view disposition_in(std::string_view header) {
  for (std::string_view line : split(header, '\n')) {
    const std::size_t colon = line.find(':');
    if (colon != std::string_view::npos && same_name(trimmed(line.substr(0, colon)), "content-disposition")) {
      if (!line.empty() && line.back() == '\r') {
        line.remove_suffix(1);
      }
      return line.substr(colon + 1);
    }
  }
  return {};
}

}  // namespace

std::optional<std::string> multipart_boundary(std::string_view content_type) {
  if (!same_name(trimmed(split(content_type, ';').front()), "multipart/form-data")) {
    return std::nullopt;
  }
  auto boundary = header_parameter(content_type, "boundary");
  return boundary && !boundary->empty() && boundary->size() <= 70 ? boundary : std::nullopt;
}

MultipartReader::MultipartReader(std::string_view boundary, Callbacks callbacks)
    : delimiter_("\r\n--" + std::string(boundary)), callbacks_(std::move(callbacks)) {}

Status MultipartReader::feed(std::span<const std::byte> bytes) {
  if (stage_ == Stage::Epilogue) {
    return {};
  }
  pending_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  while (true) {
    auto moved = step();
    if (!moved) {
      return fail(moved.error());
    }
    if (!*moved) {
      return {};
    }
  }
}

Status MultipartReader::finish() const {
  if (stage_ != Stage::Epilogue) {
    return fail(ErrorCode::Truncated, "The multipart body ends before its closing boundary.");
  }
  return {};
}

Result<bool> MultipartReader::step() {
  switch (stage_) {
    case Stage::Content:
      return step_content();
    case Stage::AfterBoundary:
      return step_after_boundary();
    case Stage::Header:
      return step_header();
    case Stage::Epilogue:
      pending_.clear();
      return false;
  }
  return false;
}

Result<bool> MultipartReader::step_content() {
  const std::size_t at = pending_.find(delimiter_);
  const bool found = at != std::string::npos;
  // Without a boundary in sight its beginning may be the last bytes: keep those back.
  const std::size_t safe = found ? at : pending_.size() - std::min(pending_.size(), delimiter_.size() - 1);
  if (in_part_ && safe > 0) {
    if (auto taken = callbacks_.data(bytes_of(std::string_view(pending_).substr(0, safe))); !taken) {
      return fail(taken.error());
    }
  }
  pending_.erase(0, found ? at + delimiter_.size() : safe);
  if (found) {
    in_part_ = false;
    stage_ = Stage::AfterBoundary;
  }
  return found;
}

Result<bool> MultipartReader::step_after_boundary() {
  if (pending_.size() < 2) {
    return false;
  }
  if (pending_.starts_with("--")) {
    stage_ = Stage::Epilogue;
    pending_.clear();
    return false;
  }
  const std::size_t end = pending_.find("\r\n");
  if (end == std::string::npos) {
    if (pending_.size() > kLongestHeader) {
      return fail(ErrorCode::ParseError, "A multipart boundary is not followed by a line end.");
    }
    return false;
  }
  pending_.erase(0, end);  // the line end stays: an empty part header is just it, twice
  stage_ = Stage::Header;
  return true;
}

Result<bool> MultipartReader::step_header() {
  const std::size_t end = pending_.find("\r\n\r\n");
  if (end == std::string::npos || end > kLongestHeader) {
    if (pending_.size() > kLongestHeader) {
      return fail(ErrorCode::ParseError, "A part header of the multipart body is longer than 8 KiB.");
    }
    return false;
  }
  const std::string_view disposition = disposition_in(std::string_view(pending_).substr(0, end));
  const auto name = header_parameter(disposition, "name");
  if (!name) {
    return fail(ErrorCode::ParseError, "A part of the multipart body has no name in its Content-Disposition.");
  }
  if (auto begun = callbacks_.begin_part(*name, header_parameter(disposition, "filename").value_or("")); !begun) {
    return fail(begun.error());
  }
  pending_.erase(0, end + 4);
  in_part_ = true;
  stage_ = Stage::Content;
  return true;
}

}  // namespace driftlab::server
