#include "core/navigate/drive/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::drive {
namespace {

constexpr long kMostBridged = 3;  ///< missing samples; spec/drives.md, section 2

// Chosen, not measured. (rtk-car-0708 has 2.07 % single repeats; section 2.)
constexpr double kRepeatsOfAPoll = 0.001;   ///< share of single repeats from which the host polls faster
constexpr std::size_t kSinglesToStuck = 2;  ///< and they are more than this many times the rows that are stuck
constexpr std::size_t kFewestRows = 16;     ///< complete ones, of a drive
constexpr double kShortestRun = 1.0;        ///< [s]

// Half way to a step that misses one sample: such a step is two samples long, and three polls where repeats are
// dropped.
constexpr double kGapSteps = 1.5;
constexpr double kGapPolls = 2.5;

double quantile_of(std::vector<double> values, double fraction) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Running integrals of a piecewise constant signal, read off anywhere between its stamps.
class RunningIntegral {
 public:
  RunningIntegral(std::span<const double> time_s, double first_step_s) : time_s_(time_s), first_step_s_(first_step_s) {}

  void add(std::size_t channel, const std::function<double(std::size_t)>& value) {
    std::vector<double>& sum = sums_[channel];
    sum.resize(time_s_.size() + 1, 0.0);
    for (std::size_t i = 0; i < time_s_.size(); ++i) {
      sum[i + 1] = sum[i] + value(i) * (i == 0 ? first_step_s_ : time_s_[i] - time_s_[i - 1]);
    }
  }
  /// From the start of the first interval to `time_s`, which does not go back between two calls.
  void seek(double time_s) {
    while (at_ + 1 < time_s_.size() && time_s_[at_] < time_s) {
      ++at_;
    }
    const double from = at_ == 0 ? time_s_[0] - first_step_s_ : time_s_[at_ - 1];
    part_ = std::clamp((time_s - from) / (time_s_[at_] - from), 0.0, 1.0);
  }
  [[nodiscard]] double value(std::size_t channel) const {
    const std::vector<double>& sum = sums_[channel];
    return sum[at_] + part_ * (sum[at_ + 1] - sum[at_]);
  }

 private:
  std::span<const double> time_s_;
  double first_step_s_;
  std::array<std::vector<double>, kImuChannels> sums_;
  std::size_t at_ = 0;
  double part_ = 0.0;
};

/// Marks rows that repeat the row before and counts them.
std::vector<bool> repeats_of(const SensorLog& log, SamplingFacts& facts) {
  std::vector<bool> repeat(log.readings.size(), false);
  for (std::size_t i = 1; i < repeat.size(); ++i) {
    repeat[i] = log.readings[i] == log.readings[i - 1];
  }
  for (std::size_t i = 1; i < repeat.size(); ++i) {
    facts.repeated += repeat[i] ? 1 : 0;
    const bool alone = !repeat[i - 1] && (i + 1 == repeat.size() || !repeat[i + 1]);
    facts.stuck += repeat[i] && !alone ? 1 : 0;
  }
  return repeat;
}

/// Without the rows that are marked.
SensorLog without(const SensorLog& log, const std::vector<bool>& left_out) {
  SensorLog kept;
  kept.time_s.reserve(log.time_s.size());
  kept.readings.reserve(log.readings.size());
  for (std::size_t i = 0; i < log.time_s.size(); ++i) {
    if (!left_out[i]) {
      kept.time_s.push_back(log.time_s[i]);
      kept.readings.push_back(log.readings[i]);
    }
  }
  return kept;
}

SensorLog sound_rows(const SensorLog& log, SamplingFacts& facts) {
  std::vector<bool> left_out(log.time_s.size(), false);
  double before = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    const bool complete =
        std::all_of(log.readings[i].begin(), log.readings[i].end(), [](double value) { return std::isfinite(value); });
    facts.incomplete += complete ? 0 : 1;
    const bool again = complete && log.time_s[i] <= before;
    facts.repeated_stamps += again ? 1 : 0;
    left_out[i] = !complete || again;
    before = left_out[i] ? before : log.time_s[i];
  }
  return without(log, left_out);
}

/// Gives the stamps of rows [first, last) equal spacing between the first and the last.
void space_evenly(std::vector<double>& time_s, std::size_t first, std::size_t last) {
  const double from = time_s[first];
  const double step = last - first > 1 ? (time_s[last - 1] - from) / static_cast<double>(last - first - 1) : 0.0;
  for (std::size_t i = first + 1; i + 1 < last; ++i) {
    time_s[i] = from + step * static_cast<double>(i - first);
  }
}

/// Rows [first, last) as one run. `even`: the stamps between the ends carry nothing.
UniformRun run_of(const SensorLog& log, std::size_t first, std::size_t last, double step_s, bool even) {
  UniformRun run;
  const std::size_t count = last - first;
  const double span = log.time_s[last - 1] - log.time_s[first];
  if (even) {
    run.dt_s = span / static_cast<double>(count - 1);
    run.start_s = log.time_s[first] - run.dt_s;
    run.readings.assign(log.readings.begin() + static_cast<std::ptrdiff_t>(first),
                        log.readings.begin() + static_cast<std::ptrdiff_t>(last));
    return run;
  }
  const auto samples = static_cast<std::size_t>(std::llround(span / step_s)) + 1;
  run.dt_s = span / static_cast<double>(samples - 1);
  run.start_s = log.time_s[first] - run.dt_s;
  RunningIntegral integral(std::span(log.time_s).subspan(first, count), run.dt_s);
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    integral.add(c, [&](std::size_t i) { return log.readings[first + i][c]; });
  }
  std::array<double, kImuChannels> before{};
  for (std::size_t k = 0; k < samples; ++k) {
    integral.seek(run.start_s + static_cast<double>(k + 1) * run.dt_s);
    ImuSample sample{};
    for (std::size_t c = 0; c < kImuChannels; ++c) {
      const double now = integral.value(c);
      sample[c] = (now - before[c]) / run.dt_s;
      before[c] = now;
    }
    run.readings.push_back(sample);
  }
  return run;
}

}  // namespace

