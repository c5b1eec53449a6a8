#include "server/store/s3/place.hpp"

#include "core/signal/text.hpp"

#include <boost/url/parse.hpp>
#include <boost/url/url_view.hpp>

#include <algorithm>

namespace driftlab::server::s3 {
namespace {

namespace urls = boost::urls;

constexpr std::uint16_t kHttps = 443;
constexpr std::uint16_t kHttp = 80;
constexpr std::size_t kLongestPrefix = 512;

tl::unexpected<Error> refuse(std::string sentence) {
  return fail(ErrorCode::InvalidArgument, std::move(sentence), {{"parameter", "blobs"}});
}

bool is_letter_or_digit(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

bool is_bucket_name(std::string_view text) {
  return text.size() >= 3 && text.size() <= 63 && is_letter_or_digit(text.front()) && is_letter_or_digit(text.back()) &&
         std::all_of(text.begin(), text.end(),
                     [](char c) { return is_letter_or_digit(c) || c == '-' || c == '.' || c == '_'; });
}

/// Words of letters, digits and `-._` between slashes: none is read as anything else by a shell, URL or file system.
bool is_prefix(std::string_view text) {
  const auto words = split(text, '/');
  return text.size() <= kLongestPrefix && std::all_of(words.begin(), words.end(), [](std::string_view word) {
           return !word.empty() && word.front() != '.' && std::all_of(word.begin(), word.end(), [](char c) {
             return is_letter_or_digit(c) || c == '-' || c == '.' || c == '_';
           });
         });
}

bool is_region(std::string_view text) {
  return !text.empty() && text.size() <= 64 &&
         std::all_of(text.begin(), text.end(), [](char c) { return is_letter_or_digit(c) || c == '-'; });
}

Status take_endpoint(const std::string& text, Place& place) {
  constexpr std::string_view kWritten = "must give an endpoint as https://HOST:PORT.";
  const auto parsed = urls::parse_uri(text);
  if (!parsed || parsed->has_userinfo() || parsed->has_query() || parsed->has_fragment() ||
      (!parsed->encoded_path().empty() && parsed->encoded_path() != "/")) {
    return refuse(std::string(kWritten));
  }
  const std::string scheme = lower_case(std::string_view(parsed->scheme().data(), parsed->scheme().size()));
  std::string host = parsed->host_address();
  if ((scheme != "https" && scheme != "http") || host.empty()) {
    return refuse(std::string(kWritten));
  }
  place.secure = scheme == "https";
  place.host = lower_case(host);
  place.port = parsed->has_port() ? parsed->port_number() : place.secure ? kHttps : kHttp;
  return place.port != 0 ? Status{} : refuse(std::string(kWritten));
}

}  // namespace

std::string Place::authority() const {
  const std::string name = host.find(':') == std::string::npos ? host : "[" + host + "]";
  return port == (secure ? kHttps : kHttp) ? name : name + ":" + std::to_string(port);
}

Result<Place> read_place(std::string_view text) {
  const auto parsed = urls::parse_uri(text);
  if (!parsed || parsed->has_fragment()) {
    return refuse("must be written s3://BUCKET/PREFIX?endpoint=https://HOST&region=NAME.");
  }
  if (parsed->has_userinfo()) {
    return refuse("must not hold a key; give that by --blobs-credentials or the environment.");
  }
  Place place;
  place.bucket = parsed->encoded_host();
  if (!is_bucket_name(place.bucket) || parsed->has_port()) {
    return refuse("must name a bucket, s3://BUCKET/PREFIX, of 3 to 63 letters, digits and hyphens.");
  }
  std::string prefix = parsed->path();
  prefix.erase(0, prefix.find_first_not_of('/'));
  prefix.erase(prefix.find_last_not_of('/') + 1);
  if (!prefix.empty()) {
    if (!is_prefix(prefix)) {
      return refuse("must have a prefix of words of letters, digits, '-', '_' and '.' between slashes.");
    }
    place.prefix = prefix + "/";
  }
  place.region = "us-east-1";
  std::string endpoint;
  for (const auto& parameter : parsed->params()) {
    std::string* const known = parameter.key == "endpoint" ? &endpoint
                               : parameter.key == "region" ? &place.region
                                                           : nullptr;
    if (known == nullptr) {
      return refuse("knows the parameters endpoint and region alone.");
    }
    *known = parameter.value;
  }
  if (!is_region(place.region)) {
    return refuse("must name a region by letters, digits and hyphens.");
  }
  if (endpoint.empty()) {
    endpoint = "https://s3." + place.region + ".amazonaws.com";
  }
  if (Status taken = take_endpoint(endpoint, place); !taken) {
    return fail(taken.error());
  }
  return place;
}

}  // namespace driftlab::server::s3
