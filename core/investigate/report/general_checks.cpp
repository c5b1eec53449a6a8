#include "core/investigate/report/general_checks.hpp"

#include "core/process/distributions.hpp"
#include "core/signal/significant.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace driftlab::investigate {
namespace {

Check chi_square_check(std::string id, const ChannelGroup::Member& member, double x, double dof) {
  Check check;
  check.id = std::move(id);
  check.recording = member.recording->id;
  check.channel = member.channel->column;
  check.observed = x;
  check.q025 = chi_squared_quantile(0.025, dof);
  check.median = chi_squared_quantile(0.5, dof);
  check.q975 = chi_squared_quantile(0.975, dof);
  check.p = chi_squared_tail(x, dof);
  check.excess = std::max(0.0, 0.5 * (x - dof));
  return check;
}

using Moments = InnovationMoments;

}  // namespace

InnovationMoments moments_of(const Series& e, const std::vector<unsigned char>& used, double cut) {
  Moments m;
  double fourth = 0.0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    if (used[i] != 0) {
      const double value = std::clamp(e[i], -cut, cut);
      const double square = value * value;
      m.count += 1.0;
      m.mean_square += square;
      fourth += square * square;
    }
  }
  if (m.count > 0.0 && m.mean_square > 0.0) {
    m.mean_square /= m.count;
    m.kurtosis = fourth / m.count / (m.mean_square * m.mean_square) - 3.0;
  }
  return m;
}

