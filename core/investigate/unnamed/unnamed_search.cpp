#include "core/investigate/unnamed/unnamed_search.hpp"

#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/slow/slow_fit.hpp"
#include "core/investigate/unnamed/courses.hpp"
#include "core/investigate/unnamed/profile_bins.hpp"
#include "core/investigate/unnamed/profile_of_means.hpp"
#include "core/investigate/unnamed/profile_of_ratios.hpp"
#include "core/investigate/unnamed/profile_words.hpp"
#include "core/process/distributions.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace driftlab::investigate {
namespace {

constexpr std::array<int, 3> kBands{14, 42, -40};  ///< spec/trust-notes.md, section 7, as the next two
constexpr double kAdopted = 6.0;                   ///< [nat], beside 2 ln(tried)
constexpr double kPeriods = 4.0;                   ///< of the lowest frequency in half a recording
constexpr std::size_t kMostAdopted = 3;            ///< of a channel, chosen, not measured, as all that follow
constexpr double kCut = 5.0;                       ///< innovations: gross values are no level
constexpr double kPassed = 0.05;  ///< of the white noise: what a band limit leaves less of is the last digit's rounding
constexpr double kBlockRateHz = 5.0;  ///< of the means

constexpr std::array kQuantities{Against::Rate, Against::RateChange, Against::Temperature, Against::Warming,
                                 Against::Angle};

struct Candidate {
  UnnamedEffect effect;
  std::vector<double> se;
  double gain = -1e300;
  double samples = 0.0;
  double tried = 1.0;                             ///< of which this one was chosen before it was judged
  std::optional<SlowModel> noise = std::nullopt;  ///< the base beside it, where it was fitted again
};

class UnnamedSearch {
 public:
  UnnamedSearch(const ChannelGroup& group, const FullRate& data, std::size_t base)
      : group_(group), data_(data), first_free_(data.given ? base : 0) {
    for (const Against against : kQuantities) {
      if (Courses courses = courses_of(group, against); !courses.edge.empty()) {
        courses_.push_back(std::move(courses));
      }
    }
    lines_.resize(group.members.size());
    again_.resize(group.members.size());
    tails_ = 1.0 + 0.5 * std::max(0.0, excess_kurtosis());
  }

  std::vector<UnnamedFinding> go() {
    std::vector<UnnamedFinding> findings;
    while (adopted_.size() < kMostAdopted && !data_.stopped()) {
      std::vector<Candidate> all = candidates();
      std::erase_if(all, [&](const Candidate& one) { return known(one.effect); });
      if (adopted_.empty()) {
        tried_ = static_cast<double>(std::max<std::size_t>(all.size(), 1));
      }
      std::erase_if(all,
                    [&](const Candidate& one) { return one.gain < kAdopted + 2.0 * std::log(tried_ * one.tried); });
      // A mean that is not taken off is in every spectrum and every variance: it comes first.
      const auto best = std::max_element(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
        const bool mean_a = a.effect.kind == UnnamedKind::Mean;
        const bool mean_b = b.effect.kind == UnnamedKind::Mean;
        return mean_a != mean_b ? mean_b : a.gain < b.gain;
      });
      if (best == all.end()) {
        break;
      }
      adopted_.push_back(best->effect);
      if (best->effect.kind == UnnamedKind::Mean) {
        lines_.assign(group_.members.size(), std::nullopt);
      }
      if (const std::optional<SlowModel>& refitted = best->noise) {
        data_.model.components = in_all_members(refitted->components);
      }
      findings.push_back(finding_of(*best));
    }
    return findings;
  }

  /// Those against the quantities alone, each beside none of the others.
  std::vector<UnnamedFinding> against_quantities(UnnamedKind kind) {
    std::vector<UnnamedFinding> findings;
    tried_ = static_cast<double>(std::max<std::size_t>(courses_.size(), 1));
    for (const Courses& courses : courses_) {
      const Candidate candidate = kind == UnnamedKind::Mean ? mean(courses) : variance(courses);
      if (candidate.gain > kAdopted + 2.0 * std::log(tried_)) {
        findings.push_back(finding_of(candidate));
      }
    }
    return findings;
  }

