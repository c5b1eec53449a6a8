#include "server/http/compression.hpp"

#include "core/signal/number.hpp"
#include "core/signal/text.hpp"
#include "server/http/names.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>

namespace driftlab::server {
namespace {

constexpr std::string_view kEnding = "-gzip\"";
constexpr int kGzipWindow = 15 + 16;  // zlib.h: 16 asks for the gzip format
constexpr int kMemoryLevel = 8;

bool is_text(std::string_view type) {
  return type.starts_with("text/") || type.find("json") != std::string_view::npos ||
         type.find("javascript") != std::string_view::npos || type.starts_with("image/svg");
}

}  // namespace

std::string gzip(std::string_view text, int level) {
  z_stream stream{};
  if (text.size() > std::numeric_limits<uInt>::max() ||
      deflateInit2(&stream, level, Z_DEFLATED, kGzipWindow, kMemoryLevel, Z_DEFAULT_STRATEGY) != Z_OK) {
    return {};
  }
  std::string packed(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));  // zlib reads it only
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const bool whole = deflate(&stream, Z_FINISH) == Z_STREAM_END;
  packed.resize(whole ? stream.total_out : 0);
  deflateEnd(&stream);
  return packed;
}

bool takes_gzip(const Request& request) {
  const std::string_view accepted = request.header("accept-encoding").value_or("");
  for (const std::string_view entry : split(accepted, ',')) {
    const std::vector<std::string_view> parts = split(entry, ';');
    if (!same_name(trimmed(parts.front()), "gzip")) {
      continue;
    }
    for (const std::string_view part : parts) {
      if (trimmed(part).starts_with("q=") && parse_double(trimmed(part).substr(2)).value_or(0.0) <= 0.0) {
        return false;
      }
    }
    return true;
  }
  return false;
}

std::string plain_tag(std::string_view field) {
  std::string plain(field);
  for (std::size_t at = plain.find(kEnding); at != std::string::npos; at = plain.find(kEnding, at)) {
    plain.replace(at, kEnding.size(), "\"");
  }
  return plain;
}

void compress(const Request& request, Response& response) {
  if (response.has_header("Content-Encoding") || !is_text(response.content_type)) {
    return;
  }
  const bool empty = response.status == 304;
  if (!empty && response.body.size() < kSmallestCompressed) {
    return;
  }
  const auto vary = std::find_if(response.headers.begin(), response.headers.end(),
                                 [](const auto& header) { return header.first == "Vary"; });
  if (vary == response.headers.end()) {
    response.headers.emplace_back("Vary", "Accept-Encoding");
  } else {
    vary->second += ", Accept-Encoding";
  }
  if (empty || !takes_gzip(request)) {
    return;
  }
  std::string packed = gzip(response.body);
  if (packed.empty()) {
    return;
  }
  response.body = std::move(packed);
  response.headers.emplace_back("Content-Encoding", "gzip");
  for (auto& [name, value] : response.headers) {
    if (name == "ETag" && value.ends_with('"')) {
      value.replace(value.size() - 1, 1, kEnding);
    }
  }
}

}  // namespace driftlab::server
