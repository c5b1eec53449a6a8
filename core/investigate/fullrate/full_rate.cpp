#include "core/investigate/fullrate/full_rate.hpp"

#include "core/investigate/fullrate/autoregression.hpp"
#include "core/investigate/fullrate/gaps.hpp"
#include "core/investigate/slow/whitening_walk.hpp"
#include "core/investigate/study/measured_constants.hpp"
#include "core/signal/progress.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace driftlab::investigate {
namespace {

using Innovations = std::vector<std::vector<double>>;

/// Samples that the autoregression cannot foresee as it does in the middle of a record: at its start and, where it
/// foresees much (`strong`), after every sample that is missing.
void leave_out_starts(std::vector<unsigned char>& used, bool strong) {
  std::size_t since = 0;
  for (unsigned char& u : used) {
    since = u == 0 && strong ? 0 : since + 1;
    u = since > kAutoregressionOrder ? u : 0;
  }
}

void whiten_further(FullRate& data, Innovations& innovation) {
  PooledAutocovariance covariance;
  for (std::size_t r = 0; r < innovation.size(); ++r) {
    covariance.begin_recording();
    for (std::size_t i = 0; i < innovation[r].size() && !polled(data.stop, i); ++i) {
      covariance.take(innovation[r][i], data.used[r][i] != 0);
    }
  }
  const std::vector<double> a = covariance.autoregression();
  if (a.empty() || data.stopped()) {
    return;
  }
  data.further = a;
  double squares = 0.0;
  for (const double coefficient : a) {
    squares += coefficient * coefficient;
  }
  double square = 0.0;
  double count = 0.0;
  for (std::size_t r = 0; r < innovation.size(); ++r) {
    leave_out_starts(data.used[r], squares > 0.1);
    Recent recent;
    for (std::size_t i = 0; i < innovation[r].size() && !polled(data.stop, i); ++i) {
      const double x = innovation[r][i];
      double value = x;
      for (std::size_t k = 0; k < std::min(i, a.size()); ++k) {
        value -= a[k] * recent[k + 1];
      }
      recent.push(x);
      innovation[r][i] = data.used[r][i] != 0 ? value : 0.0;
      if (data.used[r][i] != 0 && std::fabs(value) < 4.0) {
        square += value * value;
        count += 1.0;
      }
    }
  }
  if (!data.given && count > 0.0) {
    const double scale = 1.0 / std::sqrt(square / count);
    data.innovation_sd /= scale;
    for (auto& x : innovation) {
      for (double& value : x) {
        value *= scale;
      }
    }
  }
}

/// Does white + slow describe the spectra? Coarse bins, one free level for all recordings (1 where given).
bool spectra_fit(const FullRate& data) {
  double chi2 = 0.0;
  double dof = 0.0;
  for (std::size_t r = 0; r < data.spectrum.size(); ++r) {
    const Spectrum& s = data.spectrum[r];
    double ratio = 0.0;
    double weight = 0.0;
    double total = 0.0;
    double total_weight = 0.0;
    for (std::size_t j = 0; j < s.power.size(); ++j) {
      total += s.weight[j] * s.power[j] / (data.model.white + data.slow[r][j]);
      total_weight += s.weight[j];
    }
    const double mean = total_weight > 0.0 ? total / total_weight : 1.0;
    for (std::size_t j = 0; j < s.power.size(); ++j) {
      ratio += s.weight[j] * s.power[j] / (data.model.white + data.slow[r][j]) / mean;
      weight += s.weight[j];
      if (weight > 400.0 || j + 1 == s.power.size()) {
        const double deviation = ratio / weight - 1.0;
        chi2 += weight * deviation * deviation;
        dof += 1.0;
        ratio = weight = 0.0;
      }
    }
  }
  return dof == 0.0 || (chi2 - dof) / std::sqrt(2.0 * dof) < 4.0;
}

/// Which samples of each member's analysed part are there and not masked.
std::vector<std::vector<unsigned char>> samples_in_use(const ChannelGroup& group,
                                                       const std::vector<std::vector<unsigned char>>& mask) {
  std::vector<std::vector<unsigned char>> all;
  for (std::size_t r = 0; r < group.members.size(); ++r) {
    const StudyRecording& recording = *group.members[r].recording;
    const Presence& valid = group.members[r].channel->valid;
    const bool masked = r < mask.size() && !mask[r].empty();
    const bool coarse = beside_coarse_reference(group.members[r]);
    std::vector<unsigned char>& used = all.emplace_back(recording.count());
    for (std::size_t i = 0; i < used.size(); ++i) {
      const std::size_t place = recording.begin + i;
      used[i] = !coarse && valid[place] != 0 && !(masked && mask[r][place] != 0) ? 1 : 0;
    }
  }
  return all;
}

/// Whether what gaps add at all frequencies alike is little even where the noise is weakest.
bool shows_colour(const Spectrum& s, const std::vector<double>& slow) {
  constexpr double kLittle = 0.1;  // Chosen, not measured: of the power where it is weakest.
  constexpr double kCells = 30.0;  // whose mean is the power at a frequency
  double beside = 0.0;             // power beside the slow part
  double all = 0.0;
  double weakest = std::numeric_limits<double>::infinity();
  double sum = 0.0;
  double weight = 0.0;
  for (std::size_t j = 0; j < s.power.size(); ++j) {
    beside += s.weight[j] * std::max(0.0, s.power[j] - slow[j]);
    all += s.weight[j];
    sum += s.weight[j] * s.power[j];
    weight += s.weight[j];
    if (weight >= kCells) {
      weakest = std::min(weakest, sum / weight);
      sum = weight = 0.0;
    }
  }
  return s.broken * beside < kLittle * weakest * all;
}

/// The spectrum of member r, of whose samples `missing` are, if it is one of the noise and not of the gaps.
void take_spectrum(FullRate& data, std::size_t r, double missing) {
  constexpr double kFew = 0.005;   // Chosen, not measured: bridges of so few samples hardly show.
  constexpr double kMost = 0.125;  // Chosen, not measured: whole pieces to fill gaps with become rare beyond it.
  if (!(missing < kMost)) {
    return;
  }
  if (data.stopped()) {
    return;
  }
  set_spectrum(data, r);
  if (missing >= kFew && !shows_colour(data.spectrum[r], data.slow[r])) {
    data.spectrum[r] = {};
    data.slow[r].clear();
  }
}

/// Sum over samples in use of the variances of their innovations.
struct Spread {
  double variances = 0.0;
  double samples = 0.0;
};

/// The innovations of one member under the filter of `states`, each divided by its deviation.
std::vector<double> innovations_of(const Series& residual, const std::vector<unsigned char>& used,
                                   const BlockStates& states, const std::stop_token& stop, Spread& spread) {
  const bool uniform = std::all_of(used.begin(), used.end(), [&](unsigned char u) { return u == used[0]; });
  WhiteningWalk walk(states, uniform, 1);
  std::vector<double> innovation(residual.size());
  double last = -1.0;
  double variance = 0.0;
  for (std::size_t i = 0; i < innovation.size() && !polled(stop, i); ++i) {
    walk.next(used[i] != 0 ? 1.0 : 0.0);
    innovation[i] = walk.whitened(0, residual[i]);
    if (used[i] != 0) {
      if (walk.variance() != last) {
        last = walk.variance();
        variance = std::exp(walk.inv_sd() > 0.0 ? std::log(last) : 0.0);
      }
      spread.variances += variance;
      spread.samples += 1.0;
    }
  }
  return innovation;
}

/// Innovations of all members, and what their variances say.
Innovations whitened(FullRate& data, const FullRateOptions& options) {
  SlowModel filter = data.model;  // differenced noise counts as white here; the autoregression finds its colour
  filter.white += 2.0 * options.quantization / data.dt_s;
  double longest_s = 0.0;
  for (const Series& residual : data.residual) {
    longest_s = std::max(longest_s, data.dt_s * static_cast<double>(residual.size()));
  }
  Innovations innovation;
  Spread spread;
  for (std::size_t r = 0; r < data.members(); ++r) {
    const StudyRecording& recording = *data.group->members[r].recording;
    const Blocks blocks{data.dt_s, 1, recording.time_s(recording.begin), longest_s};
    SlowModel own = filter;
    own.white *= 1.0 + noise_of_reference(data.group->members[r]);
    const BlockStates states = block_states(own, blocks, r);
    innovation.push_back(innovations_of(data.residual[r], data.used[r], states, data.stop, spread));
  }
  if (data.stopped()) {
    return innovation;
  }
  const double mean = spread.variances / std::max(1.0, spread.samples);
  data.white_share = std::clamp(data.model.white / data.dt_s / mean, 0.05, 1.0);
  data.innovation_sd = std::sqrt(mean);
  return innovation;
}

}  // namespace

