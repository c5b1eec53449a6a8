#include "core/signal/sample_grid.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kFewestRows = 100;
constexpr double kMostLost = 0.7;
constexpr double kMostLostStated = 0.6;  ///< more is not analysed as one recording (core/signal/stretch.hpp)
constexpr double kExact = 0.8;           ///< mean phase of steps that err by a tenth of an interval
constexpr double kStatedLonger = 1.5;    ///< median steps of this many stated intervals are more than one
constexpr double kLeastOdd = 0.005;      ///< of the steps are no multiple of each small factor
constexpr double kStatedAgrees = 0.01;
constexpr std::size_t kPhaseRows = 256;
/// The same of stamps within the phase rows: 0.64 for errors of 0.15 intervals, near 0 for a clock whose errors add up.
constexpr double kLeastHeld = 0.5;
/// Length of the mean phase of the steps: exp(-(2 pi s)^2 / 2) for errors of s intervals, 0.42 for stamps of 0.15.
constexpr double kLeastConcentration = 0.35;
constexpr double kMostTooShort = 0.02;  ///< of the steps may be nearer to none than to one interval
/// Variance of the time of 64 rows over that of 64 independent steps: 1 for samples lost at random, 0.5 for one in
/// twenty lost beside stamps that err by 0.15 intervals, below 0.02 where nothing is lost.
constexpr double kIndependent = 0.25;
constexpr std::size_t kWindowRows = 64;
constexpr double kLongGap = 64.0;  ///< intervals; what a gap lasts beyond says nothing about the others

/// Steps up to `longest` intervals over the intervals they hold; the interval as it was where that is none.
double refined(std::span<const double> steps, double interval, double longest) {
  double sum = 0.0;
  double intervals = 0.0;
  for (const double step : steps) {
    if (step <= longest * interval) {
      sum += step;
      intervals += std::round(step / interval);
    }
  }
  return intervals > 0.0 ? sum / intervals : interval;
}

/// Mean of the steps up to 1.5 intervals: those of one.
double single_step(std::span<const double> steps, double interval) {
  double sum = 0.0;
  double count = 0.0;
  for (const double step : steps) {
    if (step <= 1.5 * interval) {
      sum += step;
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : interval;
}

double find_interval(std::span<const double> steps, double start) {
  constexpr int kMostRounds = 20;
  double interval = start;
  for (int round = 0; round < kMostRounds; ++round) {
    const double next = single_step(steps, interval);
    if (next == interval) {
      break;
    }
    interval = next;
  }
  for (const double longest : {2.5, 4.5, 16.5, 128.5, std::numeric_limits<double>::infinity()}) {
    interval = refined(steps, interval, longest);
  }
  return interval;
}

/// Length of the mean phase of the steps where they are whole multiples of `interval`, hardly ever none, and most
/// samples are there; else 0.
double concentration(std::span<const double> steps, double interval, double most_lost = kMostLost) {
  if (!(interval > 0.0)) {
    return 0.0;
  }
  std::complex<double> phase;
  double held = 0.0;
  double too_short = 0.0;
  for (const double step : steps) {
    const double count = step / interval;
    phase += std::polar(1.0, 2.0 * std::numbers::pi * count);
    held += std::min(std::round(count), kLongGap);
    too_short += count < 0.5 ? 1.0 : 0.0;
  }
  const auto all = static_cast<double>(steps.size());
  const bool sound = too_short <= kMostTooShort * all && held - all <= most_lost * held;
  return sound ? std::abs(phase) / all : 0.0;
}

/// The interval of which the steps are best multiples. The median step is one interval while less than half is lost;
/// the shortest fifth are single steps until four fifths are.
std::optional<double> best_interval(std::span<const double> steps, double typical_s) {
  std::vector<double> sorted(steps.begin(), steps.end());
  const auto fifth = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 5);
  std::nth_element(sorted.begin(), fifth, sorted.end());
  double best = 0.0;
  double most = 0.0;
  for (const double start : {typical_s, *fifth}) {
    const double interval = find_interval(steps, start);
    const double length = concentration(steps, interval);
    if (length > most) {
      most = length;
      best = interval;
    }
  }
  return most >= kLeastConcentration ? std::optional(best) : std::nullopt;
}

/// Whether all steps but a few are multiples of twice, three times, ... the interval: it is then stated too short.
bool share_a_factor(std::span<const double> steps, double interval) {
  for (const std::int64_t factor : {2, 3, 5, 7}) {
    std::size_t others = 0;
    for (const double step : steps) {
      others += std::llround(step / interval) % factor == 0 ? 0 : 1;
    }
    if (static_cast<double>(others) < kLeastOdd * static_cast<double>(steps.size())) {
      return true;
    }
  }
  return false;
}

/// Whether long steps are not made up for by short ones. The squares are limited, so that one long gap decides nothing.
bool independent(std::span<const double> steps, double interval) {
  const double longest = kLongGap * interval;
  const auto clipped = [&](double step) { return std::min(step, longest); };
  double mean = 0.0;
  for (const double step : steps) {
    mean += clipped(step);
  }
  mean /= static_cast<double>(steps.size());
  double single = 0.0;
  double together = 0.0;
  double windows = 0.0;
  double window = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double off = clipped(steps[i]) - mean;
    single += off * off;
    window += off;
    if ((i + 1) % kWindowRows == 0) {
      together += window * window;
      windows += 1.0;
      window = 0.0;
    }
  }
  single /= static_cast<double>(steps.size());
  return windows > 0.0 && together / windows >= kIndependent * static_cast<double>(kWindowRows) * single;
}

