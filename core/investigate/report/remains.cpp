#include "core/investigate/report/remains.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/fullrate/fourier.hpp"
#include "core/investigate/fullrate/spectrum.hpp"
#include "core/investigate/report/dependence.hpp"
#include "core/investigate/report/uneven_codes.hpp"
#include "core/process/distributions.hpp"
#include "core/process/random.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numeric>
#include <span>
#include <utility>

namespace driftlab::investigate {
namespace {

constexpr std::size_t kFewest = 500;  ///< samples of a recording that is looked at

/// How many of some values lie below one of them. A table of equal steps says where to look, for a search among
/// millions of values waits for memory at every halving.
class Ranks {
 public:
  explicit Ranks(std::vector<double> values) : sorted_(std::move(values)) {
    constexpr std::size_t kValuesAStep = 8;
    std::sort(sorted_.begin(), sorted_.end());
    first_.assign(sorted_.size() / kValuesAStep + 2, 0);
    const double range = sorted_.empty() ? 0.0 : sorted_.back() - sorted_.front();
    steps_by_value_ = range > 0.0 ? static_cast<double>(first_.size() - 2) / range : 0.0;
    for (const double value : sorted_) {
      ++first_[step_of(value) + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
  }
  [[nodiscard]] std::size_t count() const { return sorted_.size(); }
  [[nodiscard]] std::size_t below(double value) const {
    const std::size_t step = step_of(value);
    const auto begin = sorted_.begin() + static_cast<std::ptrdiff_t>(first_[step]);
    const auto end = sorted_.begin() + static_cast<std::ptrdiff_t>(first_[step + 1]);
    return static_cast<std::size_t>(std::lower_bound(begin, end, value) - sorted_.begin());
  }

 private:
  [[nodiscard]] std::size_t step_of(double value) const {
    return std::min(static_cast<std::size_t>((value - sorted_.front()) * steps_by_value_), first_.size() - 2);
  }
  std::vector<double> sorted_;
  std::vector<std::size_t> first_;  ///< by step, of the values in it; behind the last the count
  double steps_by_value_ = 0.0;
};

/// The normal quantile of each innovation's rank among all of the channel; 0 where one is not in use.
std::vector<std::vector<double>> normal_scores(const FullRate& data) {
  const double step = data.lattice_step / std::max(1e-300, data.innovation_sd);
  const auto walk = [&](const auto& take) {  // the same random numbers every time
    Random random(1, 17);
    for (std::size_t r = 0; r < data.members(); ++r) {
      for (std::size_t i = 0; i < data.innovation[r].size(); ++i) {
        if (data.used[r][i] != 0) {
          take(r, i, data.innovation[r][i] + step * (random.uniform() - 0.5));
        }
      }
    }
  };
  std::size_t samples = 0;
  for (const Series& e : data.innovation) {
    samples += e.size();
  }
  std::vector<double> all;
  all.reserve(samples);
  walk([&](std::size_t, std::size_t, double value) { all.push_back(value); });
  const Ranks ranks(std::move(all));
  std::vector<std::vector<double>> scores;
  for (std::size_t r = 0; r < data.members(); ++r) {
    scores.emplace_back(data.innovation[r].size(), 0.0);
  }
  walk([&](std::size_t r, std::size_t i, double value) {
    scores[r][i] =
        normal_quantile((static_cast<double>(ranks.below(value)) + 0.5) / static_cast<double>(ranks.count()));
  });
  return scores;
}

double surprise_of(double mean, double ordinates, double share) {
  return mean > 0.0 ? ordinates * (mean - 1.0 - std::log(mean)) / std::max(0.1, 1.0 - share) : 0.0;
}

/// Frames of about a second, power by ordinate in units of its mean over the recording; sums over time and frequency.
class Tiles {
 public:
  Tiles(const std::vector<double>& score, const std::vector<unsigned char>& used, double dt_s) : dt_s_(dt_s) {
    samples_ = fast_length(static_cast<std::size_t>(std::max(32.0, std::round(1.0 / dt_s))));
    const std::size_t bins = samples_ / 2 - 1;
    std::vector<std::vector<double>> power;
    for (std::size_t from = 0; from + samples_ <= score.size(); from += samples_) {
      const auto part = std::span(used).subspan(from, samples_);
      const auto present = static_cast<double>(std::count(part.begin(), part.end(), 1));
      if (present < 0.9 * static_cast<double>(samples_)) {
        continue;
      }
      const auto z = half_spectrum_of(Series::view(std::span(score).subspan(from, samples_)));
      std::vector<double> row(bins);
      for (std::size_t k = 0; k < bins; ++k) {
        row[k] = std::norm(z[k + 1]) / present;
      }
      power.push_back(std::move(row));
      start_s_.push_back(static_cast<double>(from) * dt_s);
    }
    frames_ = power.size();
    sum_.assign(frames_ + 1, std::vector<double>(bins + 1, 0.0));
    for (std::size_t k = 0; k < bins; ++k) {
      double mean = 0.0;
      for (const auto& row : power) {
        mean += row[k] / static_cast<double>(frames_);
      }
      for (std::size_t f = 0; f < frames_; ++f) {
        const double own = mean > 0.0 ? power[f][k] / mean : 1.0;
        sum_[f + 1][k + 1] = sum_[f][k + 1] + sum_[f + 1][k] - sum_[f][k] + own;
      }
    }
    bins_ = bins;
  }

  /// The most surprising tile.
  [[nodiscard]] Remainder strongest(const std::string& name) const {
    Remainder best;
    if (frames_ < 16) {
      return best;
    }
    double tiles = 0.0;
    for (std::size_t parts = 2; parts <= 64 && parts * 4 <= frames_; parts *= 2) {
      for (std::size_t t = 0; t < parts; ++t) {
        for (std::size_t bands = 1; bands <= 32 && bands * 2 <= bins_; bands *= 2) {
          for (std::size_t b = 0; b < bands; ++b) {
            tiles += 1.0;
            look(t * frames_ / parts, (t + 1) * frames_ / parts, b * bins_ / bands, (b + 1) * bins_ / bands, name,
                 best);
          }
        }
      }
    }
    best.places = tiles;
    return best;
  }

 private:
  void look(std::size_t from, std::size_t to, std::size_t low, std::size_t high, const std::string& name,
            Remainder& best) const {
    const auto ordinates = static_cast<double>((to - from) * (high - low));
    const double sum = sum_[to][high] - sum_[from][high] - sum_[to][low] + sum_[from][low];
    const double share = static_cast<double>(to - from) / static_cast<double>(frames_);
    const double mean = sum / ordinates;
    const double surprise = surprise_of(mean, ordinates, share);
    if (surprise <= best.observed) {
      return;
    }
    const double hz = 1.0 / (static_cast<double>(samples_) * dt_s_);
    best.observed = surprise;
    best.sentence = name + ": from " + three_digits(start_s_[from]) + " to " +
                    three_digits(start_s_[to - 1] + static_cast<double>(samples_) * dt_s_) + " s the noise between " +
                    three_digits(static_cast<double>(low + 1) * hz) + " and " +
                    three_digits(static_cast<double>(high) * hz) + " Hz has " + three_digits(mean) +
                    " times its usual power";
  }

  double dt_s_;
  std::size_t samples_ = 0;
  std::size_t frames_ = 0;
  std::size_t bins_ = 0;
  std::vector<double> start_s_;
  std::vector<std::vector<double>> sum_;
};

/// The mean of the scores over dyadic intervals.
Remainder mean_over_time(const std::vector<double>& score, double dt_s, const std::string& name) {
  std::vector<double> sum(score.size() + 1, 0.0);
  for (std::size_t i = 0; i < score.size(); ++i) {
    sum[i + 1] = sum[i] + score[i];
  }
  Remainder best;
  for (std::size_t parts = 2; parts <= 256 && parts * 32 <= score.size(); parts *= 2) {
    for (std::size_t k = 0; k < parts; ++k) {
      const std::size_t from = k * score.size() / parts;
      const std::size_t to = (k + 1) * score.size() / parts;
      const auto n = static_cast<double>(to - from);
      const double mean = (sum[to] - sum[from]) / n - sum.back() / static_cast<double>(score.size());
      const double surprise = 0.5 * n * mean * mean / (1.0 - 1.0 / static_cast<double>(parts));
      best.places += 1.0;
      if (surprise > best.observed) {
        best.observed = surprise;
        best.sentence = name + ": from " + three_digits(static_cast<double>(from) * dt_s) + " to " +
                        three_digits(static_cast<double>(to) * dt_s) + " s the mean is off by " + three_digits(mean) +
                        " of the sample noise, beyond what the slow noise of the model does";
      }
    }
  }
  return best;
}

/// Periodogram of the squared scores less their mean; samples that are not in use say nothing, wherever they stand.
Remainder line_in_variance(const std::vector<double>& score, const std::vector<unsigned char>& used, double dt_s,
                           const std::string& name) {
  const std::size_t n = fast_length(score.size());
  double mean = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    mean += used[i] != 0 ? score[i] * score[i] : 0.0;
    count += used[i] != 0 ? 1.0 : 0.0;
  }
  mean /= std::max(1.0, count);
  const auto beyond = [&](std::size_t i) { return used[i] != 0 ? score[i] * score[i] - mean : 0.0; };
  double variance = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double v = beyond(i);
    variance += v * v / static_cast<double>(n);
  }
  const auto z = half_spectrum(n, beyond);
  // Cycles in the recording of the slowest swelling looked for: slower ones are steps and drifts. Chosen, not measured.
  constexpr std::size_t kFirst = 8;
  Remainder best;
  best.places = static_cast<double>(z.size());
  for (std::size_t k = kFirst; k + 1 < z.size() && variance > 0.0; ++k) {
    const double surprise = std::norm(z[k]) / static_cast<double>(n) / variance;
    if (surprise > best.observed) {
      const double f_hz = static_cast<double>(k) / (static_cast<double>(n) * dt_s);
      best.observed = surprise;
      best.period_s = 1.0 / f_hz;
      best.sentence = name + ": the noise swells and fades at " + three_digits(f_hz) + " Hz";
    }
  }
  return best;
}

Remainder skewness(const FullRate& data, const std::string& name) {
  double count = 0.0;
  double second = 0.0;
  double third = 0.0;
  double sixth = 0.0;
  for (std::size_t r = 0; r < data.members(); ++r) {
    for (std::size_t i = 0; i < data.innovation[r].size(); ++i) {
      if (data.used[r][i] != 0) {
        const double e = std::clamp(data.innovation[r][i], -6.0, 6.0);
        count += 1.0;
        second += e * e;
        third += e * e * e;
        sixth += e * e * e * e * e * e;
      }
    }
  }
  Remainder best;
  if (count < 500.0) {
    return best;
  }
  // For unit variance e^3 - 3 e is free of the mean; its variance is E e^6 - 9 for any symmetric law near the normal.
  const double scale = std::sqrt(second / count);
  const double skew = third / count / (scale * scale * scale);
  const double spread = std::max(6.0, sixth / count / std::pow(scale, 6.0) - 9.0);
  const double z = skew / std::sqrt(spread / count);
  best.observed = 0.5 * z * z;
  best.sentence = name + ": errors to one side are larger than to the other (skewness " + three_digits(skew) + ")";
  return best;
}

/// Coherence of two series, cut at four deviations, in dyadic bands, beyond the correlation that is known of them.
Remainder between(const Series& a, const Series& b, double known, double dt_s, const std::string& name) {
  const std::size_t n = fast_length(std::min(a.size(), b.size()));
  const auto cut = [](const Series& values, std::size_t i) { return std::min(4.0, std::max(-4.0, values[i])); };
  const auto x = half_spectrum(n, [&](std::size_t i) { return cut(a, i); });
  const auto y = half_spectrum(n, [&](std::size_t i) { return cut(b, i) - known * cut(a, i); });
  Remainder best;
  for (std::size_t bands = 1; bands <= 16; bands *= 2) {
    for (std::size_t k = 0; k < bands; ++k) {
      const std::size_t from = std::max<std::size_t>(1, k * (x.size() - 1) / bands);
      const std::size_t to = (k + 1) * (x.size() - 1) / bands;
      std::complex<double> cross = 0.0;
      double xx = 0.0;
      double yy = 0.0;
      for (std::size_t i = from; i < to; ++i) {
        cross += x[i] * std::conj(y[i]);
        xx += std::norm(x[i]);
        yy += std::norm(y[i]);
      }
      best.places += 1.0;
      if (to < from + 8 || !(xx > 0.0) || !(yy > 0.0)) {
        continue;
      }
      const double coherence = std::norm(cross) / xx / yy;
      const double surprise = static_cast<double>(to - from) * coherence;
      if (surprise > best.observed) {
        const double hz = 1.0 / (static_cast<double>(n) * dt_s);
        best.observed = surprise;
        best.sentence = name + ": the two share " + three_digits(100.0 * std::sqrt(coherence)) +
                        " % of their noise between " + three_digits(static_cast<double>(from) * hz) + " and " +
                        three_digits(static_cast<double>(to) * hz) + " Hz";
      }
    }
  }
  return best;
}

/// The correlation of two channels' innovations that findings of noise shared by several axes explain.
double known_correlation(const std::vector<Evidence>& found, std::size_t a, std::size_t b) {
  double known = 0.0;
  for (const Evidence& evidence : found) {
    const auto acts_on = [&](std::size_t group) {
      return evidence.group == group ||
             std::find(evidence.also_groups.begin(), evidence.also_groups.end(), group) != evidence.also_groups.end();
    };
    known += evidence.cause->as<CommonNoise>() != nullptr && acts_on(a) && acts_on(b) ? evidence.shape : 0.0;
  }
  return known;
}

void keep(std::vector<Remainder>& list, Remainder remainder, const ChannelGroup::Member* member,
          const ChannelGroup& group, const char* test, bool in_time_or_frequency) {
  remainder.channel = group.column;
  remainder.recording = member != nullptr ? member->recording->id : "";
  remainder.id = (member != nullptr ? member->name() : group.column) + "." + test;
  remainder.in_time_or_frequency = in_time_or_frequency;
  list.push_back(std::move(remainder));
}

}  // namespace

std::vector<Remainder> remains_of_channel(const ChannelGroup& group, const FullRate& data) {
  std::vector<Remainder> list;
  const std::vector<std::vector<double>> scores = normal_scores(data);
  for (std::size_t r = 0; r < data.members(); ++r) {
    const ChannelGroup::Member& member = group.members[r];
    if (scores[r].size() < kFewest) {
      continue;
    }
    keep(list, Tiles(scores[r], data.used[r], data.dt_s).strongest(member.name()), &member, group, "tiles", true);
    keep(list, mean_over_time(scores[r], data.dt_s, member.name()), &member, group, "mean_over_time", false);
    keep(list, line_in_variance(scores[r], data.used[r], data.dt_s, member.name()), &member, group, "line_in_variance",
         true);
    list.back().of_power_alone = true;
    // Innovations of differenced uniform noise are white and not independent.
    if (!(data.quantization > 0.0)) {
      keep(list, dependence_over_time(scores[r], data.used[r], member.name()), &member, group, "dependence", false);
      list.back().follows_changes = true;
    }
    keep(list, slow_distribution(scores[r], data.dt_s, member.name()), &member, group, "slow_distribution", false);
    list.back().follows_changes = true;
  }
  keep(list, skewness(data, group.column), nullptr, group, "skewness", false);
  if (Remainder codes = uneven_codes(group, data); codes.observed > 0.0) {
    keep(list, std::move(codes), nullptr, group, "codes", false);
  }
  return list;
}

std::vector<Remainder> what_remains(const std::vector<ChannelGroup>& groups, const std::vector<GroupOutcome>& outcomes,
                                    const std::vector<Evidence>& found, std::vector<Remainder> of_channels) {
  std::vector<Remainder> list = std::move(of_channels);
  std::map<std::string, std::vector<std::pair<std::size_t, std::size_t>>> by_recording;  // group and member
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (std::size_t r = 0; outcomes[g].usable && r < groups[g].members.size(); ++r) {
      if (outcomes[g].after.innovation[r].size() >= kFewest) {
        by_recording[groups[g].members[r].recording->id].emplace_back(g, r);
      }
    }
  }
  for (const auto& [recording, axes] : by_recording) {
    for (std::size_t a = 0; a < axes.size(); ++a) {
      for (std::size_t b = a + 1; b < axes.size(); ++b) {
        const ChannelGroup& first = groups[axes[a].first];
        const ChannelGroup& second = groups[axes[b].first];
        const double dt_s = outcomes[axes[a].first].after.dt_s;
        const Series& one = outcomes[axes[a].first].after.innovation[axes[a].second];
        const Series& other = outcomes[axes[b].first].after.innovation[axes[b].second];
        if (first.role.quantity != second.role.quantity || one.size() != other.size()) {
          continue;
        }
        const std::string name = first.column + " and " + second.column + " of " + recording;
        keep(list, between(one, other, known_correlation(found, axes[a].first, axes[b].first), dt_s, name), nullptr,
             first, "", false);
        list.back().id = recording + "/" + first.column + "." + second.column + ".coherence";
        list.back().recording = recording;
        keep(list, shared_loudness(one, other, name), nullptr, first, "", false);
        list.back().id = recording + "/" + first.column + "." + second.column + ".loudness";
        list.back().recording = recording;
        list.back().follows_changes = true;
      }
    }
  }
  for (Remainder& remainder : list) {
    const double p = remainder.places * std::exp(-remainder.observed);
    remainder.p_study = std::min(1.0, p * static_cast<double>(list.size()));
  }
  std::sort(list.begin(), list.end(), [](const Remainder& a, const Remainder& b) {
    return a.p_study != b.p_study ? a.p_study < b.p_study : a.id < b.id;
  });
  return list;
}

