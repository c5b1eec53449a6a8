#pragma once
/// The refusal of a recording whose samples lie nowhere in time, said alike by every use of a recording.
#include "core/signal/guess_time.hpp"
#include "core/signal/number.hpp"
#include "core/signal/result.hpp"

namespace driftlab {

/// Of a recording with neither a time column nor a stated rate; `guess`: a column that looks like one.
[[nodiscard]] inline tl::unexpected<Error> neither_time_nor_rate(const std::optional<TimeGuess>& guess = {}) {
  std::string message =
      "There is no time column and no stated rate: give rate_hz, or name the time column (columns NAME=time:s).";
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

}  // namespace driftlab
