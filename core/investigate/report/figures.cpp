#include "core/investigate/report/figures.hpp"

#include "core/process/distributions.hpp"
#include "core/process/quantization_noise.hpp"
#include "core/process/white_noise.hpp"
#include "core/variance/welch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace driftlab::investigate {
namespace {

/// Points of a course over time. Chosen for the width of a figure.
constexpr std::size_t kStretches = 200;
/// Bins of a spectrum. Chosen for the width of a figure.
constexpr std::size_t kBins = 240;
constexpr std::size_t kLongestStretch = std::size_t{1} << 19U;  ///< samples of one stretch of the spectrum

/// Haar wavelet variance of the model at half length `half`.
double model_variance(const SlowModel& model, double quantization, double half, double dt_s) {
  double sum = WhiteNoise{std::sqrt(model.white)}.haar_variance(half, dt_s) +
               QuantizationNoise{std::sqrt(quantization)}.haar_variance(half, dt_s);
  for (const SlowComponent& component : model.components) {
    sum += component.process.haar_variance(half, dt_s);
  }
  return sum;
}

void add_band(const SlowModel& model, double quantization, double half, double dt_s, double count, Band& band) {
  const double variance = model_variance(model, quantization, half, dt_s);
  const auto at = [&](double p) { return std::sqrt(variance * chi_squared_quantile(p, count) / count); };
  band.low.push_back(at(0.025));
  band.median.push_back(at(0.5));
  band.high.push_back(at(0.975));
}

struct Sum {
  double square = 0.0, count = 0.0;
  [[nodiscard]] double deviation() const { return count > 0.0 ? std::sqrt(square / count) : 0.0; }
};

/// Squares of the Haar coefficients of half length `half`, end to end.
void add_haar(const Series& x, std::size_t half, Sum& sum) {
  for (std::size_t k = 0; k < x.size() / (2 * half); ++k) {
    double difference = 0.0;
    for (std::size_t i = 2 * k * half; i < (2 * k + 1) * half; ++i) {
      difference += x[i + half] - x[i];
    }
    difference /= 2.0 * static_cast<double>(half);
    sum.square += difference * difference;
    sum.count += 1.0;
  }
}

void add_scales(const GroupOutcome& outcome, ChannelFigures& figures) {
  const double dt_s = outcome.after.dt_s;
  for (std::size_t half = 1;; half *= 2) {
    Sum before;
    Sum after;
    for (std::size_t r = 0; r < outcome.before.members(); ++r) {
      add_haar(outcome.before.residual[r], half, before);
      add_haar(outcome.after.residual[r], half, after);
    }
    if (before.count < 3.0 || after.count < 3.0) {
      return;
    }
    figures.scale_s.push_back(2.0 * static_cast<double>(half) * dt_s);
    figures.deviation_before.push_back(before.deviation());
    figures.deviation_after.push_back(after.deviation());
    const auto length = static_cast<double>(half);
    add_band(outcome.before.model, outcome.before.quantization, length, dt_s, before.count, figures.baseline);
    add_band(outcome.model.beside.noise, outcome.after.quantization, length, dt_s, after.count, figures.extended);
  }
}

/// Density over stretches of `length` samples, end to end, of all recordings.
WelchPeriodogram mean_periodogram(const FullRate& data, std::size_t length) {
  WelchPeriodogram mean(length, Taper::None, data.dt_s);
  for (const auto& residual : data.residual) {
    for (std::size_t from = 0; from + length <= residual.size(); from += length) {
      const std::vector<double> part = residual.part(from, length).values();
      mean.add(part, {.level = std::accumulate(part.begin(), part.end(), 0.0) / static_cast<double>(length)});
    }
  }
  return mean;
}

void add_spectrum(const GroupOutcome& outcome, ChannelFigures& figures) {
  std::size_t shortest = kLongestStretch;
  for (const auto& residual : outcome.before.residual) {
    shortest = std::min(shortest, residual.size());
  }
  const std::size_t length = fast_length(shortest);
  if (length < 64) {
    return;
  }
  const WelchPeriodogram periodogram = mean_periodogram(outcome.before, length);
  const auto stretches = static_cast<double>(periodogram.pieces());
  const std::vector<double> before = periodogram.mean();
  const std::vector<double> after = mean_periodogram(outcome.after, length).mean();
  const double dt_s = outcome.before.dt_s;
  const std::size_t ordinates = (length - 1) / 2;
  const std::size_t bins = std::min(kBins, ordinates);
  const double chance =
      chi_squared_quantile(1.0 - 0.05 / static_cast<double>(ordinates), 2.0 * stretches) / (2.0 * stretches);
  for (std::size_t b = 0; b < bins; ++b) {
    const std::size_t from = 1 + b * ordinates / bins;
    const std::size_t to = 1 + (b + 1) * ordinates / bins;
    double sum[2] = {0.0, 0.0};
    double top[2] = {0.0, 0.0};
    for (std::size_t k = from; k < to; ++k) {
      sum[0] += before[k];
      sum[1] += after[k];
      top[0] = std::max(top[0], before[k]);
      top[1] = std::max(top[1], after[k]);
    }
    const auto m = static_cast<double>(to - from);
    const double f = 0.5 * static_cast<double>(from + to - 1) / static_cast<double>(length) / dt_s;
    const double base = outcome.before.model.white +
                        slow_density(outcome.before.model, 0, f, dt_s, static_cast<double>(length)) +
                        outcome.before.quantization * quantization_shape(f, dt_s);
    const double dof = 2.0 * m * stretches;
    figures.f_hz.push_back(f);
    figures.density_before.push_back(sum[0] / m);
    figures.density_after.push_back(sum[1] / m);
    figures.highest_before.push_back(top[0]);
    figures.highest_after.push_back(top[1]);
    figures.density_baseline.low.push_back(base * chi_squared_quantile(0.025, dof) / dof);
    figures.density_baseline.median.push_back(base);
    figures.density_baseline.high.push_back(base * chi_squared_quantile(0.975, dof) / dof);
    figures.chance.push_back(base * chance);
  }
}

MeasuredFigures::Course course_of(const StudyRecording& recording, const Series& before, const Series& after) {
  const std::size_t stretches = std::min(kStretches, before.size());
  MeasuredFigures::Course course;
  course.recording = recording.id;
  for (std::size_t s = 0; s < stretches; ++s) {
    const std::size_t from = s * before.size() / stretches;
    const std::size_t to = (s + 1) * before.size() / stretches;
    double error = 0.0;
    double left = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      error += before[i];
      left += after[i];
    }
    const auto count = static_cast<double>(to - from);
    course.time_s.push_back(0.5 * (recording.time_s(recording.begin + from) + recording.time_s(recording.begin + to)));
    course.error.push_back(error / count);
    course.effect.push_back((error - left) / count);
  }
  return course;
}

}  // namespace

