#pragma once
/// The refusal of a recording whose samples lie nowhere in time, or at two rates, said alike by every use of a
/// recording.
#include "core/signal/guess_time.hpp"
#include "core/signal/number.hpp"
#include "core/signal/result.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace driftlab {

/// Stated and measured rates may differ by this much: more is another rate, not a clock error.
inline constexpr double kRateTolerance = 0.01;

/// Of a recording with neither a time column nor a stated rate; `guess`: a column that looks like one; `of_text`: one
/// that is the time by its name and holds text.
[[nodiscard]] inline tl::unexpected<Error> neither_time_nor_rate(const std::optional<TimeGuess>& guess = {},
                                                                 const std::string& of_text = {}) {
  std::string message =
      of_text.empty()
          ? "There is no time column and no stated rate: give rate_hz, or name the time column (columns NAME=time:s)."
          : "The cells of column '" + of_text +
                "' are text that is not read as time, and there is no stated rate: give rate_hz, or name another time "
                "column (columns NAME=time:s). Read as time are numbers, dates such as 2025-03-01 23:59:50.5 or "
                "2025/03/01T23:59:50Z, and times of day such as 23:59:50.5.";
  if (guess) {
    message += " Column '" + guess->column + "' rises as a time at " + short_text(guess->rate_hz) +
               " Hz does: " + guess->column + "=time:" + guess->unit.symbol + ".";
  }
  return fail(ErrorCode::InconsistentSampling, std::move(message), {{"parameter", "rate_hz"}});
}

/// Of a time column `column` whose unit nobody says, without a stated rate; `guess`: the unit that its steps speak for.
[[nodiscard]] inline tl::unexpected<Error> time_without_unit(const std::string& column,
                                                             const std::optional<TimeGuess>& guess = {}) {
  std::string message = "The time column '" + column + "' has no unit and no rate is stated: give its unit (columns " +
                        column + "=time:s, or ms, us, ns) or rate_hz.";
  if (guess && guess->column == column) {
    message += " In " + guess->unit.symbol + " its rate would be " + short_text(guess->rate_hz) + " Hz.";
  }
  return fail(ErrorCode::InconsistentSampling, std::move(message), {{"parameter", "rate_hz"}, {"column", column}});
}

/// Of a stated rate and a time column that differ by more than kRateTolerance. A column without a unit was read in
/// seconds; another unit in which it would agree is named.
[[nodiscard]] inline tl::unexpected<Error> rates_disagree(double stated_hz, double measured_hz, bool unit_known) {
  std::string message = "The stated rate is " + short_text(stated_hz) + " Hz, but the time column" +
                        (unit_known ? "" : ", read in seconds,") + " says " + short_text(measured_hz) + " Hz.";
  if (unit_known) {
    message += " Leave the rate out to go by the time column.";
  } else {
    for (const auto& [symbol, per_second] : {std::pair{"ms", 1e3}, std::pair{"us", 1e6}, std::pair{"ns", 1e9}}) {
      if (std::abs(measured_hz * per_second / stated_hz - 1.0) <= kRateTolerance) {
        message += " In " + std::string(symbol) + " it would agree: state that unit.";
      }
    }
  }
  return fail(
      ErrorCode::InconsistentSampling, std::move(message),
      {{"parameter", "rate_hz"}, {"stated_hz", short_text(stated_hz)}, {"measured_hz", short_text(measured_hz)}});
}

}  // namespace driftlab
