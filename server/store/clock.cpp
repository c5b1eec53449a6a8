#include "server/store/clock.hpp"

#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <mutex>
#include <tuple>
#include <utility>

namespace driftlab::server {
namespace {

/// Crockford's base32: no I, L, O, U.
constexpr std::string_view kAlphabet = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";
constexpr std::size_t kBodyLength = 26;
constexpr std::size_t kTimeLength = 10;

/// A number with at least `width` digits. Every line of the log has a time: printf would take most of it.
void append_padded(std::string& text, std::int64_t value, std::size_t width) {
  std::array<char, 24> digits{};
  const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), value < 0 ? -value : value);
  const auto length = static_cast<std::size_t>(written.ptr - digits.data());
  text.append(value < 0 ? 1 : 0, '-');
  text.append(width > length ? width - length : 0, '0');
  text.append(digits.data(), length);
}

/// What follows the time in an id: a number of 80 bits, most significant digit first.
using Tail = std::array<unsigned char, kBodyLength - kTimeLength>;

/// Random digits, drawn from the operating system for many ids at once: one call for each would cost more than the id.
/// Not thread safe.
class Digits {
 public:
  Tail next() {
    if (given_ + kOfOne > drawn_.size()) {
      if (RAND_bytes(drawn_.data(), static_cast<int>(drawn_.size())) != 1) {
        std::abort();  // an operating system without randomness cannot give unique names
      }
      given_ = 0;
    }
    Tail tail{};
    for (unsigned char& digit : tail) {
      digit = std::exchange(drawn_[given_++], static_cast<unsigned char>(0)) & 31U;
    }
    return tail;
  }

 private:
  static constexpr std::size_t kOfOne = std::tuple_size_v<Tail>;
  std::array<unsigned char, 64 * kOfOne> drawn_{};
  std::size_t given_ = drawn_.size();
};

/// Adds a random step of 1 to 2^30 to a tail: its successor sorts behind it and cannot be guessed.
void step(Tail& tail, Tail by) {
  constexpr std::size_t kStepDigits = 6;
  std::fill(by.begin(), by.end() - kStepDigits, static_cast<unsigned char>(0));
  unsigned carry = 1;
  for (std::size_t i = tail.size(); i-- > 0;) {
    const unsigned sum = tail[i] + by[i] + carry;
    tail[i] = static_cast<unsigned char>(sum & 31U);
    carry = sum >> 5U;
  }
}

/// Fresh for a new millisecond, behind the tail given last within the same one.
Tail next_tail(std::uint64_t milliseconds) {
  static std::mutex guard;
  static std::uint64_t last_milliseconds = 0;
  static Tail last{};
  static Digits digits;
  const std::scoped_lock lock(guard);
  if (milliseconds == last_milliseconds) {
    step(last, digits.next());
  } else {
    last_milliseconds = milliseconds;
    last = digits.next();
    last.front() &= 15U;  // the upper half is room for the steps, which therefore never overflow
  }
  return last;
}

std::uint64_t milliseconds_of(UtcMicros time) {
  return static_cast<std::uint64_t>(std::max<UtcMicros>(time, 0) / 1000);
}

/// What ids of one millisecond begin with. 26 characters hold 130 bits: the first ten are 48 bits of milliseconds (two
/// bits unused), the rest the tail.
std::string prefix_and_time(std::string_view prefix, std::uint64_t milliseconds) {
  std::string id(prefix);
  id.push_back('_');
  for (std::size_t i = 0; i < kTimeLength; ++i) {
    id.push_back(kAlphabet[(milliseconds >> (5 * (kTimeLength - 1 - i))) & 31U]);
  }
  return id;
}

}  // namespace

UtcMicros SystemClock::now() const {
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string rfc3339(UtcMicros time) {
  const std::chrono::sys_time<std::chrono::microseconds> instant{std::chrono::microseconds{time}};
  const auto day = std::chrono::floor<std::chrono::days>(instant);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss of_day{std::chrono::floor<std::chrono::milliseconds>(instant - day)};
  std::string text;
  text.reserve(sizeof "2026-11-21T08:30:00.123Z");
  append_padded(text, static_cast<int>(date.year()), 4);
  append_padded(text += '-', static_cast<unsigned>(date.month()), 2);
  append_padded(text += '-', static_cast<unsigned>(date.day()), 2);
  append_padded(text += 'T', of_day.hours().count(), 2);
  append_padded(text += ':', of_day.minutes().count(), 2);
  append_padded(text += ':', of_day.seconds().count(), 2);
  append_padded(text += '.', of_day.subseconds().count(), 3);
  return text += 'Z';
}

std::string first_id(std::string_view prefix, UtcMicros time) {
  std::string id = prefix_and_time(prefix, milliseconds_of(time));
  id.append(kBodyLength - kTimeLength, kAlphabet.front());
  return id;
}

std::string make_id(std::string_view prefix, UtcMicros now) {
  const std::uint64_t milliseconds = milliseconds_of(now);
  std::string id = prefix_and_time(prefix, milliseconds);
  for (const unsigned char digit : next_tail(milliseconds)) {
    id.push_back(kAlphabet[digit]);
  }
  return id;
}

bool is_id(std::string_view text, std::string_view prefix) {
  if (text.size() != prefix.size() + 1 + kBodyLength || !text.starts_with(prefix) || text[prefix.size()] != '_') {
    return false;
  }
  const std::string_view body = text.substr(prefix.size() + 1);
  return std::all_of(body.begin(), body.end(),
                     [](char letter) { return kAlphabet.find(letter) != std::string_view::npos; });
}

}  // namespace driftlab::server
