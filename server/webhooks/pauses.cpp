#include "server/webhooks/pauses.hpp"

#include "server/store/webhook_store.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>

namespace driftlab::server {
namespace {

std::optional<int> digits(std::string_view text, std::size_t at, std::size_t count) {
  int value = 0;
  if (at + count > text.size()) {
    return std::nullopt;
  }
  const char* const end = text.data() + at + count;
  const auto [stop, error] = std::from_chars(text.data() + at, end, value);
  return error == std::errc{} && stop == end && value >= 0 ? std::optional(value) : std::nullopt;
}

/// `Sun, 06 Nov 1994 08:49:37 GMT` [s since 1970].
std::optional<std::int64_t> http_date(std::string_view text) {
  constexpr std::array<std::string_view, 12> kMonths{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                     "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  if (text.size() != 29 || !text.ends_with(" GMT") || text[3] != ',') {
    return std::nullopt;
  }
  const auto* const month = std::find(kMonths.begin(), kMonths.end(), text.substr(8, 3));
  const auto day = digits(text, 5, 2);
  const auto year = digits(text, 12, 4);
  const auto hour = digits(text, 17, 2);
  const auto minute = digits(text, 20, 2);
  const auto second = digits(text, 23, 2);
  if (month == kMonths.end() || !day || !year || !hour || !minute || !second) {
    return std::nullopt;
  }
  const std::chrono::year_month_day date{std::chrono::year{*year},
                                         std::chrono::month{static_cast<unsigned>(month - kMonths.begin()) + 1U},
                                         std::chrono::day{static_cast<unsigned>(*day)}};
  if (!date.ok()) {
    return std::nullopt;
  }
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return ((days * 24 + *hour) * 60 + *minute) * 60 + *second;
}

}  // namespace

std::int64_t draw_delivery_pause(int attempts, std::int64_t first_micros, std::mt19937_64& generator) {
  std::int64_t pause = std::min(first_micros, kLongestOwnPauseMicros);
  for (int i = 1; i < attempts && pause < kLongestOwnPauseMicros; ++i) {
    pause = std::min(pause * 6, kLongestOwnPauseMicros);
  }
  return std::uniform_int_distribution<std::int64_t>(pause / 2, pause)(generator);
}

std::optional<std::int64_t> retry_after_micros(std::string_view value, UtcMicros now) {
  constexpr std::int64_t kLongest = kLongestDeliveryPauseMicros;
  std::int64_t seconds = 0;
  const char* const end = value.data() + value.size();
  const auto [stop, error] = std::from_chars(value.data(), value.data() + value.size(), seconds);
  if (error == std::errc{} && stop == end) {
    return seconds < 0 ? std::nullopt : std::optional(std::min(seconds, kLongest / 1'000'000) * 1'000'000);
  }
  const auto moment = http_date(value);
  if (!moment || *moment * 1'000'000 <= now) {
    return std::nullopt;
  }
  return std::min(*moment * 1'000'000 - now, kLongest);
}

}  // namespace driftlab::server