namespace {

/// A sum of squares, and of how many independent ones.
struct ChiSquare {
  double x = 0.0;
  double dof = 0.0;
};

/// Variance over sixteen segments about their common level; a heavy tail widens the scatter by 1 + kurtosis/2. A
/// segment with 20 samples in use or fewer has no say, and no degree of freedom.
ChiSquare segment_statistic(const Series& e, const std::vector<unsigned char>& used, const Moments& all) {
  // Of the record, for the variance over time. Chosen, not measured: as many degrees of freedom but one.
  constexpr std::size_t kSegments = 16;
  double sum = 0.0;
  double segments = 0.0;
  for (std::size_t s = 0; s < kSegments; ++s) {
    double square = 0.0;
    double count = 0.0;
    for (std::size_t i = s * e.size() / kSegments; i < (s + 1) * e.size() / kSegments; ++i) {
      square += used[i] != 0 ? e[i] * e[i] : 0.0;
      count += used[i] != 0 ? 1.0 : 0.0;
    }
    if (count > 20.0) {
      const double deviation = square / count / all.mean_square - 1.0;
      sum += 0.5 * count * deviation * deviation;
      segments += 1.0;
    }
  }
  return {sum / std::max(0.5, 1.0 + 0.5 * all.kurtosis), segments - 1.0};
}

/// Correlations of one-second means of the innovations at lags 1 to 10, or as many as there are (Ljung and Box).
ChiSquare whiteness_statistic(const Series& e, double dt_s) {
  const auto block = static_cast<std::size_t>(std::max(1.0, std::round(1.0 / dt_s)));
  std::vector<double> mean(e.size() / block, 0.0);
  for (std::size_t b = 0; b < mean.size(); ++b) {
    for (std::size_t i = b * block; i < (b + 1) * block; ++i) {
      mean[b] += e[i];
    }
  }
  double zero = 0.0;
  for (const double m : mean) {
    zero += m * m;
  }
  const auto n = static_cast<double>(mean.size());
  double sum = 0.0;
  double lags = 0.0;
  for (std::size_t lag = 1; lag <= 10 && lag < mean.size(); ++lag) {
    double c = 0.0;
    for (std::size_t i = lag; i < mean.size(); ++i) {
      c += mean[i] * mean[i - lag];
    }
    sum += n * (n + 2.0) / (n - static_cast<double>(lag)) * c * c / (zero * zero);
    lags += 1.0;
  }
  return {sum, lags};
}

/// Spectrum of the innovations in sixteen bands of equal width up to a share of the Nyquist frequency, against their
/// mean.
double band_statistic(const Series& e, double share) {
  // Of the spectrum, likewise. Chosen, not measured.
  constexpr std::size_t kBands = 16;
  const std::size_t length = fast_length(e.size());
  const auto z = half_spectrum_of(e.part(0, length));
  std::vector<double> band(kBands, 0.0);
  std::vector<double> count(kBands, 0.0);
  double total = 0.0;
  const std::size_t last =
      std::max<std::size_t>(kBands, static_cast<std::size_t>(share * static_cast<double>(z.size() - 2)));
  for (std::size_t k = 1; k <= last; ++k) {
    const std::size_t b = (k - 1) * kBands / last;
    band[b] += std::norm(z[k]);
    count[b] += 1.0;
    total += std::norm(z[k]);
  }
  total /= static_cast<double>(last);
  double sum = 0.0;
  for (std::size_t b = 0; b < kBands; ++b) {
    const double deviation = band[b] / count[b] / total - 1.0;
    sum += count[b] * deviation * deviation;
  }
  return sum;
}

/// Wavelet variance of the innovations per scale: under a right model Haar coefficients of 2^j innovations are standard
/// normal and independent, so that their sum of squares is chi-square; too much and too little both count.
void wavelet_checks(const ChannelGroup::Member& member, const Series& e, const std::vector<unsigned char>& used,
                    double dt_s, double mean_square, std::vector<Check>& checks) {
  std::vector<double> sum(e.size());
  std::vector<double> kept(e.size());
  for (std::size_t i = 0; i < e.size(); ++i) {
    sum[i] = used[i] != 0 ? e[i] : 0.0;
    kept[i] = used[i] != 0 ? 1.0 : 0.0;
  }
  for (double length = 2.0; sum.size() >= 32; length *= 2.0) {
    double square = 0.0;
    double count = 0.0;
    const std::size_t pairs = sum.size() / 2;
    for (std::size_t k = 0; k < pairs; ++k) {
      const double present = kept[2 * k] + kept[2 * k + 1];
      const double d = sum[2 * k + 1] - sum[2 * k];
      if (present > 0.9 * length) {
        square += d * d / present;
        count += 1.0;
      }
      sum[k] = sum[2 * k] + sum[2 * k + 1];
      kept[k] = present;
    }
    sum.resize(pairs);
    kept.resize(pairs);
    if (count < 16.0 || length < 4.0) {  // pairs of samples are what `spectrum` looks at
      continue;
    }
    char name[48];
    std::snprintf(name, sizeof name, ".wavelet_variance_%.3gs", length * dt_s);
    const double x = square / mean_square;
    Check check = chi_square_check(member.name() + name, member, x, count);
    check.p = std::min(1.0, 2.0 * std::min(check.p, 1.0 - check.p));
    check.excess = std::max(0.0, 0.5 * (x - count - count * std::log(std::max(1e-12, x / count))) - 0.5);
    check.scale_s = length * dt_s;
    check.of_spectrum = true;
    check.title = "wavelet variance at " + significant(length * dt_s) + " s";
    for (double* const value : {&check.observed, &check.q025, &check.median, &check.q975}) {
      *value /= count;  // as a ratio to the simulated variance
    }
    checks.push_back(std::move(check));
  }
}

/// Fourth cumulant that rounding to multiples of `step` gives a normal variate, [SI^4].
double cumulant_of_rounding(double mean, double sd, double step) {
  const auto below = [&](double x) { return 1.0 - normal_tail((x - mean) / sd); };
  const double nearest = std::round(mean / step);
  const double reach = std::ceil(9.0 * sd / step) + 1.0;
  double second = 0.0;
  double fourth = 0.0;
  double first = 0.0;
  for (double k = nearest - reach; k <= nearest + reach; k += 1.0) {
    first += (below((k + 0.5) * step) - below((k - 0.5) * step)) * (k * step - mean);
  }
  for (double k = nearest - reach; k <= nearest + reach; k += 1.0) {
    const double chance = below((k + 0.5) * step) - below((k - 0.5) * step);
    const double square = std::pow(k * step - mean - first, 2.0);
    second += chance * square;
    fourth += chance * square * square;
  }
  return fourth - 3.0 * second * second;
}

/// The same for member r of the data: that of a uniform error, -step^4/120, unless the lattice is coarse against noise
/// that stands in one place of it (a constant reference and hardly any slow noise).
double cumulant_of_lattice(const FullRate& data, std::size_t r) {
  // Steps of the lattice over the standard deviation. Chosen, not measured: coarser values are no longer close to
  // normal.
  constexpr double kCoarse = 1.2;
  constexpr double kStill = 0.95;
  const Channel& channel = *data.group->members[r].channel;
  const double step = data.lattice_step;
  const double sd = std::sqrt(std::max(0.0, data.model.white / data.dt_s - step * step / 12.0));
  if (!channel.reference.empty() || data.white_share < kStill || !(sd > 0.1 * step) || step < kCoarse * sd) {
    return -std::pow(step, 4.0) / 120.0;
  }
  const std::size_t begin = data.group->members[r].recording->begin;
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < data.used[r].size(); ++i) {
    sum += data.used[r][i] != 0 ? channel.measured[begin + i] : 0.0;
    count += data.used[r][i] != 0 ? 1.0 : 0.0;
  }
  return cumulant_of_rounding(sum / std::max(1.0, count), sd, step);
}