Result<std::vector<UniformRun>> uniform_readings(SensorLog log, const SamplingOptions& options, SamplingFacts& facts) {
  facts.rows = log.time_s.size();
  log = sound_rows(log, facts);
  if (log.time_s.size() < kFewestRows) {
    return fail(ErrorCode::TooFewSamples, "The inertial unit has fewer than 16 complete rows.");
  }
  const double span = log.time_s.back() - log.time_s.front();
  facts.stamped_rate_hz = static_cast<double>(log.time_s.size() - 1) / span;
  const std::vector<bool> repeat = repeats_of(log, facts);
  const std::size_t alone = facts.repeated - facts.stuck;
  facts.polled_faster = options.repair && alone > kSinglesToStuck * facts.stuck &&
                        static_cast<double>(alone) > kRepeatsOfAPoll * static_cast<double>(log.time_s.size());
  if (facts.polled_faster) {
    log = without(log, repeat);
  }
  facts.sensor_rate_hz = static_cast<double>(log.time_s.size() - 1) / span;
  std::vector<double> steps(log.time_s.size() - 1);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    steps[i] = log.time_s[i + 1] - log.time_s[i];
  }
  facts.jitter_s = 0.5 * (quantile_of(steps, 0.95) - quantile_of(steps, 0.05));
  const double usual = quantile_of(steps, 0.5);
  if (!(usual > 0.0)) {
    return fail(ErrorCode::InconsistentSampling, "Half of the inertial unit's rows have the stamp of the row before.");
  }
  const double longest = (facts.polled_faster ? kGapPolls : kGapSteps) * usual;
  const bool even = options.repair && (facts.polled_faster || options.clock != SensorClock::Sensor);
  // The mean of the steps between gaps is the sample interval, where the median is one of a lattice of stamps.
  double sum = 0.0;
  double many = 0.0;
  for (const double step : steps) {
    sum += step <= longest ? step : 0.0;
    many += step <= longest ? 1.0 : 0.0;
  }
  const double interval = sum / many;
  std::vector<UniformRun> runs;
  std::size_t first = 0;   // of the run
  std::size_t behind = 0;  // of its rows, the first behind the last gap
  for (std::size_t i = 0; i <= steps.size(); ++i) {
    if (i < steps.size()) {
      facts.longest_gap_s = std::max(facts.longest_gap_s, steps[i] > longest ? steps[i] : 0.0);
      const long missing = std::lround(steps[i] / interval) - 1;
      if (steps[i] <= longest) {
        continue;
      }
      if (missing <= kMostBridged) {
        ++facts.gaps_bridged;
        facts.samples_bridged += static_cast<std::size_t>(std::max(missing, 1L));
        if (even) {
          space_evenly(log.time_s, behind, i + 1);
        }
        behind = i + 1;
        continue;
      }
      ++facts.gaps_splitting;
    }
    const bool whole = behind == first;
    if (even && !whole) {
      space_evenly(log.time_s, behind, i + 1);
    }
    if (log.time_s[i] - log.time_s[first] >= kShortestRun) {
      runs.push_back(run_of(log, first, i + 1, interval, even && whole));
    }
    first = i + 1;
    behind = first;
  }
  if (runs.empty()) {
    return fail(ErrorCode::TooFewSamples, "No part of the inertial unit's rows is longer than a second without a gap.");
  }
  return runs;
}

SensorLog joined(const std::vector<double>& rate_time_s, const std::vector<Vector3>& rate,
                 const std::vector<double>& force_time_s, const std::vector<Vector3>& force) {
  SensorLog log;
  const double first_step = force_time_s.size() > 1 ? force_time_s[1] - force_time_s[0] : 1.0;
  RunningIntegral integral(force_time_s, first_step);
  for (std::size_t k = 0; k < 3; ++k) {
    integral.add(k, [&](std::size_t i) { return force[i](static_cast<Eigen::Index>(k)); });
  }
  Vector3 before = Vector3::Zero();
  for (std::size_t i = 0; i < rate_time_s.size(); ++i) {
    if (rate_time_s[i] < force_time_s.front() || rate_time_s[i] > force_time_s.back()) {
      continue;
    }
    integral.seek(rate_time_s[i]);
    const Vector3 now(integral.value(0), integral.value(1), integral.value(2));
    if (i > 0 && rate_time_s[i - 1] >= force_time_s.front() && rate_time_s[i] > rate_time_s[i - 1]) {
      const Vector3 mean = (now - before) / (rate_time_s[i] - rate_time_s[i - 1]);
      log.time_s.push_back(rate_time_s[i]);
      log.readings.push_back({rate[i].x(), rate[i].y(), rate[i].z(), mean.x(), mean.y(), mean.z()});
    }
    before = now;
  }
  return log;
}

}  // namespace driftlab::drive