void report_remains(const std::vector<Remainder>& remains, Report& report) {
  // Shown of one channel. Chosen for who reads the list.
  constexpr std::size_t kMostOfChannel = 3;
  std::map<std::string, std::size_t> shown;
  const auto changes = [&](const std::string& channel) {
    return std::any_of(remains.begin(), remains.end(), [&](const Remainder& other) {
      return other.channel == channel && other.in_time_or_frequency && other.p_study < kShown;
    });
  };
  for (const Remainder& remainder : remains) {
    if (remainder.p_study >= kShown || (remainder.follows_changes && changes(remainder.channel)) ||
        ++shown[remainder.channel] > kMostOfChannel) {
      continue;
    }
    Check check;
    check.id = remainder.id;
    check.recording = remainder.recording;
    check.channel = remainder.channel;
    check.observed = remainder.observed;
    // The largest of `places` unit exponentials.
    const auto quantile = [&](double p) { return std::log(remainder.places) - std::log(-std::log(p)); };
    check.q025 = std::max(0.0, quantile(0.025));
    check.median = quantile(0.5);
    check.q975 = quantile(0.975);
    check.p = std::min(1.0, remainder.places * std::exp(-remainder.observed));
    check.p_adjusted = remainder.p_study;
    check.title = "what is left in the innovations";
    report_unexplained(std::move(check), remainder.sentence, report);
  }
}

void report_unexplained(Check check, const std::string& sentence, Report& report) {
  check.failed = true;
  check.observed_after = check.observed;
  check.p_after = check.p;
  check.p_after_adjusted = check.p_adjusted;
  check.failed_after = true;
  check.end = CheckEnd::Unexplained;
  ++report.failed_before;
  ++report.failed_after;
  report.unexplained.push_back({check.channel, sentence + ". No cause of the list explains it.", {check.id}});
  report.checks.push_back(std::move(check));
}

}  // namespace driftlab::investigate