 private:
  [[nodiscard]] UnnamedFinding finding_of(const Candidate& candidate) const {
    UnnamedFinding finding;
    finding.effect = candidate.effect;
    finding.heldout_gain = candidate.gain;
    finding.tried = tried_ * candidate.tried;
    finding.samples = candidate.samples;
    finding.sentence = sentence_of(candidate.effect, candidate.se, level_unit(group_.unit));
    if (candidate.noise) {
      finding.noise = in_all_members(candidate.noise->components);
    }
    for (std::size_t k = 0; k < candidate.effect.value.size(); ++k) {
      const double from = candidate.effect.edge[k];
      const double to = candidate.effect.edge[k + 1];
      const bool frequencies = candidate.effect.against == Against::Frequency;
      finding.middle.push_back(frequencies ? std::sqrt(from * to) : 0.5 * (from + to));
      finding.low.push_back(candidate.effect.value[k] - kNormal975 * candidate.se[k]);
      finding.high.push_back(candidate.effect.value[k] + kNormal975 * candidate.se[k]);
    }
    return finding;
  }

  [[nodiscard]] bool known(const UnnamedEffect& effect) const {
    return std::any_of(adopted_.begin(), adopted_.end(), [&](const UnnamedEffect& other) {
      // Of a mean that comes again the squares do too.
      const bool alike = other.kind == effect.kind || effect.against == Against::Phase;
      return alike && other.against == effect.against && other.recordings == effect.recordings;
    });
  }

  [[nodiscard]] const StudyRecording& recording(std::size_t r) const { return *group_.members[r].recording; }

  [[nodiscard]] double excess_kurtosis() const {
    double count = 0.0;
    double second = 0.0;
    double fourth = 0.0;
    for (std::size_t r = 0; r < data_.members(); ++r) {
      for (std::size_t i = 0; i < data_.innovation[r].size(); ++i) {
        if (data_.used[r][i] != 0) {
          const double square = std::pow(std::clamp(data_.innovation[r][i], -kCut, kCut), 2.0);
          count += 1.0;
          second += square;
          fourth += square * square;
        }
      }
    }
    return second > 0.0 ? fourth * count / (second * second) - 3.0 : 0.0;
  }

  /// The period of what comes again and again in a member, of its mean or of its power; looked for once.
  [[nodiscard]] std::optional<FoundPeriod> period_of(std::size_t r, UnnamedKind kind) const {
    auto& known = again_[r][kind == UnnamedKind::Mean ? 0 : 1];
    if (!known) {
      const Series& innovation = data_.innovation[r];
      const auto value = [&](std::size_t i) {
        const double e = data_.used[r][i] != 0 ? std::clamp(innovation[i], -kCut, kCut) : 0.0;
        return kind == UnnamedKind::Mean ? e : e * e;
      };
      known.emplace(find_period(innovation.size(), data_.dt_s, value, data_.stop));
    }
    return *known;
  }

  /// A mean or a power that comes again and again; without a gain where none does.
  [[nodiscard]] Candidate again(std::size_t r, UnnamedKind kind) const {
    const std::optional<FoundPeriod> found = period_of(r, kind);
    if (!found) {
      return {};
    }
    const Courses phases = phases_of(group_, r, *found);
    return kind == UnnamedKind::Mean ? mean(phases) : variance(phases);
  }

