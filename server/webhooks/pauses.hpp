#pragma once
/// How long a delivery waits for its next attempt.
#include "server/store/clock.hpp"

#include <cstdint>
#include <optional>
#include <random>
#include <string_view>

namespace driftlab::server {

/// The longest pause that driftlab takes by itself.
inline constexpr std::int64_t kLongestOwnPauseMicros = 6LL * 3600 * 1'000'000;

/// The pause after the n-th failed attempt (n >= 1) [us]: `first` * 6^(n-1), at most 6 h; drawn between half of that
/// and all of it, so that messages that failed together do not come back together.
[[nodiscard]] std::int64_t draw_delivery_pause(int attempts, std::int64_t first_micros, std::mt19937_64& generator);

/// What a Retry-After asks for [us from now]: a number of seconds, or a date as in RFC 9110 section 5.6.7
/// (IMF-fixdate). At most a day; nothing for what is neither, or is in the past.
[[nodiscard]] std::optional<std::int64_t> retry_after_micros(std::string_view value, UtcMicros now);

}  // namespace driftlab::server
