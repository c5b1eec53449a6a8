/// modulated_disturbance: a sinusoid of f0 whose amplitude goes to nothing and back at fm, `amplitude` at its peak:
///   A/2 (1 + cos(2 pi fm t + b)) sin(2 pi f0 t + a),
/// a line of A/2 and two of A/4 beside it. About the strongest line the two lines at the same distance on either side
/// are added to it, for every distance up to half a hertz; the distance costs what there are to choose from.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/lines.hpp"
#include "core/investigate/causes/narrow_band.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/signal/turns.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

constexpr double kFarthest = 0.45;  ///< [Hz]
constexpr double kLowest = 1.0;     ///< [Hz]: below, slow noise has company of its own
/// Score of the two lines beside the carrier, where that is a finding by itself and where it is one of the many peaks
/// of a spectrum.
constexpr double kBesideALine = 4.0;
constexpr double kBesideAPeak = 12.0;
constexpr double kLine = 10.0;  ///< score of a carrier that is a finding by itself

double length_s(const FullRate& data, std::size_t r) {
  return static_cast<double>(data.innovation[r].size()) * data.dt_s;
}

/// X of the scope's recordings together at frequencies about one.
class Neighbourhood {
 public:
  Neighbourhood(const FullRate& data, const std::vector<std::size_t>& scope, double f_hz) {
    const auto block = static_cast<std::size_t>(std::max(1.0, std::round(1.0 / data.dt_s)));
    for (const std::size_t r : scope) {
      beaten_.push_back(beat(data, r, {f_hz, 0.0}, block));
      excess_.push_back(BandPower(data, r).most_between(f_hz - kFarthest, f_hz + kFarthest));
    }
  }
  [[nodiscard]] double operator()(double df_hz) const {
    double x = 0.0;
    for (std::size_t k = 0; k < beaten_.size(); ++k) {
      x += std::norm(ordinate(k, df_hz));
    }
    return x;
  }
  /// X of a carrier and two lines beside it whose amplitudes are as 2 : 1 : 1 and whose phases are those of one
  /// envelope: three numbers a recording where three lines have six.
  [[nodiscard]] double whole(double df_hz, double fm_hz) const {
    double x = 0.0;
    for (std::size_t k = 0; k < beaten_.size(); ++k) {
      x += best_envelope(ordinate(k, df_hz), ordinate(k, df_hz - fm_hz), ordinate(k, df_hz + fm_hz));
    }
    return x;
  }

 private:
  /// Of recording k; its square is chi-square with two degrees of freedom where there is noise alone.
  [[nodiscard]] std::complex<double> ordinate(std::size_t k, double df_hz) const {
    std::complex<double> sum = 0.0;
    const std::complex<double> turn = std::polar(1.0, -kTurn * df_hz * beaten_[k].step_s);
    std::complex<double> phase = 1.0;
    for (const auto& value : beaten_[k].sums) {
      sum += times(value, phase);
      phase = times(phase, turn);
    }
    return sum * std::sqrt(2.0 / std::max(1.0, beaten_[k].samples) / excess_[k]);
  }
  /// Square of the projection on (2, e^-ia, e^ia) / sqrt(6), at the a that makes it largest.
  static double best_envelope(const std::complex<double>& carrier, const std::complex<double>& low,
                              const std::complex<double>& high) {
    constexpr int kSteps = 24;
    double most = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const auto turn = std::polar(1.0, kTurn * static_cast<double>(i) / kSteps);
      most = std::max(most, std::norm(2.0 * carrier + times(turn, low) + times(std::conj(turn), high)));
    }
    return most / 6.0;
  }

  std::vector<Beaten> beaten_;
  std::vector<double> excess_;
};

struct Triple {
  double f_hz = 0.0;
  double fm_hz = 0.0;
  double x = 0.0;
  double beside = 0.0;  ///< of x, what the two lines beside the carrier hold
  double whole = 0.0;   ///< X of one sinusoid whose amplitude goes from nothing to its peak
};