  [[nodiscard]] std::vector<Candidate> candidates() const {
    std::vector<Candidate> all;
    std::vector<std::size_t> whole(group_.members.size());
    std::iota(whole.begin(), whole.end(), std::size_t{0});
    for (const int bands : kBands) {
      all.push_back(spectrum(whole, bands));
    }
    for (const Courses& courses : courses_) {
      all.push_back(variance(courses));
      all.push_back(mean(courses));
    }
    for (std::size_t r = 0; r < group_.members.size() && !data_.stopped(); ++r) {
      if (recording(r).count() < kFewestOfProfile) {
        continue;
      }
      const Courses time = time_of(group_, r);
      all.push_back(variance(time));
      all.push_back(mean(time));
      all.push_back(again(r, UnnamedKind::Mean));
      all.push_back(again(r, UnnamedKind::Variance));
      if (group_.members.size() > 1) {
        all.push_back(spectrum({r}, kBands.front()));
      }
    }
    return all;
  }

  [[nodiscard]] UnnamedEffect effect_in(UnnamedKind kind, const Courses& courses) const {
    UnnamedEffect effect;
    effect.kind = kind;
    effect.against = courses.against;
    effect.period_s = courses.period_s;
    effect.column = group_.column;
    effect.edge = courses.edge;
    const bool one_of_them = courses.members.size() < group_.members.size() || courses.single();
    for (const std::size_t r : courses.members) {
      if (one_of_them) {
        effect.recordings.push_back(recording(r).id);
      }
    }
    return effect;
  }

  /// The residual of a member less the means that were adopted.
  [[nodiscard]] Series residual(std::size_t r) const {
    std::vector<double> rest;
    const StudyRecording& own = recording(r);
    for (const UnnamedEffect& effect : adopted_) {
      if (effect.kind != UnnamedKind::Mean || !acts_on(effect, group_.column, own.id)) {
        continue;
      }
      const Series course = course_of(effect, own, group_.axis());
      rest = rest.empty() ? data_.residual[r].values() : std::move(rest);
      for (std::size_t i = 0; i < rest.size() && !course.empty(); ++i) {
        rest[i] -= value_at(effect, course[own.begin + i]);
      }
    }
    return rest.empty() ? data_.residual[r] : Series(std::move(rest));
  }

  /// Spectra of the halves of the members over those of the model.
  [[nodiscard]] Candidate spectrum(const std::vector<std::size_t>& members, int asked) const {
    Candidate candidate;
    Courses frequencies;
    frequencies.against = Against::Frequency;
    frequencies.members = members;
    candidate.effect = effect_in(UnnamedKind::Spectrum, frequencies);
    double longest_s = 0.0;
    for (const std::size_t r : members) {
      longest_s = std::max(longest_s, 0.5 * data_.dt_s * static_cast<double>(data_.residual[r].size()));
    }
    const double low = kPeriods / longest_s;
    const double high = 0.5 / data_.dt_s;
    if (!(low < 0.5 * high)) {
      return candidate;
    }
    std::vector<double>& edge = candidate.effect.edge;
    const auto bands = static_cast<std::size_t>(std::abs(asked));
    for (std::size_t k = 0; k <= bands; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(bands);
      edge.push_back(asked > 0 ? low * std::pow(high / low, share) : low + (high - low) * share);
    }
    std::vector<std::vector<RatioBin>> halves(2, std::vector<RatioBin>(bands));
    for (const std::size_t r : members) {
      if (data_.spectrum[r].power.empty() || data_.stopped()) {
        continue;
      }
      const auto& lines = lines_of(r);
      for (std::size_t h = 0; h < 2; ++h) {
        for (const Line& line : lines[h]) {
          halves[h][bin_of(edge, line.f_hz)] += {line.weight, line.weight * line.ratio / shaped(r, line.f_hz)};
        }
      }
      candidate.samples += static_cast<double>(data_.residual[r].size());
    }
    judge(candidate, halves);
    return candidate;
  }

  /// A bin of a spectrum: its ordinates, and their mean over the density of the model.
  struct Line {
    double f_hz, weight, ratio;
  };
  using Halves = std::array<std::vector<Line>, 2>;

