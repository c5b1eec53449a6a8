#include "core/investigate/fullrate/full_rate.hpp"

#include "core/investigate/study/measured_constants.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace driftlab::investigate {
namespace {

constexpr std::size_t kOrder = 24;

/// Coefficients of an autoregression by Levinson's recursion on the pooled autocovariance of all recordings.
std::vector<double> fit_autoregression(const std::vector<std::vector<double>>& series,
                                       const std::vector<std::vector<unsigned char>>& used) {
  std::vector<double> covariance(kOrder + 1, 0.0);
  double samples = 0.0;
  for (std::size_t r = 0; r < series.size(); ++r) {
    // Gross values would stretch the covariance; clipping at 4 changes a Gaussian one by 1e-4.
    std::vector<double> x(series[r].size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = used[r][i] != 0 ? std::clamp(series[r][i], -4.0, 4.0) : 0.0;
      samples += used[r][i] != 0 ? 1.0 : 0.0;
    }
    for (std::size_t lag = 0; lag <= kOrder; ++lag) {
      double sum = 0.0;
      for (std::size_t i = lag; i < x.size(); ++i) {
        sum += x[i] * x[i - lag];
      }
      covariance[lag] += sum;
    }
  }
  std::vector<double> a(kOrder, 0.0);
  if (!(covariance[0] > 0.0) || samples < 50.0 * kOrder) {
    return {};
  }
  double error = covariance[0];
  for (std::size_t k = 0; k < kOrder; ++k) {
    double reflection = covariance[k + 1];
    for (std::size_t j = 0; j < k; ++j) {
      reflection -= a[j] * covariance[k - j];
    }
    reflection /= error;
    std::vector<double> next = a;
    next[k] = reflection;
    for (std::size_t j = 0; j < k; ++j) {
      next[j] = a[j] - reflection * a[k - 1 - j];
    }
    a = next;
    error *= 1.0 - reflection * reflection;
  }
  return a;
}

/// Samples that the autoregression cannot foresee as it does in the middle of a record: at its start and, where it
/// foresees much (`strong`), after every sample that is missing.
void leave_out_starts(std::vector<unsigned char>& used, bool strong) {
  std::size_t since = 0;
  for (unsigned char& u : used) {
    since = u == 0 && strong ? 0 : since + 1;
    u = since > kOrder ? u : 0;
  }
}

void whiten_further(FullRate& data) {
  const std::vector<double> a = fit_autoregression(data.innovation, data.used);
  if (a.empty()) {
    return;
  }
  data.further = a;
  double squares = 0.0;
  for (const double coefficient : a) {
    squares += coefficient * coefficient;
  }
  double square = 0.0;
  double count = 0.0;
  for (std::size_t r = 0; r < data.innovation.size(); ++r) {
    std::vector<double>& x = data.innovation[r];
    std::vector<double> e(x.size());
    leave_out_starts(data.used[r], squares > 0.1);
    for (std::size_t i = 0; i < x.size(); ++i) {
      double value = x[i];
      for (std::size_t k = 0; k < std::min(i, a.size()); ++k) {
        value -= a[k] * x[i - 1 - k];
      }
      e[i] = data.used[r][i] != 0 ? value : 0.0;
      if (data.used[r][i] != 0 && std::fabs(e[i]) < 4.0) {
        square += e[i] * e[i];
        count += 1.0;
      }
    }
    x = std::move(e);
  }
  if (!data.given && count > 0.0) {
    const double scale = 1.0 / std::sqrt(square / count);
    data.innovation_sd /= scale;
    for (auto& x : data.innovation) {
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

/// Samples that are left out, on a straight line between their neighbours: a spectrum needs them all.
std::vector<double> bridged(const std::vector<double>& values, const std::vector<unsigned char>& used) {
  std::vector<double> whole = values;
  for (std::size_t i = 0; i < whole.size();) {
    if (used[i] != 0) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < whole.size() && used[end] == 0) {
      ++end;
    }
    const double right = end < whole.size() ? whole[end] : i > 0 ? whole[i - 1] : 0.0;
    const double left = i > 0 ? whole[i - 1] : right;
    const auto steps = static_cast<double>(end - i + 1);
    for (std::size_t k = i; k < end; ++k) {
      whole[k] = left + (right - left) * static_cast<double>(k - i + 1) / steps;
    }
    i = end;
  }
  return whole;
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

void set_spectrum(FullRate& data, std::size_t r) {
  Spectrum& s = data.spectrum[r];
  s = estimate_spectrum(bridged(data.residual[r], data.used[r]), data.dt_s, 0.3);
  std::vector<double>& slow = data.slow[r];
  slow.clear();
  for (std::size_t j = 0; j < s.power.size(); ++j) {
    const double f = s.f_hz[j];
    slow.push_back(slow_density(data.model, data.samples, r, f, data.dt_s, static_cast<double>(s.samples)) +
                   data.quantization * quantization_shape(f, data.dt_s));
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
                           std::vector<std::vector<double>> residual,
                           const std::vector<std::vector<unsigned char>>& mask, const FullRateOptions& options) {
  FullRate data;
  data.study = &study;
  data.group = &group;
  data.given = options.given;
  data.lattice_step = options.lattice_step;
  data.quantization = options.quantization;
  data.dt_s = group.members.front().recording->dt_s;
  data.model = model;
  data.residual = std::move(residual);
  data.samples = average_blocks(group, mask, true);
  BlockColumns columns;
  columns.width = 1;
  columns.rows = data.residual;
  SlowModel filter = model;  // differenced noise counts as white here; the autoregression finds its colour
  filter.white += 2.0 * options.quantization / data.dt_s;
  const Whitened whitened = whiten(data.samples, filter, columns);
  double sum_s = 0.0;
  double steady = 0.0;
  std::size_t row = 0;
  for (std::size_t r = 0; r < data.members(); ++r) {
    data.innovation.push_back(whitened.columns.rows[r]);
    std::vector<unsigned char> used(data.residual[r].size());
    for (std::size_t i = 0; i < used.size(); ++i, ++row) {
      used[i] = data.samples.recordings[r].filled[i] > 0.0 ? 1 : 0;
      if (used[i] != 0) {
        sum_s += std::exp(whitened.log_var[row]);
        steady += 1.0;
      }
    }
    data.used.push_back(std::move(used));
  }
  data.white_share = std::clamp(model.white / data.dt_s / (sum_s / std::max(1.0, steady)), 0.05, 1.0);
  data.innovation_sd = std::sqrt(sum_s / std::max(1.0, steady));
  data.raised.assign(data.members(), 0.0);
  data.spectrum.resize(data.members());
  data.slow.resize(data.members());
  constexpr double kMostMissing = 0.005;
  for (std::size_t r = 0; r < data.members(); ++r) {
    const auto present = std::count(data.used[r].begin(), data.used[r].end(), 1);
    if (static_cast<double>(present) > (1.0 - kMostMissing) * static_cast<double>(data.used[r].size())) {
      set_spectrum(data, r);
    }
  }
  data.flat = spectra_fit(data);
  if (!data.flat && !data.given) {
    data.repeatability = 1.0 + 2.0 * steady / static_cast<double>(data.members()) * kLevelRepeats * kLevelRepeats;
  }
  if (options.whiten_further) {
    whiten_further(data);
  }
  return data;
}

}  // namespace driftlab::investigate
