/// Any bytes as what clients send before a handler sees it: header, target, chunked and multipart bodies, ranges, media
/// types and preferences. The first byte says which.
#include "server/http/byte_range.hpp"
#include "server/http/chunked.hpp"
#include "server/http/guard.hpp"
#include "server/http/message.hpp"
#include "server/http/multipart.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

using namespace driftlab;
using namespace driftlab::server;

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

/// Lines of "name: value", the first of them method and target.
void guard(std::string_view text) {
  HeadView head;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    at = end + 1;
    const std::size_t colon = line.find(head.method.empty() ? ' ' : ':');
    if (colon == std::string_view::npos) {
      continue;
    }
    if (head.method.empty()) {
      head.method = line.substr(0, colon);
      head.target = line.substr(colon + 1);
    } else {
      head.headers.emplace_back(line.substr(0, colon), line.substr(colon + 1));
    }
  }
  GuardLimits limits;
  limits.hosts = {"localhost"};
  const GuardVerdict verdict = inspect(head, limits);
  require(!(verdict.chunked && verdict.content_length > 0 && !verdict.refusal));  // two ends are one too many
}

/// What is seen of a header does not depend on the pieces in which it came.
void arrival(std::string_view text) {
  const std::size_t cut = text.empty() ? 0 : static_cast<unsigned char>(text.front()) % text.size();
  const HeadArrival part = look_at_head(text.substr(0, cut));
  const HeadArrival whole = look_at_head(text);
  const HeadArrival resumed = part.whole || part.folded ? part : look_at_head(text, cut);
  require(whole.whole == resumed.whole && whole.folded == resumed.folded);
}

void target(std::string_view text) {
  const auto parsed = parse_target(text);
  for (const bool plus : {false, true}) {
    if (const auto decoded = percent_decode(text, plus)) {
      require(percent_decode(percent_encode(*decoded), plus) == *decoded);
    }
  }
  require(!parsed || parsed->query.size() <= text.size());
}

/// The content of a chunked body, however it is cut; "refused" where it is none.
std::string dechunked(std::string_view text, std::size_t piece) {
  ChunkedBody body;
  std::string content;
  std::string pending;
  std::size_t at = 0;
  while (!body.done()) {
    const auto step = body.step(pending);
    if (!step) {
      return "refused";
    }
    content += step->data;
    if (step->taken > 0) {
      pending.erase(0, step->taken);
      continue;
    }
    if (at >= text.size()) {
      return "unfinished " + content;
    }
    pending += text.substr(at, piece);
    at += piece;
  }
  return content;
}

/// The parts of a multipart body, and whether it ended.
std::string parts(std::string_view text, std::size_t piece) {
  std::string seen;
  MultipartReader reader("b", {[&seen](const std::string& name, const std::string& file) -> Status {
                                 seen += '[' + name + '|' + file + ']';
                                 return {};
                               },
                               [&seen](std::span<const std::byte> bytes) -> Status {
                                 seen.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
                                 return {};
                               }});
  for (std::size_t at = 0; at < text.size(); at += piece) {
    if (!reader.feed(std::as_bytes(std::span(text.substr(at, piece))))) {
      return "refused";
    }
  }
  return seen + (reader.finish() ? "." : "?");
}

void values(std::string_view text) {
  Request request;
  request.method = "GET";
  request.headers = {{"range", std::string(text)}, {"prefer", std::string(text)}, {"accept", std::string(text)}};
  constexpr std::uint64_t kSize = 1000;
  const WantedBytes wanted = wanted_bytes(request, kSize, "\"tag\"");
  require(wanted.kind != WantedBytes::Kind::Part ||
          (wanted.length > 0 && wanted.first < kSize && wanted.length <= kSize - wanted.first));
  if (const auto wait = preferred_wait(request)) {
    require(wait->count() >= 0 && wait->count() <= 60);
  }
  (void)negotiate(text, {"application/json", "text/csv"});
  (void)multipart_boundary(text);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 6) {
    case 0:
      guard(text);
      break;
    case 1:
      arrival(text);
      break;
    case 2:
      target(text);
      break;
    case 3:
      require(dechunked(text, 1) == dechunked(text, std::max<std::size_t>(text.size(), 1)));
      break;
    case 4:
      require(parts(text, 1) == parts(text, std::max<std::size_t>(text.size(), 1)));
      break;
    default:
      values(text);
  }
  return 0;
}