  /// The spectra of the halves of a member, worked out once for the means that were adopted.
  const Halves& lines_of(std::size_t r) const {
    std::optional<Halves>& lines = lines_[r];
    if (!lines) {
      lines.emplace();
      const Series whole = residual(r);
      const std::size_t half = whole.size() / 2;
      for (std::size_t h = 0; h < 2; ++h) {
        FullRate part = data_;
        part.residual[r] = whole.part(h * half, half);
        const auto first = data_.used[r].begin() + static_cast<std::ptrdiff_t>(h * half);
        part.used[r].assign(first, first + static_cast<std::ptrdiff_t>(half));
        set_spectrum(part, r, kPeriods / (static_cast<double>(half) * data_.dt_s));
        const Spectrum& s = part.spectrum[r];
        for (std::size_t j = 0; j < s.power.size(); ++j) {
          if (passed(part, s.f_hz[j]) >= kPassed) {
            (*lines)[h].push_back({s.f_hz[j], s.weight[j], s.power[j] / expected(part, r, j)});
          }
        }
      }
    }
    return *lines;
  }

  /// The share of the white noise that a band limit passes.
  [[nodiscard]] static double passed(const FullRate& part, double f_hz) {
    return part.colour.band_limited() ? butterworth_gain(f_hz, part.colour.corner_hz, part.dt_s) : 1.0;
  }

  /// The density of the model in a bin.
  [[nodiscard]] static double expected(const FullRate& part, std::size_t r, std::size_t j) {
    return part.model.white * passed(part, part.spectrum[r].f_hz[j]) + part.slow[r][j];
  }

  /// What the spectra that were adopted make of a density.
  [[nodiscard]] double shaped(std::size_t r, double f_hz) const {
    double factor = 1.0;
    for (const UnnamedEffect& effect : adopted_) {
      const bool shapes = effect.kind == UnnamedKind::Spectrum && acts_on(effect, group_.column, recording(r).id);
      factor *= shapes ? value_at(effect, f_hz) : 1.0;
    }
    return factor;
  }