/// The non-decreasing integers nearest to `values` in the sum of absolute deviations.
std::vector<std::int64_t> nearest_staircase(const std::vector<std::int64_t>& values) {
  std::priority_queue<std::int64_t> slopes;
  std::vector<std::int64_t> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    slopes.push(values[i]);
    if (slopes.top() > values[i]) {
      slopes.pop();
      slopes.push(values[i]);
    }
    result[i] = slopes.top();
  }
  for (std::size_t i = values.size(); i-- > 1;) {
    result[i - 1] = std::min(result[i - 1], result[i]);
  }
  return result;
}

/// Rows laid on the grid.
struct Placed {
  SampleGrid grid;
  double held = 0.0;  ///< length of the mean phase of the stamps about that of their 256 rows
};

/// Places the rows of all parts between steps back.
class Placement {
 public:
  explicit Placement(double interval) : interval_(interval) {}

  /// A part without steps back, which starts at `row`.
  void take(std::span<const double> stamps, std::size_t row) {
    const std::vector<std::int64_t> lost = nearest_staircase(rounded_stairs(stamps));
    for (std::size_t i = 1; i < lost.size(); ++i) {
      if (lost[i] > lost[i - 1]) {
        placed_.grid.gaps.push_back({row + i, static_cast<std::size_t>(lost[i] - lost[i - 1])});
      }
    }
    time_ += stamps.back() - stamps.front();
    places_ += static_cast<double>(stamps.size() - 1) + static_cast<double>(lost.back() - lost.front());
    rows_ += static_cast<double>(stamps.size());
  }

  Placed result() && {
    placed_.grid.interval_s = places_ > 0.0 ? time_ / places_ : interval_;
    placed_.held /= rows_;
    return std::move(placed_);
  }

 private:
  /// Stamps in intervals, less row number and phase, as whole numbers.
  std::vector<std::int64_t> rounded_stairs(std::span<const double> stamps) {
    std::vector<double> stairs(stamps.size());
    for (std::size_t i = 0; i < stamps.size(); ++i) {
      stairs[i] = (stamps[i] - stamps.front()) / interval_ - static_cast<double>(i);
    }
    std::vector<std::int64_t> rounded(stamps.size());
    double phase = 0.0;
    for (std::size_t first = 0; first < stairs.size(); first += kPhaseRows) {
      const std::size_t last = std::min(first + kPhaseRows, stairs.size());
      std::complex<double> sum;
      for (std::size_t i = first; i < last; ++i) {
        sum += std::polar(1.0, 2.0 * std::numbers::pi * (stairs[i] - phase));
      }
      placed_.held += std::abs(sum);
      phase += std::arg(sum) / (2.0 * std::numbers::pi);
      for (std::size_t i = first; i < last; ++i) {
        rounded[i] = std::llround(stairs[i] - phase);
      }
    }
    return rounded;
  }

  double interval_;
  Placed placed_;
  double time_ = 0.0;
  double places_ = 0.0;
  double rows_ = 0.0;
};

Placed place_rows(std::span<const double> stamps, std::span<const std::size_t> backward, double interval) {
  Placement placement(interval);
  std::size_t first = 0;
  for (const std::size_t row : backward) {
    placement.take(stamps.subspan(first, row - first), first);
    first = row;
  }
  placement.take(stamps.subspan(first), first);
  return std::move(placement).result();
}

}  // namespace

std::optional<SampleGrid> find_sample_grid(std::span<const double> stamps, std::span<const std::size_t> backward,
                                           std::span<const double> steps, double typical_s, double stated_s) {
  if (stamps.size() < kFewestRows || steps.size() < kFewestRows / 2 || !(typical_s > 0.0)) {
    return std::nullopt;
  }
  const std::optional<double> interval = best_interval(steps, typical_s);
  if (!interval) {
    return std::nullopt;
  }
  const bool stated = stated_s > 0.0 && std::abs(*interval / stated_s - 1.0) <= kStatedAgrees;
  if (!stated && !independent(steps, *interval)) {
    return std::nullopt;
  }
  const Placed rough = place_rows(stamps, backward, *interval);
  if (rough.held < kLeastHeld) {
    return std::nullopt;
  }
  return place_rows(stamps, backward, rough.grid.interval_s).grid;
}

std::optional<SampleGrid> find_stated_grid(std::span<const double> stamps, std::span<const std::size_t> backward,
                                           std::span<const double> steps, double typical_s, double stated_s) {
  if (stamps.size() < kFewestRows || steps.size() < kFewestRows / 2 || !(stated_s > 0.0) ||
      typical_s < kStatedLonger * stated_s) {
    return std::nullopt;
  }
  const double interval = refined(steps, stated_s, kLongGap);
  const bool agrees = std::abs(interval / stated_s - 1.0) <= kStatedAgrees;
  if (!agrees || concentration(steps, interval, kMostLostStated) < kExact || share_a_factor(steps, interval) ||
      !independent(steps, interval)) {
    return std::nullopt;
  }
  const Placed rough = place_rows(stamps, backward, interval);
  if (rough.held < kExact) {
    return std::nullopt;
  }
  return place_rows(stamps, backward, rough.grid.interval_s).grid;
}

}  // namespace driftlab