std::vector<std::size_t> all_members(const ChannelGroup& group) {
  std::vector<std::size_t> members(group.members.size());
  std::iota(members.begin(), members.end(), std::size_t{0});
  return members;
}

std::vector<std::size_t> moving_members(const ChannelGroup& group) {
  std::vector<std::size_t> members;
  for (std::size_t r = 0; r < group.members.size(); ++r) {
    if (!group.members[r].recording->is_static()) {
      members.push_back(r);
    }
  }
  return members;
}

std::vector<std::vector<std::size_t>> noise_scopes(const ChannelGroup& group, bool given) {
  std::vector<std::vector<std::size_t>> scopes;
  if (given) {
    scopes.push_back(all_members(group));
  }
  const std::size_t members = group.members.size();
  const auto moving = moving_members(group);
  if (moving.size() > 1 && moving.size() < members) {
    scopes.push_back(moving);
  }
  if (members > 1) {
    const bool one_rests = !given && moving.size() + 1 == members;
    for (std::size_t r = 0; r < members; ++r) {
      if (!one_rests || !group.members[r].recording->is_static()) {
        scopes.push_back({r});
      }
    }
  }
  return scopes;
}

void set_spectrum(FullRate& data, std::size_t r, double f_low_hz) {
  Spectrum& s = data.spectrum[r];
  constexpr double kBeside = 2.0;  // [s] Chosen: what it raises lies below the frequencies that are looked at.
  const auto beside = static_cast<std::size_t>(std::max(1.0, kBeside / data.dt_s));
  const FilledGaps whole = fill_gaps(data.residual[r], data.used[r], beside);
  s = estimate_spectrum(whole.values, data.dt_s, f_low_hz, data.stop);
  s.broken = whole.broken;
  std::vector<double>& slow = data.slow[r];
  slow.clear();
  for (std::size_t j = 0; j < s.power.size(); ++j) {
    const double f = s.f_hz[j];
    slow.push_back(slow_density(data.model, r, f, data.dt_s, static_cast<double>(s.samples)) +
                   data.quantization * quantization_shape(f, data.dt_s) +
                   (data.colour.peak ? data.colour.peak(r, f) : 0.0));
    const double base = data.model.white + slow[j];
    s.power[j] *= base / std::max(0.05 * base, base + data.raised[r]);
  }
}

