#pragma once
/// A departure of the innovations from white noise, as one test finds it (remains.hpp, dependence.hpp).
#include <charconv>
#include <string>
#include <system_error>

namespace driftlab::investigate {

/// Departures with a p_study below this level are reported.
inline constexpr double kShown = 0.003;

/// Below this one a departure may take a finding back. Chosen well below the level of a check, not measured.
inline constexpr double kClear = 0.001;

/// One departure.
struct Remainder {
  std::string id;  ///< of its check
  std::string recording;
  std::string channel;
  double observed = 0.0;  ///< the exponent: -ln of the chance at that place
  double places = 1.0;
  double p_study = 1.0;
  bool in_time_or_frequency = false;  ///< bursts, lines and changes: what a named cause should have taken away
  bool of_power_alone = false;        ///< a mean, however it moves, does not show in it
  double period_s = 0.0;              ///< of power that swells and fades; 0: it does not
  bool follows_changes = false;       ///< noise that changes in time shows in it too: told where nothing changes
  std::string sentence;               ///< where it is, in words
};

/// For a sentence.
[[nodiscard]] inline std::string three_digits(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 3);
  return error == std::errc{} ? std::string(buffer, end) : std::string("?");
}

}  // namespace driftlab::investigate
