#include "core/investigate/study/time_grid.hpp"

#include "core/signal/gappy_samples.hpp"
#include "core/signal/left_out.hpp"
#include "core/signal/spacing.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace driftlab::investigate {
namespace {

constexpr std::size_t kLongestGrid = 10'000'000;  // where less than a third of it has samples

double median_step(std::span<const double> stamps) {
  std::vector<double> steps;
  steps.reserve(stamps.size());
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i] > stamps[i - 1]) {
      steps.push_back(stamps[i] - stamps[i - 1]);
    }
  }
  if (steps.empty()) {
    return 0.0;
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Slope and offset of stamps over places by least squares. `place` as in TimeGrid.
std::pair<double, double> line_through(std::span<const double> stamps, const TimeGrid& grid) {
  double mean_t = 0.0;
  double mean_p = 0.0;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    mean_t += stamps[i];
    mean_p += static_cast<double>(grid.place_of(i));
  }
  mean_t /= static_cast<double>(stamps.size());
  mean_p /= static_cast<double>(stamps.size());
  double cross = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const double p = static_cast<double>(grid.place_of(i)) - mean_p;
    cross += p * (stamps[i] - mean_t);
    square += p * p;
  }
  const double slope = cross / square;
  return {slope, mean_t - slope * mean_p};
}

/// Where each row lies on the grid: behind a gap, farther on by what it lacks. Empty where nothing is missing.
std::vector<std::size_t> places_of(std::size_t rows, const std::vector<Gap>& gaps) {
  std::vector<std::size_t> place;
  if (gaps.empty()) {
    return place;
  }
  place.reserve(rows);
  std::size_t lost = 0;
  auto gap = gaps.begin();
  for (std::size_t i = 0; i < rows; ++i) {
    for (; gap != gaps.end() && gap->row == i; ++gap) {
      lost += gap->missing;
    }
    place.push_back(i + lost);
  }
  return place;
}

/// The step of which all stamps are multiples, of those that decimal text has; 0 where there is none.
double stamp_resolution(std::span<const double> stamps) {
  for (const double step : {1.0, 0.1, 0.01, 1e-3, 1e-4, 1e-5, 1e-6}) {
    const bool fits = std::all_of(stamps.begin(), stamps.end(), [&](double t) {
      const double q = (t - stamps[0]) / step;
      return std::fabs(q - std::round(q)) < 1e-3;
    });
    if (fits) {
      return step;
    }
  }
  return 0.0;
}

/// Few long stretches are gaps between sessions and no habit of a clock, and so are stretches whose steps are those of
/// the stated rate.
Bursts bursts_of(std::span<const double> stamps, double typical, std::optional<double> rate_hz) {
  // Of the mean step: shorter ones are steps within a burst. kShare of them, and kFewest bursts, make a habit; a burst
  // is no longer than kLongest mean steps. Chosen, not measured; time_grid.hpp says what follows.
  constexpr double kShort = 0.25;
  constexpr double kShare = 0.2;
  constexpr std::size_t kFewest = 10;
  constexpr double kLongest = 200.0;
  if (rate_hz && std::fabs(typical * *rate_hz - 1.0) < kShare) {
    return {};
  }
  const auto steps = static_cast<double>(stamps.size() - 1);
  const double mean = (stamps.back() - stamps.front()) / steps;
  double within = 0.0;
  double square = 0.0;
  Bursts bursts;
  double length = 1.0;
  const auto end = [&] {
    ++bursts.count;
    square += length * length;
    length = 1.0;
  };
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    const bool joined = stamps[i] - stamps[i - 1] < kShort * mean;
    within += joined ? 1.0 : 0.0;
    if (joined) {
      length += 1.0;
    } else {
      end();
    }
  }
  end();
  const auto count = static_cast<double>(bursts.count);
  bursts.mean = static_cast<double>(stamps.size()) / count;
  if (within < kShare * steps || bursts.count < kFewest || bursts.mean > kLongest) {
    return {};
  }
  bursts.deviation = std::sqrt(std::max(0.0, square / count - bursts.mean * bursts.mean));
  return bursts;
}

}  // namespace

void TimeGrid::leave_out(std::span<const std::size_t> left_out, std::size_t rows) {
  if (left_out.empty()) {
    return;
  }
  if (place.empty()) {
    place.resize(rows);
    std::iota(place.begin(), place.end(), std::size_t{0});
  }
  place = without(std::span<const std::size_t>(place), left_out);
}

Result<TimeGrid> fit_time_grid(std::span<const double> stamps_s, std::optional<double> rate_hz) {
  const std::size_t rows = stamps_s.size();
  for (std::size_t i = 0; i < rows; ++i) {
    if (!std::isfinite(stamps_s[i])) {
      return fail(ErrorCode::NonFinite, "The time column holds a value that is not a finite number.",
                  {{"row", std::to_string(i + 1)}});
    }
    if (i > 0 && stamps_s[i] < stamps_s[i - 1]) {
      return fail(ErrorCode::NonMonotonicTime, "The time column steps back at sample " + std::to_string(i + 1) + ".",
                  {{"row", std::to_string(i + 1)}});
    }
  }
  const double typical = median_step(stamps_s);
  if (!(typical > 0.0)) {
    return fail(ErrorCode::InconsistentSampling, "The time column never advances.");
  }
  TimeGrid grid;
  grid.stamps.present = true;
  grid.stamps.resolution_s = stamp_resolution(stamps_s);
  for (std::size_t i = 1; i < rows; ++i) {
    grid.stamps.repeated += stamps_s[i] == stamps_s[i - 1] ? 1 : 0;
  }
  grid.stamps.bursts = bursts_of(stamps_s, typical, rate_hz);
  const bool bursts = grid.stamps.bursts.count > 0;
  const Spacing spacing = find_spacing(stamps_s, {}, rate_hz ? 1.0 / *rate_hz : 0.0);
  grid.dt_s = rate_hz ? 1.0 / *rate_hz : spacing.interval_s;
  if (!bursts) {
    grid.place = places_of(rows, spacing.gaps);
  }
  grid.length = grid.place_of(rows - 1) + 1;
  grid.stamps.missing = grid.length - rows;
  if (grid.stamps.missing == 0) {
    grid.place.clear();
  }
  if (grid.length > std::max(kLongestGrid, (1 + kMostMissingPerRow) * rows)) {
    return fail(ErrorCode::LimitExceeded,
                "The time column spans " + std::to_string(grid.length) + " sample intervals and has " +
                    std::to_string(rows) + " samples: make a recording of each part.",
                {{"rows", std::to_string(rows)}});
  }
  const auto [slope, offset] = line_through(stamps_s, grid);
  double square = 0.0;
  for (std::size_t i = 0; i < rows; ++i) {
    const double residual = stamps_s[i] - offset - slope * static_cast<double>(grid.place_of(i));
    square += residual * residual;
  }
  const double own = grid.stamps.resolution_s * grid.stamps.resolution_s / 12.0;
  grid.stamps.scatter_s = std::sqrt(std::max(0.0, square / static_cast<double>(rows) - own));
  if (bursts || std::fabs(slope * (rate_hz ? *rate_hz : 1.0 / slope) - 1.0) > 1e-5) {
    grid.dt_s = slope;
  }
  return grid;
}

}  // namespace driftlab::investigate