void renew_spectrum(FullRate& data, std::size_t r) {
  if (!data.spectrum[r].power.empty()) {
    set_spectrum(data, r);
  }
}

FullRate look_at_full_rate(const Study& study, const ChannelGroup& group, const SlowModel& model,
                           std::vector<Series> residual, const std::vector<std::vector<unsigned char>>& mask,
                           const FullRateOptions& options) {
  FullRate data;
  data.study = &study;
  data.group = &group;
  data.given = options.given;
  data.lattice_step = options.lattice_step;
  data.quantization = options.quantization;
  data.colour = options.colour;
  data.stop = options.stop;
  data.dt_s = group.members.front().recording->dt_s;
  data.model = model;
  data.residual = std::move(residual);
  data.used = samples_in_use(group, mask);
  for (const ChannelGroup::Member& member : group.members) {
    data.raised.push_back(model.white * noise_of_reference(member));
  }
  data.spectrum.resize(data.members());
  data.slow.resize(data.members());
  double samples = 0.0;
  for (std::size_t r = 0; r < data.members(); ++r) {
    const auto present = static_cast<double>(std::count(data.used[r].begin(), data.used[r].end(), 1));
    samples += present;
    take_spectrum(data, r, 1.0 - present / static_cast<double>(data.used[r].size()));
  }
  data.flat = spectra_fit(data);
  if (!data.flat && !data.given) {
    data.repeatability = 1.0 + 2.0 * samples / static_cast<double>(data.members()) * kLevelRepeats * kLevelRepeats;
  }
  if (!options.innovations) {
    return data;
  }
  Innovations innovation = whitened(data, options);
  if (options.whiten_further) {
    whiten_further(data, innovation);
  }
  for (std::vector<double>& own : innovation) {
    data.innovation.emplace_back(std::move(own));
  }
  return data;
}

}  // namespace driftlab::investigate
