#include "core/signal/time_column.hpp"

#include "core/signal/missing.hpp"
#include "core/signal/number.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace driftlab {
namespace {

/// One row in this many may step back.
constexpr std::size_t kRowsPerStepBack = 1000;

/// Where counters start again, in their own ticks: 16 and 32 bits, and 32 bits of us or ms written in a unit 1000 times
/// larger.
constexpr std::array kWraps{4294967296.0, 65536.0, 4294967.296, 4294.967296};

double median_forward_step(std::span<const double> column) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < column.size(); ++i) {
    if (column[i] > column[i - 1]) {
      steps.push_back(column[i] - column[i - 1]);
    }
  }
  if (steps.empty()) {
    return 0.0;
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// What has to be added from this row on, because a counter started again; 0 if none did.
double wrap_between(double before, double after, double median_step) {
  for (const double wrap : kWraps) {
    const double step = after + wrap - before;
    if (before < wrap && after >= 0.0 && step > 0.0 && step <= 5.0 * median_step) {
      return wrap;
    }
  }
  return 0.0;
}

Status check_finite(std::span<const double> column) {
  const auto bad = std::find_if(column.begin(), column.end(), [](double value) { return !std::isfinite(value); });
  if (bad == column.end()) {
    return {};
  }
  const std::uint64_t sample = static_cast<std::uint64_t>(bad - column.begin()) + 1;
  const std::uint64_t stated = std::isnan(*bad) ? why_missing(*bad).row : 0;
  return fail(ErrorCode::NonFinite, "Sample " + std::to_string(sample) + " of the time column is not a finite number.",
              {{"row", std::to_string(stated != 0 ? stated : sample)}});
}

}  // namespace

double TimeColumn::advanced_s() const {
  double sum = stamps.back() - stamps.front();
  for (const std::size_t row : backward) {
    sum += stamps[row - 1] - stamps[row];
  }
  return sum;
}

Result<TimeColumn> read_time_column(std::span<const double> column, const Unit& unit) {
  if (auto status = check_finite(column); !status) {
    return fail(status.error());
  }
  const bool falls = !std::is_sorted(column.begin(), column.end());
  const double median_step = falls ? median_forward_step(column) : 0.0;
  TimeColumn time;
  time.stamps.resize(column.size());
  double carried = 0.0;
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (i > 0 && column[i] < column[i - 1]) {
      const double wrap = wrap_between(column[i - 1], column[i], median_step);
      carried += wrap;
      time.wraps += wrap > 0.0 ? 1 : 0;
      if (wrap == 0.0) {
        time.backward.push_back(i);
        time.largest_step_back_s =
            std::max(time.largest_step_back_s, unit.to_si(column[i - 1]) - unit.to_si(column[i]));
      }
    }
    time.stamps[i] = unit.to_si(column[i] + carried);
  }
  if (time.backward.size() * kRowsPerStepBack >= column.size()) {
    if (!time.backward.empty()) {
      const std::size_t row = time.backward.front();
      const std::size_t more = time.backward.size() - 1;
      std::string sentence = "The time column steps back by " + short_text(time.stamps[row - 1] - time.stamps[row]) +
                             " s at sample " + std::to_string(row + 1);
      sentence += more == 0 ? "" : " and " + with_count(more, "more time", "more times");
      sentence += "; sort the rows, or leave the time column out (name the others with columns) and state the rate.";
      return fail(ErrorCode::NonMonotonicTime, sentence, {{"row", std::to_string(row + 1)}});
    }
  }
  return time;
}

}  // namespace driftlab
