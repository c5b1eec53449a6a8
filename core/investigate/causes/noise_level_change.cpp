/// noise_level_change: the whole zero-mean error of one recording times `ratio` from t0 on.
/// Every sample is tried as t0 by running sums of the squared innovations.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/fullrate/full_rate.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

constexpr double kSearched = 9.0;  ///< what the choice of t0 is worth

struct Split {
  double gain = 0.0;
  std::size_t at = 0;
  double log_ratio = 0.0;
};

/// Twice the gain of variances (before, after) over one, with the total of the rest of the group.
Evidence examine_member(const FullRate& data, std::size_t r, double rest_square, double rest_count) {
  const auto& e = data.innovation[r];
  const auto& used = data.used[r];
  std::vector<double> square(e.size() + 1, 0.0);
  std::vector<double> count(e.size() + 1, 0.0);
  for (std::size_t i = 0; i < e.size(); ++i) {
    // A gross error is no change of level: squares are cut at 25.
    square[i + 1] = square[i] + (used[i] != 0 ? std::min(e[i] * e[i], 25.0) : 0.0);
    count[i + 1] = count[i] + (used[i] != 0 ? 1.0 : 0.0);
  }
  const double all_square = rest_square + square.back();
  const double all_count = rest_count + count.back();
  const double constant = data.given ? all_count * std::log(all_square / all_count) + all_count - all_square : 0.0;
  const double level = all_square / all_count;
  const std::size_t margin = std::max<std::size_t>(50, e.size() / 100);
  Split best;
  std::vector<double> profile(e.size(), 0.0);
  for (std::size_t i = margin; i + margin < e.size(); ++i) {
    const double after_n = count.back() - count[i];
    const double after = (square.back() - square[i]) / after_n;
    double gain = 0.0;
    if (data.given) {
      gain = after_n * (after - 1.0 - std::log(after));
    } else {
      const double before_n = all_count - after_n;
      const double before = (all_square - after * after_n) / before_n;
      gain = all_count * std::log(level) - before_n * std::log(before) - after_n * std::log(after);
    }
    profile[i] = gain;
    if (gain > best.gain) {
      const double before = data.given ? 1.0 : (all_square - after * after_n) / (all_count - after_n);
      best = {gain, i, 0.5 * std::log(after / before)};
    }
  }
  Evidence evidence;
  evidence.members = {r};
  evidence.gain = best.gain;
  evidence.freedom = 2.0;
  evidence.score = best.gain - kSearched - choice_penalty(static_cast<double>(data.members()));
  // Against a given baseline any other constant level gains as well: the change must beat that by itself.
  if (data.given && best.gain + constant < kSearched) {
    evidence.score = std::min(evidence.score, 0.0);
  }
  if (best.at == 0) {
    return evidence;
  }
  // Posterior of t0 under a flat prior: weights exp(gain/2), equal tails of 2.5 %.
  double total = 0.0;
  for (const double g : profile) {
    total += g > 0.0 ? std::exp(0.5 * (g - best.gain)) : 0.0;
  }
  double run = 0.0;
  Interval place{0.0, 0.0};
  bool open = true;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    run += profile[i] > 0.0 ? std::exp(0.5 * (profile[i] - best.gain)) : 0.0;
    if (open && run > 0.025 * total) {
      place.low = static_cast<double>(i);
      open = false;
    }
    if (run < 0.975 * total) {
      place.high = static_cast<double>(i + 1);
    }
  }
  const StudyRecording& recording = *data.group->members[r].recording;
  const double offset = recording.time_s(recording.begin);
  const double after_n = count.back() - count[best.at];
  const double before_n = data.given ? 1e300 : all_count - after_n;
  const double sd = std::sqrt(0.5 / after_n + 0.5 / before_n);
  const double ratio = std::exp(best.log_ratio);
  evidence.shape = static_cast<double>(best.at);
  evidence.parameters = {
      {"ratio", {ratio, {ratio * std::exp(-1.96 * sd), ratio * std::exp(1.96 * sd)}}, units::one(data.group->unit)},
      {"t0_s",
       {offset + static_cast<double>(best.at) * data.dt_s,
        {offset + (place.low - 1.0) * data.dt_s, offset + (place.high + 1.0) * data.dt_s}},
       units::seconds(data.group->unit)}};
  return evidence;
}

std::vector<Evidence> examine(const FullRate& data) {
  std::vector<double> square(data.members(), 0.0);
  std::vector<double> count(data.members(), 0.0);
  for (std::size_t r = 0; r < data.members(); ++r) {
    for (std::size_t i = 0; i < data.innovation[r].size(); ++i) {
      if (data.used[r][i] != 0) {
        square[r] += std::min(data.innovation[r][i] * data.innovation[r][i], 25.0);
        count[r] += 1.0;
      }
    }
  }
  std::vector<Evidence> found;
  for (std::size_t r = 0; r < data.members(); ++r) {
    double rest_square = 0.0;
    double rest_count = 0.0;
    // Levels of other recordings say nothing where they do not repeat.
    for (std::size_t s = 0; s < data.members() && data.repeatability == 1.0; ++s) {
      rest_square += s == r ? 0.0 : square[s];
      rest_count += s == r ? 0.0 : count[s];
    }
    found.push_back(examine_member(data, r, rest_square, rest_count));
  }
  return found;
}

void deviation(const FullRate& data, const Evidence& found, std::size_t r, std::vector<double>& sd) {
  sd.assign(data.innovation[r].size(), 1.0);
  if (r == found.members.front()) {
    std::fill(sd.begin() + static_cast<std::ptrdiff_t>(found.shape), sd.end(), found.parameters[0].estimate.value);
  }
}

void inject_effect(Draft& draft, std::span<const double> values, Random& /*random*/) {
  for (std::size_t i = 0; i < draft.white.size(); ++i) {
    if (draft.recording->time_s(i) >= values[1]) {
      draft.white[i] *= values[0];
      draft.slow[i] *= values[0];
    }
  }
}

std::vector<double> shown_values(const Stage& stage, Random& random) {
  return {1.0 + stage.z * std::sqrt(1.0 / stage.samples_each()), stage.duration_s * (0.3 + 0.4 * random.uniform())};
}

}  // namespace

Cause noise_level_change() {
  return {
      .name = "noise_level_change",
      .title = "noise that changes its level within a recording",
      .equation = "y = m + e before t₀ and y = m + ratio · e from t₀ on, m the mean and e the rest",
      .family = NoiseLevel{.examine = examine, .deviation = deviation, .within_recording = true, .scales_slow = true},
      .rivals = {"white_noise_level", "outliers"},
      .needs = "any recording",
      .separates = "more recordings of the same condition",
      .parameters = {{"ratio", units::one}, {"t0_s", units::seconds}},
      .inject = inject_effect,
      .showing = {.acting = Acting::SecondAlone, .values = shown_values}};
}

}  // namespace driftlab::investigate
