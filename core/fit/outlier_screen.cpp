#include "core/fit/outlier_screen.hpp"

#include "core/signal/median.hpp"
#include "core/variance/window_medians.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace driftlab {
namespace {

constexpr double kPatchLimit = 5.5;
constexpr double kClip = 5.0;
constexpr std::size_t kLooks = 2000;  ///< places at which predictors are compared
constexpr std::size_t kPoll = 1U << 18U;
constexpr std::size_t kWindowsToPoll = 4096;

double median_of(std::vector<double>& values) { return values.empty() ? 0.0 : take_median(values); }

/// Robust standard deviation about 0 of at most some 40,000 of the values.
double robust_sd(std::span<const double> values) {
  const std::size_t stride = std::max<std::size_t>(1, values.size() / 40000);
  std::vector<double> magnitudes;
  magnitudes.reserve(values.size() / stride + 1);
  for (std::size_t i = 0; i < values.size(); i += stride) {
    magnitudes.push_back(std::fabs(values[i]));
  }
  return kGaussianOfMedian * median_of(magnitudes);
}

/// What the neighbours within `reach` say about a sample.
class Predictor {
 public:
  explicit Predictor(std::span<const double> samples) : samples_(samples) {}

  /// Mean of the two neighbours, or the one there is.
  [[nodiscard]] double neighbours(std::size_t t) const {
    const std::size_t last = samples_.size() - 1;
    if (last == 0) {
      return samples_[0];
    }
    return t == 0 ? samples_[1] : (t == last ? samples_[last - 1] : 0.5 * (samples_[t - 1] + samples_[t + 1]));
  }

  /// Median of the samples within `reach`, the sample itself left out.
  double around(std::size_t t, std::size_t reach) {
    if (reach == 2 && t >= 2 && t + 2 < samples_.size()) {  // the four neighbours: mean of the middle two
      const auto [low, high] = std::minmax(samples_[t - 2], samples_[t - 1]);
      const auto [other_low, other_high] = std::minmax(samples_[t + 1], samples_[t + 2]);
      const auto [second, third] = std::minmax(std::max(low, other_low), std::min(high, other_high));
      return 0.5 * (second + third);
    }
    fill(t, reach, false);
    if (scratch_.size() == 4) {
      std::sort(scratch_.begin(), scratch_.end());
      return 0.5 * (scratch_[1] + scratch_[2]);
    }
    return scratch_.empty() ? samples_[t] : median_of(scratch_);
  }

  double window(std::size_t t, std::size_t reach) {
    fill(t, reach, true);
    return median_of(scratch_);
  }

 private:
  void fill(std::size_t t, std::size_t reach, bool itself) {
    const std::size_t first = t > reach ? t - reach : 0;
    const std::size_t last = std::min(samples_.size() - 1, t + reach);
    scratch_.assign(samples_.begin() + static_cast<std::ptrdiff_t>(first),
                    samples_.begin() + static_cast<std::ptrdiff_t>(last + 1));
    if (!itself) {
      scratch_.erase(scratch_.begin() + static_cast<std::ptrdiff_t>(t - first));
    }
  }

