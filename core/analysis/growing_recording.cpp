#include "core/analysis/growing_recording.hpp"

#include "core/variance/haar_covariance.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/variance_intervals.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace driftlab {
namespace {

constexpr std::size_t kFewestInRun = 16;
constexpr double kGap = 1.5;
constexpr double kStillSeconds = 3.0;
constexpr double kStillRate = 0.02;  // rad/s
constexpr double kStillForce = 0.3;  // m/s^2
constexpr double kReadAt = 1.0;
constexpr double kSlopeTolerance = 0.12;

std::optional<double> median_step(std::span<const double> time_s) {
  if (time_s.size() < 3) {
    return std::nullopt;
  }
  std::vector<double> steps(time_s.size() - 1);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    steps[i] = time_s[i + 1] - time_s[i];
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle > 0.0 ? std::optional(*middle) : std::nullopt;
}

/// The longest run of finite values without a gap, and how many gaps there are.
std::span<const double> longest_run(std::span<const double> time_s, std::span<const double> values, double dt_s,
                                    std::size_t& gaps) {
  std::span<const double> best;
  std::size_t first = 0;
  for (std::size_t i = 0; i <= values.size(); ++i) {
    const bool missing = i < values.size() && !std::isfinite(values[i]);
    const bool jump = i > 0 && i < values.size() && time_s[i] - time_s[i - 1] > kGap * dt_s;
    gaps += jump || (missing && i > first) ? 1 : 0;
    if (missing || jump || i == values.size()) {
      if (i - first > best.size()) {
        best = values.subspan(first, i - first);
      }
      first = missing ? i + 1 : i;
    }
  }
  return best;
}

/// Reads N off the deviation.
void read_n(GrowingRecording& look) {
  look.n_reason = "The recording is too short to read N off.";
  for (std::size_t j = look.tau_s.size(); j-- > 0;) {
    if (look.tau_s[j] > kReadAt * 1.001 || j + 1 >= look.tau_s.size() || j == 0) {
      continue;
    }
    const double slope = std::log2(look.deviation[j + 1] / look.deviation[j - 1]) / 2.0;
    if (std::abs(slope + 0.5) < kSlopeTolerance) {
      const double root = std::sqrt(look.tau_s[j]);
      look.n = Estimate{look.deviation[j] * root, {look.ci95[j].low * root, look.ci95[j].high * root}};
      look.n_reason.clear();
      return;
    }
    look.n_reason = "The slope of the deviation is not that of white noise at any time up to 1 s.";
  }
}

}  // namespace

GrowingRecording look_at_growth(std::span<const double> time_s, std::span<const double> values) {
  GrowingRecording look;
  look.samples = values.size();
  look.seconds = time_s.empty() ? 0.0 : time_s.back() - time_s.front();
  look.n_reason = "The recording is too short to read N off.";
  const auto dt_s = median_step(time_s);
  if (!dt_s) {
    return look;
  }
  look.rate_hz = 1.0 / *dt_s;
  const std::span<const double> run = longest_run(time_s, values, *dt_s, look.gaps);
  if (run.size() < kFewestInRun) {
    return look;
  }
  const double mean = std::accumulate(run.begin(), run.end(), 0.0) / static_cast<double>(run.size());
  const HaarVariance curve = haar_variance(run, mean);
  if (std::none_of(curve.variance.begin(), curve.variance.end(), [](double v) { return v > 0.0; })) {
    look.n_reason = "All values are equal.";
    return look;
  }
  HaarCovariance plan(curve.half, curve.samples, *dt_s);
  const VarianceIntervals intervals = variance_intervals(curve, plan);
  for (std::size_t j = 0; j < curve.scales(); ++j) {
    const auto allan = [](double haar) { return std::sqrt(2.0 * std::max(haar, 0.0)); };
    look.tau_s.push_back(static_cast<double>(curve.half[j]) * *dt_s);
    look.deviation.push_back(allan(curve.variance[j]));
    look.ci95.push_back({allan(intervals.ci95[j].low), allan(intervals.ci95[j].high)});
  }
  const std::size_t next = 4 * curve.half.back();  // samples that the next octave needs
  look.next_tau_s = 2.0 * look.tau_s.back();
  look.next_in_s = next > run.size() ? static_cast<double>(next - run.size()) * *dt_s : 0.0;
  read_n(look);
  return look;
}

double still_deviation(Dimension dimension) {
  return dimension == Dimension::AngularRate ? kStillRate : dimension == Dimension::SpecificForce ? kStillForce : 0.0;
}

std::optional<bool> lies_still(std::span<const double> time_s, std::span<const double> values, const Unit& unit) {
  const double limit = still_deviation(unit.dimension);
  std::size_t first = time_s.size();
  while (first > 0 && time_s[first - 1] > time_s.back() - kStillSeconds) {
    --first;
  }
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = first; i < values.size(); ++i) {
    if (std::isfinite(values[i])) {
      const double value = (values[i] - values[first]) * unit.factor;
      sum += value;
      squares += value * value;
      count += 1.0;
    }
  }
  if (limit == 0.0 || count < 10.0 || !std::isfinite(values[first])) {
    return std::nullopt;
  }
  return squares / count - (sum / count) * (sum / count) < limit * limit;
}

}  // namespace driftlab
