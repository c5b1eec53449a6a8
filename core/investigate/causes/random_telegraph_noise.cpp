/// random_telegraph_noise: jumps between +amplitude and -amplitude, sides that last dwell_s on the average
/// (core/investigate/slow/telegraph.hpp).
///
/// It is sought in means over half a second of the recordings at rest. The model without it is the baseline with one
/// Gauss-Markov process more, refitted: what has a telegraph's spectrum and is Gaussian. The model with it is the
/// baseline, or the baseline without one of its processes, which may have been fitted to the telegraph. Named only if
/// twice the log likelihood gains more than kGain, and if sides last from eight blocks to an eighth of the record.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/slow/slow_fit.hpp"
#include "core/investigate/slow/telegraph.hpp"
#include "core/process/gauss_markov.hpp"
#include "core/process/registry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace driftlab::investigate {
namespace {

constexpr double kGain = 25.0;
constexpr double kBlock = 0.5;  ///< [s]

/// Block means of the residuals of some members, over a share of each.
BlockSeries series_of(const FullRate& data, const std::vector<std::size_t>& members, double from, double to) {
  BlockSeries series;
  series.dt_s = data.dt_s;
  series.block = static_cast<std::size_t>(std::max(1.0, std::round(kBlock / data.dt_s)));
  for (const std::size_t r : members) {
    const std::vector<double>& y = data.residual[r];
    const auto begin = static_cast<std::size_t>(from * static_cast<double>(y.size()));
    const auto end = static_cast<std::size_t>(to * static_cast<double>(y.size()));
    BlockRecording blocks;
    blocks.pattern = series.recordings.size();
    blocks.start_s = data.group->members[r].recording->time_s(data.group->members[r].recording->begin + begin);
    for (std::size_t at = begin; at + series.block <= end; at += series.block) {
      double sum = 0.0;
      double count = 0.0;
      for (std::size_t i = at; i < at + series.block; ++i) {
        sum += data.used[r][i] != 0 ? y[i] : 0.0;
        count += data.used[r][i] != 0 ? 1.0 : 0.0;
      }
      const double filled = count / static_cast<double>(series.block);
      blocks.mean.push_back(count > 0.0 ? sum / count : 0.0);
      blocks.filled.push_back(filled < 0.25 ? 0.0 : filled);
    }
    series.recordings.push_back(std::move(blocks));
  }
  return series;
}

/// The data, and a bias.
BlockColumns columns_of(const BlockSeries& series) {
  BlockColumns columns = BlockColumns::zeros(series, 2);
  for (std::size_t r = 0; r < series.recordings.size(); ++r) {
    for (std::size_t b = 0; b < series.recordings[r].mean.size(); ++b) {
      columns.rows[r][2 * b] = series.recordings[r].mean[b];
      columns.rows[r][2 * b + 1] = series.recordings[r].filled[b] > 0.0 ? 1.0 : 0.0;
    }
  }
  return columns;
}

/// The members' part of a model; scales and processes of single recordings stay with them.
SlowModel part_of(const SlowModel& model, const std::vector<std::size_t>& members) {
  SlowModel part = model;
  part.white_scale.clear();
  for (SlowComponent& component : part.components) {
    if (component.in.empty()) {
      continue;
    }
    std::vector<unsigned char> in;
    for (const std::size_t r : members) {
      in.push_back(component.in[r]);
    }
    component.in = std::move(in);
  }
  return part;
}

double blocks_variance(const BlockSeries& series) {
  double sum = 0.0;
  double square = 0.0;
  double count = 0.0;
  for (const BlockRecording& recording : series.recordings) {
    for (const double v : recording.mean) {
      sum += v;
      square += v * v;
      count += 1.0;
    }
  }
  return count > 0.0 ? std::max(0.0, square / count - sum * sum / count / count) : 0.0;
}

/// Log likelihood of the baseline with one Gaussian process more, and of the baseline as it is.
double gaussian_log_likelihood(const BlockSeries& series, const SlowModel& base, bool given) {
  const BlockColumns columns = columns_of(series);
  SlowFreedom freedom;
  freedom.white = !given;
  freedom.first_free = given ? base.components.size() : 0;
  double best = evaluate_slow(series, columns, base).log_likelihood;
  const double variance = blocks_variance(series);
  for (const double beta : {0.02, 0.1, 0.5}) {
    SlowModel more = base;
    more.components.push_back({&registered<GaussMarkov>(), 0.3 * variance, beta, {}});
    best = std::max(best, fit_slow(series, columns, more, freedom).log_likelihood);
  }
  return best;
}

/// Log likelihood of `evaluate_slow` less that of the sided filter where there is nothing but white noise and slow
/// processes: the two leave out different constants.
double constant_between(const BlockSeries& series, const SlowModel& base) {
  return evaluate_slow(series, columns_of(series), base).log_likelihood -
         telegraph_log_likelihood(series, base, {0.0, 100.0});
}

/// The model, and the model without each of its slow processes, which may have been fitted to a telegraph: by an
/// automatic baseline, or as a finding beside a given one.
std::vector<SlowModel> beside(const SlowModel& base) {
  std::vector<SlowModel> models{base};
  for (std::size_t k = 0; k < base.components.size(); ++k) {
    SlowModel without = base;
    without.components.erase(without.components.begin() + static_cast<std::ptrdiff_t>(k));
    models.push_back(std::move(without));
  }
  return models;
}

struct Best {
  TelegraphFit fit;
  SlowModel model;
};

Best best_beside(const BlockSeries& series, const SlowModel& base) {
  std::optional<Best> best;
  for (SlowModel& model : beside(base)) {
    TelegraphFit fit = fit_telegraph(series, model);
    if (!best || fit.log_likelihood > best->fit.log_likelihood) {
      best = Best{fit, std::move(model)};
    }
  }
  return *best;
}

/// Fitted on one half of every recording, counted on the other against the baseline with one process more, fitted
/// there.
double held_out_gain(const FullRate& data, const std::vector<std::size_t>& members, const SlowModel& base,
                     const SlowModel& with) {
  double gain = 0.0;
  for (const double train : {0.0, 0.5}) {
    const double test = 0.5 - train;
    const TelegraphFit fit = fit_telegraph(series_of(data, members, train, train + 0.5), with);
    const BlockSeries series = series_of(data, members, test, test + 0.5);
    gain += telegraph_log_likelihood(series, with, fit.telegraph) + constant_between(series, base) -
            gaussian_log_likelihood(series, base, data.given);
  }
  return gain;
}

std::vector<std::size_t> resting(const FullRate& data) {
  std::vector<std::size_t> members;
  for (std::size_t r = 0; r < data.members(); ++r) {
    if (data.group->members[r].recording->is_static()) {
      members.push_back(r);
    }
  }
  return members;
}

std::vector<Evidence> examine(const FullRate& data) {
  const std::vector<std::size_t> members = resting(data);
  if (members.empty()) {
    return {};
  }
  const BlockSeries series = series_of(data, members, 0.0, 1.0);
  constexpr std::size_t kFewestBlocks = 200;
  constexpr std::size_t kMostBlocks = 40000;
  if (series.blocks() < kFewestBlocks || series.blocks() > kMostBlocks) {
    return {};
  }
  const SlowModel base = part_of(data.model, members);
  const double constant = constant_between(series, base);
  const Best best = best_beside(series, base);
  const double with = best.fit.log_likelihood + constant;
  const double as_it_is = evaluate_slow(series, columns_of(series), base).log_likelihood;
  const double dwell = best.fit.telegraph.dwell_s;
  if (2.0 * (with - as_it_is) < kGain || dwell < 8.0 * kBlock || dwell > 0.125 * series.longest_s()) {
    return {};
  }
  const double gain = 2.0 * (with - gaussian_log_likelihood(series, base, data.given));
  if (gain < kGain) {
    return {};
  }
  Evidence evidence;
  evidence.members = members;
  evidence.gain = gain;
  evidence.freedom = 2.0;
  evidence.score = gain - 4.0;
  evidence.shape = dwell;
  const auto around = [](double value, double log_sd) {
    return Estimate{value, {value * std::exp(-1.96 * log_sd), value * std::exp(1.96 * log_sd)}};
  };
  evidence.parameters = {{"amplitude", around(best.fit.telegraph.amplitude, std::max(0.01, best.fit.log_amplitude_sd)),
                          units::level(data.group->unit)},
                         {"dwell_s", around(dwell, std::max(0.05, best.fit.log_dwell_sd)), units::seconds({})}};
  evidence.heldout_gain = held_out_gain(data, members, base, best.model);
  evidence.heldout = true;
  for (const std::size_t r : members) {
    evidence.heldout_samples += static_cast<double>(data.residual[r].size());
  }
  return evidence.heldout_gain > 0.0 ? std::vector{evidence} : std::vector<Evidence>{};
}

/// The expected course between the two levels; steps between blocks.
std::vector<double> values_of(const FullRate& data, std::size_t r, const Evidence& found) {
  std::vector<double> values(data.residual[r].size(), 0.0);
  const BlockSeries series = series_of(data, {r}, 0.0, 1.0);
  const SlowModel base = part_of(data.model, {r});
  const Telegraph telegraph{found.parameters[0].estimate.value, found.parameters[1].estimate.value};
  double most = -1e300;
  std::vector<double> side;
  for (const SlowModel& model : beside(base)) {
    const double log_likelihood = telegraph_log_likelihood(series, model, telegraph);
    if (log_likelihood > most) {
      most = log_likelihood;
      side = telegraph_sides(series, model, telegraph, 0);
    }
  }
  for (std::size_t i = 0; i < values.size() && !side.empty(); ++i) {
    values[i] = telegraph.amplitude * side[std::min(i / series.block, side.size() - 1)];
  }
  return values;
}

void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  double side = random.uniform() < 0.5 ? values[0] : -values[0];
  const double turn = 1.0 - std::exp(-draft.recording->dt_s / values[1]);
  for (double& mean : draft.mean) {
    mean += side;
    side = random.uniform() < turn ? -side : side;
  }
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) {
  return {0.06 * stage.z * stage.density, 30.0};
}

}  // namespace

Cause random_telegraph_noise() {
  return {.name = "random_telegraph_noise",
          .title = "random jumps between two levels (popcorn noise)",
          .family = SwitchingNoise{.examine = examine, .values = values_of},
          .rivals = {"gauss_markov"},
          .needs = "recordings at rest",
          .separates = "a longer recording at rest: its histogram has two tops",
          .parameters = {{"amplitude", units::level}, {"dwell_s", units::seconds}},
          .inject = inject_effect,
          .showing = {.values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