/// Excess kurtosis of the innovations of member r, of which a part is not normal: rounding to the file's lattice and
/// the differenced noise of the model. A sum of independent parts of weights c and fourth cumulants k has the excess
/// sum(c^4 k) over the square of its variance; of a uniform variate of variance s^2 it is -6/5.
double uniform_kurtosis(const FullRate& data, std::size_t r) {
  std::vector<double> filter{1.0};  // from samples to innovations, beyond the Kalman filter's slow part
  for (const double a : data.further) {
    filter.push_back(-a);
  }
  double rounding = 0.0;
  double differenced = 0.0;
  for (std::size_t k = 0; k <= filter.size(); ++k) {
    const double here = k < filter.size() ? filter[k] : 0.0;
    const double step = here - (k > 0 ? filter[k - 1] : 0.0);
    rounding += std::pow(here, 4.0);
    differenced += std::pow(step, 4.0);
  }
  const double variance = data.innovation_sd * data.innovation_sd;
  const double of_lattice = data.lattice_step > 0.0 ? cumulant_of_lattice(data, r) / (variance * variance) : 0.0;
  const double of_noise = data.quantization / (data.dt_s * data.dt_s) / variance;
  return of_lattice * rounding - 1.2 * of_noise * of_noise * differenced;
}

/// Do all recordings keep one level? Their mean squares against that of all, or against 1 under a given baseline, gross
/// values cut at five; tails widen the scatter, and where no model describes the spectra the level repeats only so well
/// (FullRate::repeatability).
void add_level_check(const ChannelGroup& group, const FullRate& data, std::vector<Check>& checks) {
  std::vector<Moments> each;
  double square = 0.0;
  double count = 0.0;
  for (std::size_t r = 0; r < data.members(); ++r) {
    each.push_back(moments_of(data.innovation[r], data.used[r], 5.0));
    square += each.back().mean_square * each.back().count;
    count += each.back().count;
  }
  const double level = data.given || !(count > 0.0) ? 1.0 : square / count;
  double sum = 0.0;
  double dof = data.given ? 0.0 : -1.0;
  for (const Moments& m : each) {
    if (m.count >= 500.0 && level > 0.0) {
      const double deviation = m.mean_square / level - 1.0;
      sum += 0.5 * m.count * deviation * deviation / std::max(0.5, 1.0 + 0.5 * m.kurtosis) / data.repeatability;
      dof += 1.0;
    }
  }
  if (dof < 1.0) {
    return;
  }
  Check check = chi_square_check(group.column + ".level", group.members.front(), sum, dof);
  check.recording.clear();
  check.title = data.given ? "noise level" : "noise level between recordings";
  checks.push_back(std::move(check));
}

}  // namespace

void general_checks(const ChannelGroup& group, const FullRate& data, std::vector<Check>& checks) {
  for (std::size_t r = 0; r < data.members(); ++r) {
    const auto& member = group.members[r];
    const auto& e = data.innovation[r];
    const Moments all = moments_of(e, data.used[r]);
    if (all.count < 500.0 || !(all.mean_square > 0.0)) {
      continue;
    }
    const std::string stem = member.name() + ".";
    const auto add = [&](const char* name, const char* title, const ChiSquare& statistic, bool of_slow_misfit = false) {
      if (statistic.dof > 0.0) {
        checks.push_back(chi_square_check(stem + name, member, statistic.x, statistic.dof));
        checks.back().title = title;
        checks.back().of_slow_misfit = of_slow_misfit;
      }
    };
    add("variance_over_time", "variance over time", segment_statistic(e, data.used[r], all));
    add("whiteness", "correlation of one-second means", whiteness_statistic(e, data.dt_s), true);
    if (!data.spectrum[r].power.empty()) {
      // Beyond half its corner a band limit leaves what no finite autoregression whitens.
      const double share = data.colour.band_limited() ? std::min(1.0, data.colour.corner_hz * data.dt_s) : 1.0;
      add("spectrum", "spectrum in sixteen bands", {band_statistic(e, share), 15.0});
      checks.back().of_spectrum = true;
    }
    wavelet_checks(member, e, data.used[r], data.dt_s, data.given ? 1.0 : all.mean_square, checks);
    Check tails;
    tails.id = stem + "kurtosis";
    tails.title = "tails of the distribution";
    tails.recording = member.recording->id;
    tails.channel = member.channel->column;
    tails.observed = all.kurtosis;
    const double sd = std::sqrt(24.0 / all.count);
    tails.median = uniform_kurtosis(data, r);
    tails.q025 = tails.median - kNormal975 * sd;
    tails.q975 = tails.median + kNormal975 * sd;
    const double z = (all.kurtosis - tails.median) / sd;
    tails.p = std::min(1.0, 2.0 * normal_tail(std::fabs(z)));
    tails.excess = std::max(0.0, 0.5 * (z * z - 1.0));
    checks.push_back(tails);
  }
  add_level_check(group, data, checks);
}

}  // namespace driftlab::investigate
