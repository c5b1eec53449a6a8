/// chirped_disturbance: a sinusoid whose frequency runs evenly from f0 to f1 over the recording.
///
/// Periodograms of pieces of a few seconds are added along every straight line through time and frequency. With r the
/// mean of m unit exponentials along one, m (r - 1 - ln r) has about a unit exponential tail; the best line, if it is
/// beyond what all of them together reach by chance, is followed coherently, over ever longer stretches
/// (narrow_band.hpp). The place costs what there are of distinguishable ones, a frequency in 1/T and a slope in 2/T^2.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/narrow_band.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/signal/turns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace driftlab::investigate {
namespace {

constexpr double kPiece = 4.0;  ///< [s], but no more than kMostSamples
constexpr std::size_t kMostSamples = 512;
/// Bounds the cost of a map, which is searched for every line through it. Chosen, not measured.
constexpr std::size_t kMostPieces = 1500;
constexpr double kLowest = 0.5;    ///< [Hz]: below, slow noise runs too
constexpr double kLeastRun = 0.5;  ///< [Hz] from f0 to f1: less is a line that wanders

double length_s(const FullRate& data, std::size_t r) {
  return static_cast<double>(data.innovation[r].size()) * data.dt_s;
}

std::size_t piece_of(const FullRate& data) {
  const auto samples = static_cast<std::size_t>(std::max(16.0, kPiece / data.dt_s));
  return fast_length(std::min(samples, kMostSamples));
}

/// Power of each piece and frequency, in units of the mean at that frequency.
struct Map {
  double df_hz = 0.0;
  double pieces = 0.0;                     ///< in the recording
  std::vector<std::vector<double>> power;  ///< means over neighbours where there are very many
};

Map map_of(const FullRate& data, std::size_t r) {
  const Series& e = data.innovation[r];
  const std::size_t piece = piece_of(data);
  Map map;
  map.df_hz = 1.0 / (static_cast<double>(piece) * data.dt_s);
  const std::size_t pieces = e.size() / piece;
  const std::size_t together = pieces / kMostPieces + 1;
  map.pieces = static_cast<double>(pieces);
  for (std::size_t p = 0; p < pieces; ++p) {
    const auto z = transform(e.part(p * piece, piece));
    if (p % together == 0) {
      map.power.emplace_back(z.size(), 0.0);
    }
    for (std::size_t k = 0; k < z.size(); ++k) {
      map.power.back()[k] += std::norm(z[k]) / static_cast<double>(together);
    }
  }
  for (std::size_t k = 0; !map.power.empty() && k < map.power.front().size(); ++k) {
    double mean = 0.0;
    for (const auto& power : map.power) {
      mean += power[k] / static_cast<double>(map.power.size());
    }
    for (auto& power : map.power) {
      power[k] = mean > 0.0 ? std::min(power[k] / mean, 20.0) : 0.0;
    }
  }
  return map;
}

/// The straight line along which the maps of a scope hold most; nothing where chance would hold as much on one.
std::optional<Sweep> coarse(const std::vector<const Map*>& maps, double seconds, const std::stop_token& stop) {
  // In logarithms of the chance over all lines looked along. Chosen, not measured.
  constexpr double kBeyondChance = 3.0;
  const double df = maps.front()->df_hz;
  const std::size_t bins = maps.front()->power.front().size();
  const auto first = static_cast<std::size_t>(std::ceil(kLowest / df));
  const auto run = static_cast<std::size_t>(std::ceil(kLeastRun / df));
  double most = 0.0;
  double cells = 0.0;
  double pieces = 0.0;
  for (const Map* const map : maps) {
    cells += static_cast<double>(map->power.size());
    pieces += map->pieces;
  }
  Sweep best;
  for (std::size_t a = first; a < bins && !stop.stop_requested(); ++a) {
    for (std::size_t b = first; b < bins; ++b) {
      if ((a > b ? a - b : b - a) < run) {
        continue;
      }
      double sum = 0.0;
      for (const Map* const map : maps) {
        const double per_piece =
            (static_cast<double>(b) - static_cast<double>(a)) / static_cast<double>(map->power.size());
        double at = static_cast<double>(a) + 0.5 * per_piece + 0.5;
        for (const auto& power : map->power) {
          sum += power[static_cast<std::size_t>(at)];
          at += per_piece;
        }
      }
      if (sum > most) {
        most = sum;
        best = {static_cast<double>(a) * df, (static_cast<double>(b) - static_cast<double>(a)) * df / seconds};
      }
    }
  }
  const double ratio = most / cells;
  const double surprise = pieces * (ratio - 1.0 - std::log(ratio));
  const double lines = static_cast<double>(bins) * static_cast<double>(bins);
  return ratio > 1.0 && surprise > std::log(lines) + kBeyondChance ? std::optional(best) : std::nullopt;
}

struct Followed {
  Sweep sweep;
  double x = 0.0;  ///< sum of X over the recordings
};

/// The best sweep within `reach_hz` of one at either end: first incoherently over short stretches, whose frequency need
/// not be known well, then over ever longer ones, to the whole.
Followed follow(const FullRate& data, const std::vector<std::size_t>& scope, const Sweep& near, double reach_hz) {
  std::vector<Beaten> beaten;
  double longest = 0.0;
  std::vector<double> excess;
  const std::size_t block = std::max<std::size_t>(1, piece_of(data) / 8);
  for (const std::size_t r : scope) {
    beaten.push_back(beat(data, r, near, block));
    longest = std::max(longest, length_s(data, r));
    excess.push_back(excess_between(data, r, near.f_hz, near.at(length_s(data, r))));
  }
  const auto value = [&](double df, double dc, std::size_t stretch) {
    double x = 0.0;
    for (std::size_t k = 0; k < beaten.size(); ++k) {
      std::complex<double> sum = 0.0;
      double square = 0.0;
      for (std::size_t i = 0; i < beaten[k].sums.size(); ++i) {
        const double t = (static_cast<double>(i) + 0.5) * beaten[k].step_s;
        sum += beaten[k].sums[i] * std::polar(1.0, -kTurn * (df * t + 0.5 * dc * t * t));
        if ((i + 1) % stretch == 0 || i + 1 == beaten[k].sums.size()) {
          square += std::norm(sum);
          sum = 0.0;
        }
      }
      x += 2.0 * square / std::max(1.0, beaten[k].samples) / excess[k];
    }
    return x;
  };
  double best_a = 0.0;
  double best_b = 0.0;
  double best = 0.0;
  const auto look = [&](double step, int half, std::size_t stretch) {
    const double centre_a = best_a;
    const double centre_b = best_b;
    best = -1.0;
    for (int i = -half; i <= half && !data.stopped(); ++i) {
      for (int j = -half; j <= half; ++j) {
        const double a = centre_a + i * step;
        const double b = centre_b + j * step;
        const double x = value(a, (b - a) / longest, stretch);
        if (x > best) {
          best = x;
          best_a = a;
          best_b = b;
        }
      }
    }
  };
  const double total = longest / beaten.front().step_s;
  double reach = reach_hz;
  for (double stretch = 32.0; stretch < 2.0 * total; stretch *= 4.0) {
    const double step = 0.4 / (std::min(stretch, total) * beaten.front().step_s);
    look(step, std::min(15, static_cast<int>(std::ceil(reach / step))), static_cast<std::size_t>(stretch));
    reach = 1.2 * step;
  }
  const auto whole = static_cast<std::size_t>(total) + 2;
  for (double step = 0.2 / longest; step > 0.002 / longest; step *= 0.4) {
    look(step, 2, whole);
  }
  return {{near.f_hz + best_a, near.slope_hz_s + (best_b - best_a) / longest}, best};
}

Evidence describe(const FullRate& data, const std::vector<std::size_t>& scope, const Followed& followed) {
  double weight = 0.0;
  double mean = 0.0;
  double longest = 0.0;
  for (const std::size_t r : scope) {
    const PhaseFit fit = fit_phases(data, r, {followed.sweep});
    const double modulus = std::abs(fit.amplitude[0]);
    weight += 1.0 / fit.variance;
    mean += std::sqrt(std::max(0.0, modulus * modulus - fit.variance)) / fit.variance;
    longest = std::max(longest, length_s(data, r));
  }
  const double amplitude = mean / weight;
  const double sd = 1.0 / std::sqrt(weight);
  // Of a phase a + 2 pi f t + pi c t^2 under white noise: the frequency at either end has the variance 24 / (pi^2 X
  // T^2).
  const double sd_f = std::sqrt(24.0 / std::max(1.0, followed.x)) / (std::numbers::pi * longest);
  const double f1 = followed.sweep.at(longest);
  Evidence evidence;
  evidence.members = scope;
  evidence.gain = followed.x;
  evidence.freedom = 3.0 + static_cast<double>(scope.size());
  evidence.shape = followed.sweep.f_hz;
  const auto hertz = [&](double f) { return Estimate{f, {f - 1.96 * sd_f, f + 1.96 * sd_f}}; };
  evidence.parameters = {{"amplitude",
                          {amplitude, {std::max(0.0, amplitude - 1.96 * sd), amplitude + 1.96 * sd}},
                          units::level(data.group->unit)},
                         {"f0_hz", hertz(followed.sweep.f_hz), units::hertz({})},
                         {"f1_hz", hertz(f1), units::hertz({})}};
  return evidence;
}

std::vector<Evidence> examine(const FullRate& data) {
  std::vector<Map> maps;
  for (std::size_t r = 0; r < data.members(); ++r) {
    if (data.stopped()) {
      return {};
    }
    maps.push_back(map_of(data, r));
  }
  const auto scopes = scopes_of(data);
  std::vector<Evidence> found;
  for (const auto& scope : scopes) {
    if (data.stopped()) {
      break;
    }
    // Pieces of a map: in fewer any slope fits. Chosen, not measured.
    constexpr std::size_t kFewest = 6;
    std::vector<const Map*> of_scope;
    double longest = 0.0;
    for (const std::size_t r : scope) {
      if (maps[r].power.size() >= kFewest) {
        of_scope.push_back(&maps[r]);
        longest = std::max(longest, length_s(data, r));
      }
    }
    const auto start = of_scope.size() == scope.size() ? coarse(of_scope, longest, data.stop) : std::nullopt;
    if (!start) {
      continue;
    }
    const Followed followed = follow(data, scope, *start, of_scope.front()->df_hz);
    const double band = 0.5 / data.dt_s;
    const double places = band * longest * band * longest / 2.0;
    const double score = -2.0 * log_tail(followed.x, static_cast<double>(scope.size())) - choice_penalty(places) -
                         choice_penalty(static_cast<double>(scopes.size())) - 3.0;
    if (score < 4.0) {
      continue;
    }
    Evidence evidence = describe(data, scope, followed);
    evidence.score = score;
    found.push_back(std::move(evidence));
  }
  return found;
}

Sweep sweep_of(const Evidence& found, double seconds) {
  const double f0 = found.parameters[1].estimate.value;
  return {f0, (found.parameters[2].estimate.value - f0) / seconds};
}

/// Length of the whole recording of which a part is given.
double whole_length_s(const FullRate& part, std::size_t r) {
  return static_cast<double>(part.group->members[r].recording->count()) * part.dt_s;
}

/// A half of the recording holds the first or the second half of the run.
Evidence find_again(const FullRate& part, const Evidence& found) {
  double seconds = 0.0;
  double whole = 0.0;
  for (const std::size_t r : found.members) {
    seconds = std::max(seconds, length_s(part, r));
    whole = std::max(whole, whole_length_s(part, r));
  }
  const Sweep sweep = sweep_of(found, whole);
  const Followed first = follow(part, found.members, sweep, 2.0 / seconds);
  const Followed second = follow(part, found.members, {sweep.at(whole - seconds), sweep.slope_hz_s}, 2.0 / seconds);
  return describe(part, found.members, first.x > second.x ? first : second);
}

/// `found` is of the other half, which need not be as long: the run goes on from its end, or came to its beginning.
double log_gain(const FullRate& data, const Evidence& found) {
  const double amplitude = found.parameters[0].estimate.value;
  const auto other_half = [&](std::size_t r) { return whole_length_s(data, r) - length_s(data, r); };
  double seconds = 0.0;
  for (const std::size_t r : found.members) {
    seconds = std::max(seconds, other_half(r));
  }
  const Sweep sweep = sweep_of(found, seconds);
  double after = 0.0;
  double before = 0.0;
  for (const std::size_t r : found.members) {
    const PhaseFit on = fit_phases(data, r, {Sweep{sweep.at(other_half(r)), sweep.slope_hz_s}});
    const PhaseFit back = fit_phases(data, r, {Sweep{sweep.at(-length_s(data, r)), sweep.slope_hz_s}});
    after += log_gain_of(on.amplitude[0], on.variance, amplitude);
    before += log_gain_of(back.amplitude[0], back.variance, amplitude);
  }
  return std::max(after, before);
}

std::vector<double> values_of(const FullRate& data, std::size_t r, const Evidence& found) {
  double longest = 0.0;
  for (const std::size_t m : found.members) {
    longest = std::max(longest, length_s(data, m));
  }
  return fit_phases(data, r, {sweep_of(found, longest)}).values;
}

void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  const double phase = kTurn * random.uniform();
  const double seconds = draft.recording->time_s(draft.mean.size());
  for (std::size_t i = 0; i < draft.mean.size(); ++i) {
    const double t = draft.recording->time_s(i);
    const double turns = values[1] * t + 0.5 * (values[2] - values[1]) * t * t / seconds;
    draft.mean[i] += values[0] * std::sin(kTurn * turns + phase);
  }
}

std::vector<double> shown_values(const Stage& stage, Random& random) {
  const double amplitude = stage.z * stage.white_sd() * std::sqrt(2.0 / stage.samples());
  return {amplitude, 3.0 + 4.0 * random.uniform(), 12.0 + 6.0 * random.uniform()};
}

}  // namespace

Cause chirped_disturbance() {
  return {
      .name = "chirped_disturbance",
      .title = "a disturbance whose frequency runs",
      .equation = "y = amplitude · sin(2π (f₀ t + (f₁ − f₀) t² / (2T)) + φ), T the length of the recording",
      .family = SpectralLine{.examine = examine, .find_again = find_again, .log_gain = log_gain, .values = values_of},
      .rivals = {"periodic_disturbance"},
      .needs = "any recording",
      .separates = "the same recording with the suspected machine at a constant speed",
      .parameters = {{"amplitude", units::level}, {"f0_hz", units::hertz}, {"f1_hz", units::hertz}},
      .inject = inject_effect,
      .showing = {.values = shown_values}};
}

}  // namespace driftlab::investigate
