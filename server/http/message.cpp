#include "server/http/message.hpp"

#include "core/signal/number.hpp"
#include "core/signal/text.hpp"
#include "server/http/names.hpp"

#include <boost/url/pct_string_view.hpp>

#include <algorithm>
#include <charconv>

namespace driftlab::server {
namespace {

/// How specifically a media range names a type: 3 exact, 2 type/*, 1 */*, 0 not at all.
int specificity(std::string_view range, std::string_view type) {
  if (same_name(range, type)) {
    return 3;
  }
  if (range == "*/*") {
    return 1;
  }
  const std::size_t slash = type.find('/');
  const bool family =
      range.size() == slash + 2 && range.ends_with("/*") && same_name(range.substr(0, slash), type.substr(0, slash));
  return family ? 2 : 0;
}

struct MediaRange {
  std::string_view range;
  double quality = 1.0;
};

std::vector<MediaRange> parse_accept(std::string_view accept) {
  std::vector<MediaRange> ranges;
  for (const std::string_view entry : split(accept, ',')) {
    const std::vector<std::string_view> parts = split(entry, ';');
    MediaRange range;
    range.range = trimmed(parts.front());
    for (const std::string_view part : parts) {
      if (trimmed(part).starts_with("q=")) {
        range.quality = parse_double(trimmed(part).substr(2)).value_or(0.0);
      }
    }
    ranges.push_back(range);
  }
  return ranges;
}

}  // namespace

std::optional<std::string_view> Request::header(std::string_view name) const {
  for (const auto& [key, value] : headers) {
    if (key == name) {
      return value;
    }
  }
  return std::nullopt;
}

std::optional<std::string_view> Request::parameter(std::string_view name) const {
  for (const auto& [key, value] : query) {
    if (key == name) {
      return value;
    }
  }
  return std::nullopt;
}

bool Response::has_header(std::string_view name) const {
  return std::any_of(headers.begin(), headers.end(), [&](const auto& header) { return same_name(header.first, name); });
}

std::optional<std::chrono::seconds> preferred_wait(const Request& request) {
  constexpr std::string_view kWait = "wait=";
  constexpr int kLongest = 60;
  const std::string_view prefer = request.header("prefer").value_or("");
  const std::size_t at = prefer.find(kWait);
  if (at == std::string_view::npos) {
    return std::nullopt;
  }
  int seconds = 0;
  const std::string_view digits = prefer.substr(at + kWait.size());
  std::from_chars(digits.data(), digits.data() + digits.size(), seconds);
  return std::chrono::seconds(std::clamp(seconds, 0, kLongest));
}

std::optional<std::string_view> negotiate(std::optional<std::string_view> accept,
                                          const std::vector<std::string_view>& offered) {
  if (!accept || trimmed(*accept).empty()) {
    return offered.front();
  }
  const std::vector<MediaRange> ranges = parse_accept(*accept);
  std::optional<std::string_view> best;
  double best_quality = 0.0;
  for (const std::string_view type : offered) {
    int closest = 0;
    double quality = 0.0;
    for (const MediaRange& range : ranges) {
      if (const int match = specificity(range.range, type); match > closest) {
        closest = match;
        quality = range.quality;
      }
    }
    if (quality > best_quality) {
      best = type;
      best_quality = quality;
    }
  }
  return best;
}

std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space) {
  const bool as_it_is =
      text.find('%') == std::string_view::npos && (!plus_is_space || text.find('+') == std::string_view::npos);
  if (as_it_is) {
    return std::string(text);  // as most are
  }
  const auto encoded = boost::urls::make_pct_string_view(boost::core::string_view(text.data(), text.size()));
  if (!encoded) {
    return std::nullopt;
  }
  boost::urls::encoding_opts options;
  options.space_as_plus = plus_is_space;
  return encoded->decode(options);
}

std::string percent_encode(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string encoded;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~").find(c) != std::string_view::npos;
    if (plain) {
      encoded += c;
    } else {
      encoded += {'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
    }
  }
  return encoded;
}

std::optional<Target> parse_target(std::string_view target) {
  if (target.empty() || target.front() != '/') {
    return std::nullopt;
  }
  Target result;
  const std::size_t mark = std::min(target.find('?'), target.size());
  auto path = percent_decode(target.substr(0, mark), false);
  if (!path || path->find('\0') != std::string::npos) {
    return std::nullopt;
  }
  result.path = std::move(*path);
  const std::string_view query = mark < target.size() ? target.substr(mark + 1) : std::string_view{};
  for (const std::string_view pair : split(query, '&')) {
    if (pair.empty()) {
      continue;
    }
    const std::size_t equals = std::min(pair.find('='), pair.size());
    auto name = percent_decode(pair.substr(0, equals), true);
    auto value = percent_decode(equals < pair.size() ? pair.substr(equals + 1) : std::string_view{}, true);
    if (!name || !value) {
      return std::nullopt;
    }
    result.query.emplace_back(std::move(*name), std::move(*value));
  }
  return result;
}

}  // namespace driftlab::server
