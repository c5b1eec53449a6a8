#include "core/investigate/report/series.hpp"

#include "core/process/distributions.hpp"
#include "core/process/white_noise.hpp"

#include <cmath>

namespace driftlab::investigate {
namespace {

constexpr std::size_t kStretches = 200;

/// Haar wavelet variance of the model at half length `half`.
double model_variance(const SlowModel& model, double half, double dt_s) {
  double sum = WhiteNoise{std::sqrt(model.white)}.haar_variance(half, dt_s);
  for (const SlowComponent& component : model.components) {
    sum += component.process().haar_variance(half, dt_s);
  }
  return sum;
}

void add_band(const SlowModel& model, double half, double dt_s, double count, Band& band) {
  const double variance = model_variance(model, half, dt_s);
  const auto at = [&](double p) { return std::sqrt(variance * chi_squared_quantile(p, count) / count); };
  band.low.push_back(at(0.025));
  band.median.push_back(at(0.5));
  band.high.push_back(at(0.975));
}

/// Root mean square of the Haar coefficients of half length `half`, end to end.
double haar_deviation(const std::vector<double>& x, std::size_t half) {
  double square = 0.0;
  const std::size_t count = x.size() / (2 * half);
  for (std::size_t k = 0; k < count; ++k) {
    double difference = 0.0;
    for (std::size_t i = 2 * k * half; i < (2 * k + 1) * half; ++i) {
      difference += x[i + half] - x[i];
    }
    difference /= 2.0 * static_cast<double>(half);
    square += difference * difference;
  }
  return std::sqrt(square / static_cast<double>(count));
}

void add_scales(const GroupOutcome& outcome, std::size_t r, FindingSeries& series) {
  const std::vector<double>& before = outcome.before.residual[r];
  const double dt_s = outcome.after.dt_s;
  for (std::size_t half = 1; before.size() / (2 * half) >= 3; half *= 2) {
    const std::size_t pairs = before.size() / (2 * half);
    const auto count = static_cast<double>(pairs);
    series.scale_s.push_back(2.0 * static_cast<double>(half) * dt_s);
    series.deviation_before.push_back(haar_deviation(before, half));
    series.deviation_after.push_back(haar_deviation(outcome.after.residual[r], half));
    add_band(outcome.model.base, static_cast<double>(half), dt_s, count, series.baseline);
    add_band(outcome.after.model, static_cast<double>(half), dt_s, count, series.extended);
  }
}

void add_spectrum(const GroupOutcome& outcome, std::size_t r, FindingSeries& series) {
  const Spectrum& before = outcome.before.spectrum[r];
  const Spectrum& after = outcome.after.spectrum[r];
  if (before.power.empty() || before.power.size() != after.power.size()) {
    return;
  }
  for (std::size_t j = 0; j < before.power.size(); ++j) {
    series.f_hz.push_back(before.f_hz[j]);
    series.density_before.push_back(before.power[j]);
    series.density_after.push_back(after.power[j]);
    series.density_baseline.push_back(outcome.model.base.white + outcome.before.slow[r][j]);
  }
}

void add_course(const ChannelGroup& group, const GroupOutcome& outcome, std::size_t r, FindingSeries& series) {
  const std::vector<double>& before = outcome.before.residual[r];
  const std::vector<double>& after = outcome.after.residual[r];
  const StudyRecording& recording = *group.members[r].recording;
  const std::size_t stretches = std::min(kStretches, before.size());
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
    series.time_s.push_back(0.5 * (recording.time_s(recording.begin + from) + recording.time_s(recording.begin + to)));
    series.error.push_back(error / count);
    series.effect.push_back((error - left) / count);
  }
}

}  // namespace

FindingSeries series_of(const ChannelGroup& group, const GroupOutcome& outcome, std::size_t r) {
  FindingSeries series;
  series.recording = group.members[r].recording->id;
  series.channel = group.members[r].channel->column;
  series.unit = group.unit;
  if (outcome.before.residual.size() <= r || outcome.after.residual.size() <= r ||
      outcome.before.residual[r].size() != outcome.after.residual[r].size()) {
    return series;
  }
  add_scales(outcome, r, series);
  add_spectrum(outcome, r, series);
  add_course(group, outcome, r, series);
  return series;
}

}  // namespace driftlab::investigate
