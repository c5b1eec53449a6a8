#include "core/investigate/report/checks.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/search/thresholds.hpp"
#include "core/process/distributions.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

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
  return check;
}

struct Moments {
  double count = 0.0, mean_square = 0.0, kurtosis = 0.0;
};

Moments moments_of(const std::vector<double>& e, const std::vector<unsigned char>& used) {
  Moments m;
  double fourth = 0.0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    if (used[i] != 0) {
      const double square = e[i] * e[i];
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

/// A sum of squares, and of how many independent ones.
struct ChiSquare {
  double x = 0.0;
  double dof = 0.0;
};

/// Variance over sixteen segments about their common level; a heavy tail widens the scatter by 1 + kurtosis/2. A
/// segment with 20 samples in use or fewer has no say, and no degree of freedom.
ChiSquare segment_statistic(const std::vector<double>& e, const std::vector<unsigned char>& used, const Moments& all) {
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
ChiSquare whiteness_statistic(const std::vector<double>& e, double dt_s) {
  const auto block = static_cast<std::size_t>(std::max(1.0, std::round(1.0 / dt_s)));
  std::vector<double> mean(e.size() / block, 0.0);
  for (std::size_t b = 0; b < mean.size(); ++b) {
    mean[b] = std::accumulate(e.begin() + static_cast<std::ptrdiff_t>(b * block),
                              e.begin() + static_cast<std::ptrdiff_t>((b + 1) * block), 0.0);
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
double band_statistic(const std::vector<double>& e, double share) {
  constexpr std::size_t kBands = 16;
  const std::size_t length = fast_length(e.size());
  const auto z = transform(std::span(e).first(length), 0);
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
void wavelet_checks(const ChannelGroup::Member& member, const std::vector<double>& e,
                    const std::vector<unsigned char>& used, double dt_s, double mean_square,
                    std::vector<Check>& checks) {
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
    for (double* const value : {&check.observed, &check.q025, &check.median, &check.q975}) {
      *value /= count;  // as a ratio to the simulated variance
    }
    checks.push_back(std::move(check));
  }
}

void general_checks(const ChannelGroup& group, const FullRate& data, std::vector<Check>& checks) {
  for (std::size_t r = 0; r < data.members(); ++r) {
    const auto& member = group.members[r];
    const auto& e = data.innovation[r];
    const Moments all = moments_of(e, data.used[r]);
    if (all.count < 500.0 || !(all.mean_square > 0.0)) {
      continue;
    }
    const std::string stem = member.name() + ".";
    const auto add = [&](const char* name, const ChiSquare& statistic) {
      if (statistic.dof > 0.0) {
        checks.push_back(chi_square_check(stem + name, member, statistic.x, statistic.dof));
      }
    };
    add("variance_over_time", segment_statistic(e, data.used[r], all));
    add("whiteness", whiteness_statistic(e, data.dt_s));
    if (!data.spectrum[r].power.empty()) {
      // Beyond half its corner a band limit leaves what no finite autoregression whitens.
      const double share = data.band_limited() ? std::min(1.0, data.corner_hz * data.dt_s) : 1.0;
      checks.push_back(chi_square_check(stem + "spectrum", member, band_statistic(e, share), 15.0));
    }
    wavelet_checks(member, e, data.used[r], data.dt_s, data.given ? 1.0 : all.mean_square, checks);
    Check tails;
    tails.id = stem + "kurtosis";
    tails.recording = member.recording->id;
    tails.channel = member.channel->column;
    tails.observed = all.kurtosis;
    const double sd = std::sqrt(24.0 / all.count);
    tails.q025 = -1.96 * sd;
    tails.q975 = 1.96 * sd;
    tails.p = std::min(1.0, 2.0 * normal_tail(std::fabs(all.kurtosis) / sd));
    checks.push_back(tails);
  }
}

/// Holm's step-down adjustment over all of them.
void adjust(std::vector<Check>& checks) {
  std::vector<std::size_t> order(checks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return checks[a].p < checks[b].p; });
  double running = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    Check& check = checks[order[i]];
    running = std::max(running, std::min(1.0, check.p * static_cast<double>(order.size() - i)));
    check.p_adjusted = running;
    check.failed = running < 0.05;
  }
}

/// `causes`: how many such checks the study has.
Check cause_check(const Evidence& evidence, const ChannelGroup& group, std::size_t causes) {
  Check check;
  check.id = group.column + "." + std::string(evidence.cause->name);
  check.recording = evidence.members.size() == 1 ? group.members[evidence.members.front()].recording->id : "";
  check.channel = group.column;
  check.observed = evidence.gain;
  const double dof = std::max(1.0, evidence.freedom);
  check.q025 = chi_squared_quantile(0.025, dof);
  check.median = chi_squared_quantile(0.5, dof);
  check.q975 = chi_squared_quantile(0.975, dof);
  const bool shown = evidence.cause->as<FileFact>() != nullptr && evidence.score > kThreshold;
  const double any = 0.05 * std::exp(-0.5 * (evidence.score - kThreshold));
  check.p = shown ? 0.0 : std::clamp(any / static_cast<double>(causes), 0.0, 1.0);
  return check;
}

}  // namespace

void make_checks(const std::vector<ChannelGroup>& groups, const std::vector<GroupOutcome>& outcomes,
                 const std::vector<Evidence>& examined, Report& report) {
  std::vector<Check> before;
  std::vector<Check> after;
  double misfit = 0.0;
  double samples = 0.0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!outcomes[g].usable) {
      continue;
    }
    general_checks(groups[g], outcomes[g].before, before);
    general_checks(groups[g], outcomes[g].after, after);
    for (std::size_t r = 0; r < outcomes[g].after.members(); ++r) {
      const Moments m = moments_of(outcomes[g].after.innovation[r], outcomes[g].after.used[r]);
      misfit += 0.5 * m.count * (m.mean_square - 1.0);
      samples += m.count;
    }
  }
  report.misfit_after = samples > 0.0 ? misfit / samples : 0.0;
  for (const Evidence& evidence : examined) {
    before.push_back(cause_check(evidence, groups[evidence.group], examined.size()));
  }
  adjust(before);
  adjust(after);
  const auto failed = [](const std::vector<Check>& checks) {
    return static_cast<std::size_t>(
        std::count_if(checks.begin(), checks.end(), [](const Check& c) { return c.failed; }));
  };
  report.failed_before = failed(before);
  report.failed_after = failed(after);
  report.checks = std::move(before);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    Unexplained left{groups[g].column, "", {}};
    for (const Check& check : after) {
      const bool mine = check.channel == groups[g].column;
      if (mine && check.failed && check.p_adjusted < 0.01) {
        left.checks.push_back(check.id);
      }
    }
    if (!left.checks.empty()) {
      left.sentence = "The extended model does not describe " + groups[g].column +
                      ", and no cause of the list explains what is left.";
      report.unexplained.push_back(std::move(left));
    }
  }
}

std::vector<std::string> checks_behind(const Evidence& evidence, const std::vector<ChannelGroup>& groups,
                                       const Report& report) {
  std::vector<std::string> ids;
  const std::string own = groups[evidence.group].column + "." + std::string(evidence.cause->name);
  for (const Check& check : report.checks) {
    if (check.id == own && ids.empty()) {
      ids.push_back(check.id);
    }
  }
  for (const Check& check : report.checks) {
    const bool general = check.failed && check.channel == groups[evidence.group].column && check.id != own &&
                         std::any_of(evidence.members.begin(), evidence.members.end(), [&](std::size_t r) {
                           return r < groups[evidence.group].members.size() &&
                                  check.id.rfind(groups[evidence.group].members[r].name() + ".", 0) == 0;
                         });
    if (general) {
      ids.push_back(check.id);
    }
  }
  return ids;
}

}  // namespace driftlab::investigate