/// The best carrier and distance near a pair of them.
Triple refined(const Neighbourhood& near, double f_hz, double df, double fm, double step) {
  const auto value = [&](double f, double m) { return near(f) + near(f - m) + near(f + m); };
  Triple best{df, fm, value(df, fm), 0.0, 0.0};
  for (int round = 0; round < 5; ++round, step *= 0.5) {
    const Triple centre = best;
    for (int i = -2; i <= 2; ++i) {
      for (int j = -2; j <= 2; ++j) {
        const double x = value(centre.f_hz + i * step, centre.fm_hz + j * step);
        if (x > best.x) {
          best = {centre.f_hz + i * step, centre.fm_hz + j * step, x, 0.0, 0.0};
        }
      }
    }
  }
  best.beside = best.x - near(best.f_hz);
  best.whole = near.whole(best.f_hz, best.fm_hz);
  best.f_hz += f_hz;
  return best;
}

/// The strongest triple about a line.
Triple triple_about(const FullRate& data, const std::vector<std::size_t>& scope, double f_hz) {
  double longest = 0.0;
  for (const std::size_t r : scope) {
    longest = std::max(longest, length_s(data, r));
  }
  const Neighbourhood near(data, scope, f_hz);
  const double step = 0.3 / longest;
  double most = 0.0;
  double at = 0.0;
  for (double fm = 2.0 / longest; fm < kFarthest && !data.stopped(); fm += step) {
    const double x = std::min(near(fm), 1e300) + near(-fm);
    if (x > most) {
      most = x;
      at = fm;
    }
  }
  return refined(near, f_hz, 0.0, at, step);
}

std::vector<Sweep> lines_of(double f_hz, double fm_hz) {
  return {{f_hz, 0.0}, {f_hz - fm_hz, 0.0}, {f_hz + fm_hz, 0.0}};
}

/// The two beside it stand out by themselves, and neither alone does.
bool is_modulated(const FullRate& data, const std::vector<std::size_t>& scope, const Triple& triple) {
  constexpr double kLeastShare = 0.1;  // of the power beside the carrier, that the weaker of the two holds
  double low = 0.0;
  double high = 0.0;
  double carrier = 0.0;
  for (const std::size_t r : scope) {
    const PhaseFit fit = fit_phases(data, r, lines_of(triple.f_hz, triple.fm_hz));
    carrier += std::norm(fit.amplitude[0]);
    low += std::norm(fit.amplitude[1]);
    high += std::norm(fit.amplitude[2]);
  }
  return std::min(low, high) > kLeastShare * (low + high) && low + high > 0.05 * carrier;
}

Evidence describe(const FullRate& data, const std::vector<std::size_t>& scope, const Triple& triple) {
  double weight = 0.0;
  double mean = 0.0;
  double longest = 0.0;
  double power = 0.0;
  double beside = 0.0;
  for (const std::size_t r : scope) {
    const PhaseFit fit = fit_phases(data, r, lines_of(triple.f_hz, triple.fm_hz));
    double peak = 0.0;
    for (std::size_t k = 0; k < fit.amplitude.size(); ++k) {
      const double square = std::max(0.0, std::norm(fit.amplitude[k]) - fit.variance);
      peak += std::sqrt(square);
      power += square / fit.variance;
      beside += k > 0 ? square / fit.variance : 0.0;
    }
    // The modulation is whole: the three moduli, 1/2, 1/4 and 1/4 of A, each with the same variance.
    weight += 1.0 / (3.0 * fit.variance);
    mean += peak / (3.0 * fit.variance);
    longest = std::max(longest, length_s(data, r));
  }
  const double amplitude = mean / weight;
  const double sd = 1.0 / std::sqrt(weight);
  const double sd_f = std::sqrt(12.0 / std::max(power, 1.0)) / (kTurn * longest);
  const double sd_m = std::sqrt(12.0 / std::max(beside, 1.0)) / (kTurn * longest);
  Evidence evidence;
  evidence.members = scope;
  evidence.gain = triple.x;
  evidence.freedom = 3.0 + 3.0 * static_cast<double>(scope.size());
  evidence.shape = triple.f_hz;
  evidence.parameters = {
      {"amplitude",
       {amplitude, {std::max(0.0, amplitude - 1.96 * sd), amplitude + 1.96 * sd}},
       units::level(data.group->unit)},
      {"frequency_hz", {triple.f_hz, {triple.f_hz - 1.96 * sd_f, triple.f_hz + 1.96 * sd_f}}, units::hertz({})},
      {"modulation_hz", {triple.fm_hz, {triple.fm_hz - 1.96 * sd_m, triple.fm_hz + 1.96 * sd_m}}, units::hertz({})}};
  return evidence;
}

