#include "core/investigate/fullrate/modulation.hpp"

#include "core/investigate/fullrate/golden_section.hpp"
#include "core/investigate/slow/profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftlab::investigate {
namespace {

/// Bins of the drive signal. Chosen, not measured: within a bin the variance is taken as constant.
constexpr std::size_t kLevels = 60;

/// Squares are cut at 25 (a 5-sigma innovation): outliers are another cause, and a Gaussian loses 1e-5 of its variance.
double counted_square(double e) { return std::min(e * e, 25.0); }

struct Value {
  double log_likelihood = 0.0;
  double scale = 1.0;
};

Value evaluate(const Modulation& levels, bool scale_known, double x,
               const std::function<double(double, double)>& ratio) {
  double count = 0.0;
  double square = 0.0;
  double logs = 0.0;
  for (std::size_t j = 0; j < levels.u.size(); ++j) {
    const double v = std::max(1e-6, ratio(levels.u[j], x));
    count += levels.count[j];
    square += levels.square[j] / v;
    logs += levels.count[j] * std::log(v);
  }
  Value value;
  value.scale = scale_known ? 1.0 : square / std::max(1.0, count);
  value.log_likelihood = -0.5 * (logs + count * std::log(value.scale) + square / value.scale);
  return value;
}

}  // namespace

Modulation modulation_of(const FullRate& data,
                         const std::function<const Series*(const StudyRecording&, std::size_t axis)>& driver) {
  const std::size_t axis = data.group->role.quantity == Quantity::AngularRate ? data.group->axis() : 2;
  Modulation levels;
  for (std::size_t r = 0; r < data.members(); ++r) {
    const Series* const values = driver(*data.group->members[r].recording, axis);
    for (const double v : *values) {
      levels.largest = std::max(levels.largest, std::fabs(v));
    }
  }
  levels.u.assign(kLevels + 1, 0.0);
  levels.count.assign(kLevels + 1, 0.0);
  levels.square.assign(kLevels + 1, 0.0);
  if (!(levels.largest > 0.0)) {
    return levels;
  }
  for (std::size_t r = 0; r < data.members(); ++r) {
    const StudyRecording& recording = *data.group->members[r].recording;
    const Series& values = *driver(recording, axis);
    for (std::size_t i = 0; i < data.innovation[r].size(); ++i) {
      if (data.used[r][i] == 0) {
        continue;
      }
      const double u = values.empty() ? 0.0 : std::fabs(values[recording.begin + i]);
      const auto level = static_cast<std::size_t>(std::lround(u / levels.largest * kLevels));
      levels.u[level] += u;
      levels.count[level] += 1.0;
      levels.square[level] += counted_square(data.innovation[r][i]);
    }
  }
  for (std::size_t j = 0; j <= kLevels; ++j) {
    levels.distinct += levels.count[j] > 0.0 ? 1 : 0;
    levels.u[j] = levels.count[j] > 0.0 ? levels.u[j] / levels.count[j] : 0.0;
  }
  return levels;
}

Modulation modulation_of_scope(const FullRate& data, const std::vector<std::size_t>& scope) {
  Modulation levels;
  levels.u = {0.0, 1.0};
  levels.count = {0.0, 0.0};
  levels.square = {0.0, 0.0};
  levels.largest = 1.0;
  levels.distinct = 2;
  for (std::size_t r = 0; r < data.members(); ++r) {
    const std::size_t level = std::find(scope.begin(), scope.end(), r) != scope.end() ? 1 : 0;
    for (std::size_t i = 0; i < data.innovation[r].size(); ++i) {
      if (data.used[r][i] != 0) {
        levels.count[level] += 1.0;
        levels.square[level] += counted_square(data.innovation[r][i]);
      }
    }
  }
  return levels;
}

ModulationFit fit_modulation(const Modulation& levels, bool scale_known, double unit,
                             const std::function<double(double, double)>& ratio) {
  const auto at = [&](double x) { return evaluate(levels, scale_known, x, ratio).log_likelihood; };
  const double none = at(0.0);
  // A coarse walk over both signs, then golden section: the likelihood has one top.
  double best = 0.0;
  double top = none;
  for (const double size : {1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0, 3.0}) {
    for (const double sign : {-1.0, 1.0}) {
      const double l = at(sign * size * unit);
      if (l > top) {
        top = l;
        best = sign * size * unit;
      }
    }
  }
  const double low = best == 0.0 ? -1e-3 * unit : std::min(best * 0.2, best * 3.5);
  const double high = best == 0.0 ? 1e-3 * unit : std::max(best * 0.2, best * 3.5);
  ModulationFit fit;
  fit.value = golden_section(low, high, 50, at);
  const Value value = evaluate(levels, scale_known, fit.value, ratio);
  fit.scale = value.scale;
  fit.gain = 2.0 * (value.log_likelihood - none);
  const double infinity = std::numeric_limits<double>::infinity();
  const double step = std::max(1e-6 * unit, 0.3 * std::fabs(fit.value));
  fit.interval = {profile_end(fit.value, -step, value.log_likelihood, 3.8415, -infinity, at),
                  profile_end(fit.value, step, value.log_likelihood, 3.8415, infinity, at)};
  return fit;
}

Interval widened(const ModulationFit& fit, const FullRate& data) {
  const double factor = std::sqrt(data.repeatability);
  return {fit.value - factor * (fit.value - fit.interval.low), fit.value + factor * (fit.interval.high - fit.value)};
}

}  // namespace driftlab::investigate