MeasuredFigures measure_figures(const ChannelGroup& group, const GroupOutcome& outcome) {
  MeasuredFigures measured;
  measured.figures.channel = group.column;
  measured.figures.unit = group.unit;
  add_scales(outcome, measured.figures);
  add_spectrum(outcome, measured.figures);
  for (std::size_t r = 0; r < group.members.size(); ++r) {
    measured.courses.push_back(
        course_of(*group.members[r].recording, outcome.before.residual[r], outcome.after.residual[r]));
  }
  return measured;
}

ChannelFigures figures_of(const MeasuredFigures& measured, std::size_t shown, const std::vector<Check>& checks) {
  ChannelFigures figures = measured.figures;
  const MeasuredFigures::Course& course = measured.courses[shown];
  figures.recording = course.recording;
  figures.time_s = course.time_s;
  figures.error = course.error;
  figures.effect = course.effect;
  for (const Check& check : checks) {
    if (check.channel == figures.channel && check.scale_s > 0.0) {
      figures.ratios.push_back(
          {check.recording, check.scale_s, check.observed, check.observed_after, check.q025, check.q975});
    }
  }
  return figures;
}

std::vector<AllanChange> allan_changes(const ChannelFigures& figures) {
  std::vector<AllanChange> changes;
  for (std::size_t i = 0; i < figures.scale_s.size(); ++i) {
    const double taken_off = std::max(0.0, figures.deviation_before[i] * figures.deviation_before[i] -
                                               figures.deviation_after[i] * figures.deviation_after[i]);
    const double extended = figures.extended.median[i];
    changes.push_back({0.5 * figures.scale_s[i], std::numbers::sqrt2 * figures.deviation_before[i],
                       std::numbers::sqrt2 * figures.baseline.median[i],
                       std::numbers::sqrt2 * std::sqrt(extended * extended + taken_off)});
  }
  return changes;
}

}  // namespace driftlab::investigate