std::vector<Evidence> examine(const FullRate& data) {
  std::vector<Evidence> found;
  const auto lines = find_lines(data);
  const double scopes = static_cast<double>(scopes_of(data).size());
  for (const Evidence& line : lines) {
    const auto recordings = static_cast<double>(line.members.size());
    double longest = 0.0;
    for (const std::size_t r : line.members) {
      longest = std::max(longest, length_s(data, r));
    }
    if (data.stopped()) {
      break;
    }
    if (line.shape < kLowest) {
      continue;
    }
    const Triple triple = triple_about(data, line.members, line.shape);
    const double frequencies = 0.75 * longest / data.dt_s;
    const double chance = std::min(log_tail(triple.x, 3.0 * recordings), log_tail(triple.whole, 1.5 * recordings));
    const double score = -2.0 * chance - choice_penalty(frequencies) - choice_penalty(3.0 * kFarthest * longest) -
                         choice_penalty(scopes);
    // By themselves the two beside it must be more than chance, or the line is one line.
    const double beside = -2.0 * log_tail(triple.beside, 2.0 * recordings) - choice_penalty(3.0 * kFarthest * longest);
    if (score < 4.0 || beside < (line.score > kLine ? kBesideALine : kBesideAPeak) ||
        !is_modulated(data, line.members, triple)) {
      continue;
    }
    Evidence evidence = describe(data, line.members, triple);
    evidence.score = score;
    found.push_back(std::move(evidence));
  }
  return found;
}

Evidence find_again(const FullRate& part, const Evidence& found) {
  const double f = found.parameters[1].estimate.value;
  double longest = 0.0;
  for (const std::size_t r : found.members) {
    longest = std::max(longest, length_s(part, r));
  }
  const Neighbourhood near(part, found.members, f);
  return describe(part, found.members, refined(near, f, 0.0, found.parameters[2].estimate.value, 0.3 / longest));
}

double log_gain(const FullRate& data, const Evidence& found) {
  const double amplitude = found.parameters[0].estimate.value;
  double gain = 0.0;
  for (const std::size_t r : found.members) {
    const PhaseFit fit =
        fit_phases(data, r, lines_of(found.parameters[1].estimate.value, found.parameters[2].estimate.value));
    for (std::size_t k = 0; k < fit.amplitude.size(); ++k) {
      gain += log_gain_of(fit.amplitude[k], fit.variance, (k == 0 ? 0.5 : 0.25) * amplitude);
    }
  }
  return gain;
}

std::vector<double> values_of(const FullRate& data, std::size_t r, const Evidence& found) {
  return fit_phases(data, r, lines_of(found.parameters[1].estimate.value, found.parameters[2].estimate.value)).values;
}

void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  const double carrier = kTurn * random.uniform();
  const double envelope = kTurn * random.uniform();
  for (std::size_t i = 0; i < draft.mean.size(); ++i) {
    const double t = draft.recording->time_s(i);
    draft.mean[i] += 0.5 * values[0] * (1.0 + std::cos(kTurn * values[2] * t + envelope)) *
                     std::sin(kTurn * values[1] * t + carrier);
  }
}

/// The mean square of the whole is 3/16 of the peak's.
std::vector<double> shown_values(const Stage& stage, Random& random) {
  const double amplitude = stage.z * stage.white_sd() * std::sqrt(16.0 / 3.0 / stage.samples());
  return {amplitude, 3.0 + 8.0 * random.uniform(), 0.02 + 0.04 * random.uniform()};
}

}  // namespace

Cause modulated_disturbance() {
  return {
      .name = "modulated_disturbance",
      .title = "a sinusoidal disturbance that swells and fades",
      .equation = "y = amplitude / 2 · (1 + cos(2π · modulation · t + ψ)) · sin(2π · frequency · t + φ)",
      .family = SpectralLine{.examine = examine, .find_again = find_again, .log_gain = log_gain, .values = values_of},
      .rivals = {"periodic_disturbance"},
      .needs = "any recording",
      .separates = "a longer recording: two lines beat as one that is modulated, three do not",
      .parameters = {{"amplitude", units::level}, {"frequency_hz", units::hertz}, {"modulation_hz", units::hertz}},
      .inject = inject_effect,
      .showing = {.values = shown_values}};
}

}  // namespace driftlab::investigate