  /// Fits to all parts but one and scores on that, for every part; then fits to all.
  void judge(Candidate& candidate, const std::vector<std::vector<RatioBin>>& parts) const {
    const auto sum_without = [&](std::size_t left_out) {
      std::vector<RatioBin> sum(parts.front().size());
      for (std::size_t p = 0; p < parts.size(); ++p) {
        for (std::size_t b = 0; b < sum.size() && p != left_out; ++b) {
          sum[b] += parts[p][b];
        }
      }
      return sum;
    };
    candidate.gain = 0.0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const std::vector<RatioBin> others = sum_without(p);
      const double level = data_.given ? 1.0 : level_of(others);
      candidate.gain += gain_of(profile_of(at_level(others, level)), at_level(parts[p], level));
    }
    const std::vector<RatioBin> whole = sum_without(parts.size());
    RatioProfile all = profile_of(at_level(whole, data_.given ? 1.0 : level_of(whole)));
    candidate.effect.value = std::move(all.value);
    candidate.se = std::move(all.se);
  }

  [[nodiscard]] Candidate variance(const Courses& courses) const {
    Candidate candidate;
    candidate.effect = effect_in(UnnamedKind::Variance, courses);
    candidate.tried = courses.tried;
    const std::size_t bins = courses.edge.size() - 1;
    const bool alone = courses.members.size() == 1;
    std::vector<std::vector<RatioBin>> parts(alone ? 2 : courses.members.size(), std::vector<RatioBin>(bins));
    for (std::size_t m = 0; m < courses.members.size(); ++m) {
      const std::size_t r = courses.members[m];
      const StudyRecording& own = recording(r);
      std::vector<std::pair<const UnnamedEffect*, Series>> taken;
      for (const UnnamedEffect& effect : adopted_) {
        if (effect.kind == UnnamedKind::Variance && acts_on(effect, group_.column, own.id)) {
          taken.emplace_back(&effect, course_of(effect, own, group_.axis()).part(own.begin, own.count()));
        }
      }
      const std::size_t count = data_.innovation[r].size();
      for (std::size_t i = 0; i < count; ++i) {
        if (data_.used[r][i] == 0) {
          continue;
        }
        const double e = std::clamp(data_.innovation[r][i], -kCut, kCut);
        double square = e * e;
        for (const auto& [effect, course] : taken) {
          square /= value_at(*effect, course[i]);
        }
        // Two squares count as one ordinate, and those of a heavy tail for less.
        parts[alone ? courses.part_of(i, count) : m][bin_of(courses.edge, courses.of[r][i])] +=
            {0.5 / tails_, 0.5 / tails_ * square};
        candidate.samples += 1.0;
      }
    }
    judge(candidate, parts);
    return candidate;
  }

  /// Means of blocks of the residuals, and the bins that they lie in.
  [[nodiscard]] Candidate mean(const Courses& courses) const {
    Candidate candidate;
    candidate.effect = effect_in(UnnamedKind::Mean, courses);
    candidate.tried = courses.tried;
    const std::size_t bins = courses.edge.size() - 1;
    BlockSeries series;
    series.dt_s = data_.dt_s;
    std::size_t longest = 0;
    for (const std::size_t r : courses.members) {
      longest = std::max(longest, data_.residual[r].size());
    }
    const double asked = courses.against == Against::Phase ? 1.0 : 1.0 / (kBlockRateHz * data_.dt_s);
    series.block = std::max<std::size_t>({1, static_cast<std::size_t>(std::lround(asked)), longest / kMostBlocks});
    BlockColumns columns;
    columns.width = 1 + courses.members.size() + bins;  // the means, a constant of each recording, the bins
    SlowModel noise = data_.model;
    noise.white_scale.clear();
    noise.white += 2.0 * data_.quantization / series.block_s();
    for (SlowComponent& component : noise.components) {
      component.in = in_members(component, courses.members);
    }
    for (std::size_t m = 0; m < courses.members.size(); ++m) {
      add_blocks(courses, m, series, columns);
      candidate.samples += static_cast<double>(data_.residual[courses.members[m]].size());
    }
    const BlockColumns without = narrowed(columns, 1 + courses.members.size());
    SlowModel noise_without = noise;
    // An automatic base, and slow noise that was found, have followed the effect as they can: they are fitted again
    // beside the profile.
    if (!courses.single() && noise.components.size() > first_free_) {
      SlowFreedom freedom;
      freedom.white = !data_.given;
      freedom.first_free = first_free_;
      freedom.stop = data_.stop;
      noise_without = fit_slow(series, without, noise, freedom).model;
      noise = fit_slow(series, columns, noise, freedom).model;
      candidate.noise = noise;
    }
    const std::vector<Eigen::MatrixXd> parts = parts_of(whiten(series, noise, columns), courses);
    const Whitened plain = whiten(series, noise_without, without);
    candidate.gain = 0.5 * (plain.sum_log_var - whiten(series, noise, without).sum_log_var);
    for (const Eigen::MatrixXd& part : parts_of(plain, courses)) {
      candidate.gain += 0.5 * part(0, 0);
    }
    const Eigen::Index size = static_cast<Eigen::Index>(bins) + 1;
    const auto all = std::accumulate(parts.begin(), parts.end(), Eigen::MatrixXd(Eigen::MatrixXd::Zero(size, size)));
    const ExpectedMeans expected = courses.against == Against::Phase ? ExpectedMeans::Few : ExpectedMeans::OfOneSize;
    for (const Eigen::MatrixXd& part : parts) {
      const Eigen::VectorXd a = fit_bin_means(all - part, expected).amplitude;
      candidate.gain += a.dot(part.col(0).segment(1, size - 1)) -
                        0.5 * (part(0, 0) + a.dot(part.block(1, 1, size - 1, size - 1) * a));
    }
    const BinMeans fit = fit_bin_means(all, expected);
    candidate.effect.value.assign(fit.amplitude.begin(), fit.amplitude.end());
    candidate.se.assign(fit.se.begin(), fit.se.end());
    return candidate;
  }

  /// Inner products of means and bins by the parts of the data, less what a constant of each part explains.
  [[nodiscard]] static std::vector<Eigen::MatrixXd> parts_of(const Whitened& whitened, const Courses& courses) {
    const bool alone = courses.members.size() == 1;
    std::vector<Eigen::MatrixXd> parts;
    for (std::size_t m = 0; m < courses.members.size(); ++m) {
      for (std::size_t half = 0; half < (alone ? 2U : 1U); ++half) {
        parts.push_back(centred_gram(
            whitened.columns, m, courses.members.size(),
            [&](std::size_t b, std::size_t blocks) { return !alone || courses.part_of(b, blocks) == half; }));
      }
    }
    return parts;
  }

  /// The refitted components, in the recordings in which they acted before.
  [[nodiscard]] std::vector<SlowComponent> in_all_members(std::vector<SlowComponent> components) const {
    for (std::size_t k = 0; k < components.size(); ++k) {
      components[k].in = data_.model.components[k].in;
    }
    return components;
  }

  [[nodiscard]] static std::vector<unsigned char> in_members(const SlowComponent& component,
                                                             const std::vector<std::size_t>& members) {
    std::vector<unsigned char> in;
    for (const std::size_t r : members) {
      in.push_back(component.acts_in(r) ? 1 : 0);
    }
    return in;
  }

  void add_blocks(const Courses& courses, std::size_t m, BlockSeries& series, BlockColumns& columns) const {
    const std::size_t r = courses.members[m];
    const Series values = residual(r);
    const StudyRecording& own = recording(r);
    const double noise = 1.0 + noise_of_reference(group_.members[r]);
    const std::size_t constants = courses.members.size();
    BlockRecording blocks;
    blocks.first = own.begin;
    blocks.start_s = own.time_s(own.begin);
    blocks.pattern = series.recordings.size();
    std::vector<double>& rows = columns.rows.emplace_back();
    for (std::size_t from = 0; from + series.block <= values.size(); from += series.block) {
      double sum = 0.0;
      double count = 0.0;
      for (std::size_t i = from; i < from + series.block; ++i) {
        sum += data_.used[r][i] != 0 ? values[i] : 0.0;
        count += data_.used[r][i] != 0 ? 1.0 : 0.0;
      }
      const double filled = count / static_cast<double>(series.block);
      const bool counts = filled >= 0.25;
      blocks.mean.push_back(counts ? sum / count : 0.0);
      blocks.filled.push_back(counts ? filled / noise : 0.0);
      const std::size_t row = rows.size();
      rows.resize(row + columns.width, 0.0);
      rows[row] = blocks.mean.back();
      rows[row + 1 + m] = 1.0;
      rows[row + 1 + constants + bin_of(courses.edge, courses.of[r][from + series.block / 2])] = 1.0;
    }
    series.recordings.push_back(std::move(blocks));
  }

  const ChannelGroup& group_;
  FullRate data_;  ///< a copy, of which the base may be fitted again
  std::size_t first_free_;
  std::vector<Courses> courses_;
  std::vector<UnnamedEffect> adopted_;
  mutable std::vector<std::optional<Halves>> lines_;  ///< by member; it is for one thread
  /// Likewise, by mean and by power.
  mutable std::vector<std::array<std::optional<std::optional<FoundPeriod>>, 2>> again_;
  double tails_ = 1.0;
  double tried_ = 1.0;
};

}  // namespace

double UnnamedFinding::chance(std::size_t channels) const {
  return std::min(1.0, static_cast<double>(channels) * tried * std::exp(-0.5 * heldout_gain));
}

std::vector<UnnamedFinding> find_unnamed(const ChannelGroup& group, const FullRate& data, std::size_t base) {
  return UnnamedSearch(group, data, base).go();
}

std::vector<UnnamedFinding> find_instead(const ChannelGroup& group, const FullRate& data, UnnamedKind kind) {
  return UnnamedSearch(group, data, data.model.components.size()).against_quantities(kind);
}

}  // namespace driftlab::investigate