  std::span<const double> samples_;
  std::vector<double> scratch_;
};

/// Medians of the samples within `reach` of every `stride`-th sample and of the last one, cut off at the ends.
std::vector<double> strided_medians(std::span<const double> samples, std::size_t reach, std::size_t stride,
                                    const RunControl& control) {
  std::vector<double> medians((samples.size() + stride - 1) / stride + 1);
  const std::size_t whole_from = (reach + stride - 1) / stride;
  const std::size_t whole_to = samples.size() > reach ? (samples.size() - reach - 1) / stride + 1 : 0;
  WindowMedians windows(2 * reach + 1);
  for (std::size_t k = whole_from; k < whole_to && !control.stop.stop_requested(); k += kWindowsToPoll) {
    windows.find(samples.data() + k * stride - reach, stride, std::min(kWindowsToPoll, whole_to - k),
                 medians.data() + k);
  }
  Predictor predictor(samples);
  for (std::size_t k = 0; k < medians.size(); ++k) {
    if (k < whole_from || k >= whole_to || k * stride >= samples.size()) {
      medians[k] = predictor.window(std::min(k * stride, samples.size() - 1), reach);
    }
  }
  return medians;
}

/// Residuals from running medians of 2 reach + 1 samples, taken at every `stride`-th sample.
std::vector<double> median_residuals(std::span<const double> samples, std::size_t reach, const RunControl& control) {
  const std::size_t stride = std::max<std::size_t>(1, reach / 2);
  std::vector<double> residual(samples.size());
  const std::vector<double> medians = strided_medians(samples, reach, stride, control);
  std::size_t knot = 0;
  for (std::size_t first = 0; first < samples.size(); first += stride) {
    if (first % kPoll < stride && control.stop.stop_requested()) {
      break;
    }
    const std::size_t next = std::min(first + stride, samples.size() - 1);
    const double left = medians[knot];
    const double right = medians[++knot];
    for (std::size_t t = first; t < std::min(first + stride, samples.size()); ++t) {
      const double part = next > first ? static_cast<double>(t - first) / static_cast<double>(next - first) : 0.0;
      residual[t] = samples[t] - (left + part * (right - left));
    }
  }
  return residual;
}

constexpr std::array<std::size_t, 3> kReaches{7, 31, 125};

/// 0: neighbours, 1: four neighbours, 2 + i: kReaches[i].
std::size_t best_predictor(std::span<const double> samples) {
  Predictor predictor(samples);
  std::array<std::vector<double>, 2 + kReaches.size()> errors;
  const std::size_t stride = std::max<std::size_t>(1, samples.size() / kLooks);
  for (std::size_t t = 0; t < samples.size(); t += stride) {
    errors[0].push_back(std::fabs(samples[t] - predictor.neighbours(t)));
    errors[1].push_back(std::fabs(samples[t] - predictor.around(t, 2)));
    for (std::size_t i = 0; i < kReaches.size(); ++i) {
      errors[2 + i].push_back(std::fabs(samples[t] - predictor.window(t, kReaches[i])));
    }
  }
  std::size_t best = 0;
  double least = median_of(errors[0]);
  for (std::size_t i = 1; i < errors.size(); ++i) {
    if (const double spread = median_of(errors[i]); spread > 0.0 && (spread < least || least == 0.0)) {
      least = spread;
      best = i;
    }
  }
  return best;
}

/// Marks the windows of `length` residuals whose mean stands out. `clipped`: the residuals in standard deviations,
/// between -kClip and kClip.
void mark_patches(const std::vector<double>& clipped, std::size_t length, std::vector<double>& mean,
                  std::vector<std::uint8_t>& patch) {
  if (clipped.size() < 4 * length) {
    return;
  }
  mean.resize(clipped.size() - length + 1);
  double sum = 0.0;
  for (std::size_t t = 0; t + 1 < length; ++t) {
    sum += clipped[t];
  }
  for (std::size_t t = 0; t < mean.size(); ++t) {
    sum += clipped[t + length - 1];
    mean[t] = sum;
    sum -= clipped[t];
  }
  const double limit = kPatchLimit * robust_sd(mean);
  for (std::size_t t = 0; t < mean.size(); ++t) {
    if (limit > 0.0 && std::fabs(mean[t]) > limit) {
      std::fill_n(patch.begin() + static_cast<std::ptrdiff_t>(t), length, std::uint8_t{1});
    }
  }
}

/// Residuals from the two or, `four`, the four neighbours.
void neighbour_residuals(std::span<const double> samples, bool four, std::vector<double>& residual) {
  Predictor predictor(samples);
  const double* const x = samples.data();
  const std::size_t reach = std::min<std::size_t>(four ? 2 : 1, samples.size());
  const std::size_t inner_end = samples.size() > 2 * reach ? samples.size() - reach : reach;
  if (four) {  // the mean of the middle two, as Predictor::around
    for (std::size_t t = reach; t < inner_end; ++t) {
      const double low = std::min(x[t - 2], x[t - 1]);
      const double high = std::max(x[t - 2], x[t - 1]);
      const double other_low = std::min(x[t + 1], x[t + 2]);
      const double other_high = std::max(x[t + 1], x[t + 2]);
      residual[t] = x[t] - 0.5 * (std::max(low, other_low) + std::min(high, other_high));
    }
  } else {
    for (std::size_t t = reach; t < inner_end; ++t) {
      residual[t] = x[t] - 0.5 * (x[t - 1] + x[t + 1]);
    }
  }
  for (std::size_t t = 0; t < samples.size(); t = t + 1 == reach ? std::max(inner_end, reach) : t + 1) {
    residual[t] = x[t] - (four ? predictor.around(t, 2) : predictor.neighbours(t));
  }
}

}  // namespace

OutlierScreen screen_outliers(std::span<const double> samples, const RunControl& control) {
  OutlierScreen screen;
  screen.patch.assign(samples.size(), 0);
  std::vector<double> residual = median_residuals(samples, kReaches.back(), control);
  if (const double sd = robust_sd(residual); sd > 0.0 && !control.stop.stop_requested()) {
    std::vector<double> clipped(residual.size());
    for (std::size_t t = 0; t < residual.size(); ++t) {
      clipped[t] = std::clamp(residual[t] / sd, -kClip, kClip);
    }
    std::vector<double> mean;
    for (const std::size_t length : {std::size_t{8}, std::size_t{20}}) {
      if (!control.stop.stop_requested()) {
        mark_patches(clipped, length, mean, screen.patch);
      }
    }
  }
  const std::size_t best = best_predictor(samples);
  if (best < 2) {
    neighbour_residuals(samples, best == 1, residual);
  } else if (best < 1 + kReaches.size()) {
    residual = median_residuals(samples, kReaches[best - 2], control);
  }
  if (control.stop.stop_requested()) {
    return {};
  }
  screen.sd = robust_sd(residual);
  screen.residual.resize(samples.size());
  for (std::size_t t = 0; t < samples.size(); ++t) {
    screen.residual[t] = screen.sd > 0.0 ? static_cast<float>(residual[t] / screen.sd) : 0.0F;
  }
  return screen;
}

}  // namespace driftlab
