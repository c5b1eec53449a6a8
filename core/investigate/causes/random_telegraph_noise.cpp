/// random_telegraph_noise: jumps between +amplitude and -amplitude, sides that last dwell_s on the average
/// (core/investigate/slow/telegraph.hpp).
///
/// It is sought in means over half a second of the recordings at rest. Its spectrum is that of a Gauss-Markov process,
/// so that only what is not Gaussian in it can name it: the two levels. The model without it is therefore the best of a
/// family of Gaussian models that hold any slow spectrum (sums of Gauss-Markov processes, random walk, flicker noise),
/// every level refitted to these recordings, the baseline's too. The model with it is the baseline as it is, or the
/// baseline without one of its processes, which may have been fitted to the telegraph. If the truth is Gaussian and one
/// of the family, the likelihood ratio of a telegraph to it exceeds c with a chance of at most 1/c at each place of the
/// search. It is named only if twice its logarithm exceeds kGain, if sides last from eight blocks to an eighth of the
/// record, if changes have been seen, most of the time with no doubt about the side, and if both halves of the
/// recordings together gain by what the other half of each shows.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/slow/slow_fit.hpp"
#include "core/investigate/slow/telegraph.hpp"
#include "core/process/flicker_noise.hpp"
#include "core/process/gauss_markov.hpp"
#include "core/process/random_walk.hpp"
#include "core/process/registry.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace driftlab::investigate {
namespace {

/// Twice the log likelihood over the best slow process. Chosen, not measured, and high: three parameters are searched
/// over a plane of starts.
constexpr double kGain = 25.0;
constexpr double kBlock = 0.5;  ///< [s]; longer where the recordings hold more than kMostBlocks
/// Bounds the cost, which is a filter of two beliefs over all blocks for each trial. Chosen, not measured.
constexpr double kMostBlocks = 20000.0;
/// Fewer hold too few dwells to tell two levels from a drift. Chosen, not measured.
constexpr double kFewestBlocks = 200.0;
constexpr double kLeastDwell = 8.0;     ///< blocks
constexpr double kFewestChanges = 8.0;  ///< seen in all recordings together
constexpr double kLeastSure = 0.5;      ///< share of the blocks whose side is beyond doubt

/// Samples of a block.
std::size_t block_of(const FullRate& data, const std::vector<std::size_t>& members) {
  double seconds = 0.0;
  for (const std::size_t r : members) {
    seconds += static_cast<double>(data.residual[r].size()) * data.dt_s;
  }
  return static_cast<std::size_t>(std::max(1.0, std::round(std::max(kBlock, seconds / kMostBlocks) / data.dt_s)));
}

/// Block means of the residuals of some members, over a share of each.
BlockSeries series_of(const FullRate& data, const std::vector<std::size_t>& members, std::size_t block, double from,
                      double to) {
  BlockSeries series;
  series.dt_s = data.dt_s;
  series.block = block;
  for (const std::size_t r : members) {
    const Series& y = data.residual[r];
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

/// Log likelihood of the best Gaussian description. A deficit of the baseline against the spectrum must not count for
/// the telegraph, so that the levels of the baseline are free too, given or not.
double gaussian_log_likelihood(const BlockSeries& series, const SlowModel& base) {
  const BlockColumns columns = columns_of(series);
  const double variance = std::max(blocks_variance(series), 1e-300);
  const ProcessKind& markov = registered<GaussMarkov>();
  const ProcessKind& walk = registered<RandomWalk>();
  const std::vector<SlowComponent> further{
      slow_component(markov, 0.3 * variance, 0.02), slow_component(markov, 0.3 * variance, 0.1),
      slow_component(markov, 0.3 * variance, 0.5), slow_component(registered<FlickerNoise>(), 0.1 * variance),
      slow_component(walk, at_record_length(walk, 0.1 * variance, series.longest_s()))};
  SlowFit best = fit_slow(series, columns, base);
  // Slow processes beside the baseline that the telegraph must beat. Chosen, not measured.
  constexpr int kMore = 2;
  for (int more = 0; more < kMore; ++more) {
    const SlowModel start = best.model;
    for (const SlowComponent& component : further) {
      SlowModel trial = start;
      trial.components.push_back(component);
      SlowFit fit = fit_slow(series, columns, trial);
      best = fit.log_likelihood > best.log_likelihood ? std::move(fit) : std::move(best);
    }
  }
  return std::max(best.log_likelihood, evaluate_slow(series, columns, base).log_likelihood);
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

/// The best telegraph beside any of these models; nothing where a first look finds no more than `least`.
std::optional<Best> best_beside(const BlockSeries& series, const SlowModel& base, double least) {
  std::optional<Best> best;
  for (SlowModel& model : beside(base)) {
    if (coarse_telegraph(series, model).log_likelihood < least) {
      continue;
    }
    const TelegraphFit fit = fit_telegraph(series, model);
    if (!best || fit.log_likelihood > best->fit.log_likelihood) {
      best = Best{fit, std::move(model)};
    }
  }
  return best;
}

/// What the sides look like that a telegraph has been seen on.
struct Sides {
  double changes = 0.0;
  double sure = 0.0;  ///< share of the blocks
};

Sides sides_seen(const BlockSeries& series, const Best& best) {
  // Of the expected side, from -1 to 1: nine to one. Chosen, not measured.
  constexpr double kSure = 0.8;
  Sides seen;
  double blocks = 0.0;
  for (std::size_t r = 0; r < series.recordings.size(); ++r) {
    double last = 0.0;
    for (const double side : telegraph_sides(series, best.model, best.fit.telegraph, r)) {
      blocks += 1.0;
      if (std::fabs(side) > kSure) {
        seen.sure += 1.0;
        seen.changes += side * last < 0.0 ? 1.0 : 0.0;
        last = side;
      }
    }
  }
  seen.sure /= std::max(1.0, blocks);
  return seen;
}

/// Fitted on one half of every recording, counted on the other against the best Gaussian description, fitted there.
double held_out_gain(const FullRate& data, const std::vector<std::size_t>& members, const SlowModel& base,
                     const SlowModel& with) {
  const std::size_t block = block_of(data, members);
  double gain = 0.0;
  for (const double train : {0.0, 0.5}) {
    const double test = 0.5 - train;
    const TelegraphFit fit = fit_telegraph(series_of(data, members, block, train, train + 0.5), with);
    const BlockSeries series = series_of(data, members, block, test, test + 0.5);
    // The Gaussian description has its own bias there, and so has this.
    const Telegraph telegraph = with_best_offset(series, with, fit.telegraph);
    gain += telegraph_log_likelihood(series, with, telegraph) - gaussian_log_likelihood(series, base);
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

std::optional<Evidence> find(const FullRate& data) {
  const std::vector<std::size_t> members = resting(data);
  if (members.empty()) {
    return std::nullopt;
  }
  const BlockSeries series = series_of(data, members, block_of(data, members), 0.0, 1.0);
  if (static_cast<double>(series.blocks()) < kFewestBlocks) {
    return std::nullopt;
  }
  const SlowModel base = part_of(data.model, members);
  const double as_it_is = evaluate_slow(series, columns_of(series), base).log_likelihood;
  const std::optional<Best> best = best_beside(series, base, as_it_is);
  if (!best) {
    return std::nullopt;
  }
  const double with = best->fit.log_likelihood;
  const double dwell = best->fit.telegraph.dwell_s;
  if (2.0 * (with - as_it_is) < kGain || dwell < kLeastDwell * series.block_s() || dwell > 0.125 * series.longest_s()) {
    return std::nullopt;
  }
  const Sides seen = sides_seen(series, *best);
  if (seen.changes < kFewestChanges || seen.sure < kLeastSure) {
    return std::nullopt;
  }
  const double gain = 2.0 * (with - gaussian_log_likelihood(series, base));
  if (gain < kGain) {
    return std::nullopt;
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
  // Of n changes the mean time between them is known to 1/sqrt(n) at best.
  const double least_log_sd = 1.0 / std::sqrt(seen.changes);
  evidence.parameters = {
      {"amplitude", around(best->fit.telegraph.amplitude, std::max(0.01, best->fit.log_amplitude_sd)),
       units::level(data.group->unit)},
      {"dwell_s", around(dwell, std::max(least_log_sd, best->fit.log_dwell_sd)), units::seconds({})}};
  evidence.heldout_gain = held_out_gain(data, members, base, best->model);
  evidence.heldout = true;
  for (const std::size_t r : members) {
    evidence.heldout_samples += static_cast<double>(data.residual[r].size());
  }
  return evidence.heldout_gain > 0.0 ? std::optional(evidence) : std::nullopt;
}

/// The expected course between the two levels; steps between blocks.
std::vector<double> values_of(const FullRate& data, std::size_t r, const Evidence& found) {
  std::vector<double> values(data.residual[r].size(), 0.0);
  const BlockSeries series = series_of(data, {r}, block_of(data, found.members), 0.0, 1.0);
  const SlowModel base = part_of(data.model, {r});
  const double amplitude = found.parameters[0].estimate.value;
  const Telegraph found_telegraph{amplitude, found.parameters[1].estimate.value, 0.0};
  double most = -1e300;
  std::vector<double> side;
  for (const SlowModel& model : beside(base)) {
    const Telegraph telegraph = with_best_offset(series, model, found_telegraph);
    const double log_likelihood = telegraph_log_likelihood(series, model, telegraph);
    if (log_likelihood > most) {
      most = log_likelihood;
      side = telegraph_sides(series, model, telegraph, 0);
    }
  }
  for (std::size_t i = 0; i < values.size() && !side.empty(); ++i) {
    values[i] = amplitude * side[std::min(i / series.block, side.size() - 1)];
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
          .equation = "y = ± amplitude, each side held for a random time τ with P(τ longer than t) = exp(−t / dwell)",
          .family = SwitchingNoise{.find = find, .values = values_of},
          .rivals = {"gauss_markov", "flicker_noise", "random_walk", "bias_step"},
          .needs = "recordings at rest",
          .separates = "a longer recording at rest: its histogram has two tops",
          .parameters = {{"amplitude", units::level}, {"dwell_s", units::seconds}},
          .inject = inject_effect,
          .showing = {.values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
