/// resonance: one more second-order Gauss-Markov process, a broad peak in the spectra of all recordings or of some.
/// E = (white + slow + what is known besides) + sigma^2 D(f; f0, Q), D the density of the process with its aliases
/// (core/process/resonance.hpp). A peak that a level and a slope of the noise around it explain as well is none, nor is
/// one that a single bin shows: that is a line.
#include "core/process/resonance.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/fullrate/golden_section.hpp"
#include "core/investigate/fullrate/whittle.hpp"
#include "core/process/distributions.hpp"
#include "core/signal/turns.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <utility>

namespace driftlab::investigate {
namespace {

constexpr double kLeastQuality = 2.0;  ///< a hump that is broader is a slope of the noise as well
constexpr double kMostQuality = 60.0;  ///< a peak of half a bin of the spectrum
constexpr std::size_t kFewestBins = 20;
constexpr double kHighest = 0.97;  ///< of the Nyquist frequency
constexpr double kPlaces = 30.0;   ///< peaks of quality 4 that stand side by side in a spectrum

struct Peak {
  double f_hz = 0.0;
  double quality = 1.0;
};

/// The density of a peak of unit variance. Samples of the process are an ARMA(2,1) process (Maybeck 1979,
/// section 4.11): D(f) = [m0 + 2 m1 cos w] / |1 - p1 e^-iw - p2 e^-2iw|^2, w = 2 pi f dt, m0 and m1 from its
/// autocovariance.
class PeakDensity {
 public:
  PeakDensity(const Peak& peak, double dt_s) : dt_s_(dt_s) {
    const Resonance unit{1.0, peak.f_hz, peak.quality};
    const double fall = 0.5 * kTurn * peak.f_hz / peak.quality * dt_s;
    const double turn = kTurn * peak.f_hz * dt_s * std::sqrt(1.0 - 0.25 / (peak.quality * peak.quality));
    p1_ = 2.0 * std::exp(-fall) * std::cos(turn);
    p2_ = -std::exp(-2.0 * fall);
    const std::array<double, 3> weights{1.0, -p1_, -p2_};
    std::array<double, 4> covariance{};
    for (std::size_t lag = 0; lag < covariance.size(); ++lag) {
      covariance.at(lag) = unit.autocovariance(static_cast<double>(lag), dt_s).value_or(0.0);
    }
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        const double product = weights.at(static_cast<std::size_t>(a)) * weights.at(static_cast<std::size_t>(b));
        m0_ += product * covariance.at(static_cast<std::size_t>(std::abs(a - b)));
        m1_ += product * covariance.at(static_cast<std::size_t>(std::abs(a - b - 1)));
      }
    }
  }

  [[nodiscard]] double at(double f_hz) const {
    const double c = std::cos(kTurn * f_hz * dt_s_);
    const double square = 1.0 + p1_ * p1_ + p2_ * p2_ - 2.0 * p1_ * (1.0 - p2_) * c - 2.0 * p2_ * (2.0 * c * c - 1.0);
    return dt_s_ * (m0_ + 2.0 * m1_ * c) / square;
  }

  /// Averaged over a bin of the spectrum (2.5 % wide) where it holds several ordinates.
  [[nodiscard]] double in_bin(double f_hz, double weight) const {
    if (weight < 4.0) {
      return at(f_hz);
    }
    constexpr double kHalf = 0.0125;
    return (at(f_hz * (1.0 - kHalf)) + 4.0 * at(f_hz * (1.0 - 0.5 * kHalf)) + 2.0 * at(f_hz) +
            4.0 * at(f_hz * (1.0 + 0.5 * kHalf)) + at(f_hz * (1.0 + kHalf))) /
           12.0;
  }

 private:
  double dt_s_;
  double p1_ = 0.0;
  double p2_ = 0.0;
  double m0_ = 0.0;
  double m1_ = 0.0;
};

/// The spectra of some recordings, one below the other: what is known of them, and the level that is free.
class Stacked {
 public:
  Stacked(const FullRate& data, const std::vector<std::size_t>& scope, double low_hz, double high_hz)
      : dt_s_(data.dt_s) {
    for (const std::size_t r : scope) {
      const Spectrum& s = data.spectrum[r];
      parts_.push_back({s.samples, f_hz_.size(), 0});
      for (std::size_t j = 0; j < s.power.size(); ++j) {
        if (s.f_hz[j] < low_hz || s.f_hz[j] > high_hz) {
          continue;
        }
        const double gain = data.band_limited() ? butterworth_gain(s.f_hz[j], data.corner_hz, data.dt_s) : 1.0;
        const double floor = 1e-9 * data.model.white + data.lattice_step * data.lattice_step / 12.0 * data.dt_s;
        f_hz_.push_back(s.f_hz[j]);
        power_.push_back(s.power[j]);
        weight_.push_back(s.weight[j]);
        fixed_.push_back(data.slow[r][j] + floor + (data.given ? data.model.white * gain : 0.0));
        white_.push_back(gain);
        ++parts_.back().count;
      }
    }
    free_white_ = !data.given;
    start_ = data.model.white;
    floor_ = data.band_limited();
  }

  [[nodiscard]] std::size_t bins() const { return f_hz_.size(); }
  [[nodiscard]] double f_hz(std::size_t j) const { return f_hz_[j]; }
  [[nodiscard]] double power(std::size_t j) const { return power_[j]; }
  [[nodiscard]] double weight(std::size_t j) const { return weight_[j]; }
  [[nodiscard]] double white(std::size_t j) const { return free_white_ ? white_[j] : 0.0; }

  /// Best levels with a peak, whose level comes last, or without one (null).
  [[nodiscard]] LevelFit fit(const Peak* peak) const {
    LinearDensity density = linear((free_white_ ? 1 : 0) + (floor_ ? 1 : 0) + (peak != nullptr ? 1 : 0));
    if (peak != nullptr) {
      density.shape.col(density.shape.cols() - 1) = column(*peak);
    }
    if (density.shape.cols() == 0) {
      return {{}, {}, whittle(density.power, density.weight, density.fixed)};
    }
    Eigen::VectorXd start = Eigen::VectorXd::Constant(density.shape.cols(), start_);
    if (peak != nullptr) {
      const double top = density.shape.col(start.size() - 1).maxCoeff();
      start[start.size() - 1] = top > 0.0 ? start_ / top : start_;
    }
    return fit_levels(density, start);
  }

  /// Log likelihood with a peak of that variance; every other level is the best.
  [[nodiscard]] double with(const Peak& peak, double variance) const {
    LinearDensity density = linear((free_white_ ? 1 : 0) + (floor_ ? 1 : 0));
    density.fixed += variance * column(peak);
    return density.shape.cols() == 0
               ? whittle(density.power, density.weight, density.fixed)
               : fit_levels(density, Eigen::VectorXd::Constant(density.shape.cols(), start_)).log_likelihood;
  }

  /// Expected density at levels fitted without a peak.
  [[nodiscard]] std::vector<double> without_peak() const {
    const LinearDensity density = linear((free_white_ ? 1 : 0) + (floor_ ? 1 : 0));
    const LevelFit fitted = fit(nullptr);
    Eigen::VectorXd expected = density.fixed;
    if (density.shape.cols() > 0) {
      expected += density.shape * fitted.level;
    }
    return {expected.begin(), expected.end()};
  }

  /// The same bins with another expectation, free by a factor and by a power of the frequency.
  [[nodiscard]] double tilted(const std::vector<double>& expected, const Peak* peak, double middle_hz) const {
    const auto at = [&](double slope) {
      LinearDensity density = linear(peak != nullptr ? 2 : 1);
      density.fixed.setConstant(1e-12 * start_);
      for (std::size_t j = 0; j < bins(); ++j) {
        density.shape(static_cast<Eigen::Index>(j), 0) = expected[j] * std::pow(f_hz_[j] / middle_hz, slope);
      }
      Eigen::VectorXd start = Eigen::VectorXd::Ones(density.shape.cols());
      if (peak != nullptr) {
        density.shape.col(1) = column(*peak);
        start[1] = 0.5 * start_ / std::max(1e-300, density.shape.col(1).maxCoeff());
      }
      return fit_levels(density, start).log_likelihood;
    };
    return at(golden_section(-2.5, 2.5, 14, at));
  }

  /// What one free bin alone would gain: that of a line.
  [[nodiscard]] double gain_of_one_bin(const std::vector<double>& expected) const {
    double most = 0.0;
    for (std::size_t j = 0; j < bins(); ++j) {
      const double ratio = power_[j] / expected[j];
      most = std::max(most, ratio > 1.0 ? 2.0 * weight_[j] * (ratio - 1.0 - std::log(ratio)) : 0.0);
    }
    return most;
  }

  /// The peak's density in every bin; recordings of one length have the same bins.
  [[nodiscard]] Eigen::VectorXd column(const Peak& peak) const {
    const PeakDensity density(peak, dt_s_);
    Eigen::VectorXd column(static_cast<Eigen::Index>(bins()));
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      const Part& own = parts_[part];
      const auto same = std::find_if(parts_.begin(), parts_.begin() + static_cast<std::ptrdiff_t>(part),
                                     [&](const Part& other) { return other.samples == own.samples; });
      const bool known = same != parts_.begin() + static_cast<std::ptrdiff_t>(part);
      for (std::size_t k = 0; k < own.count; ++k) {
        const std::size_t j = own.first + k;
        column[static_cast<Eigen::Index>(j)] =
            known ? column[static_cast<Eigen::Index>(same->first + k)] : density.in_bin(f_hz_[j], weight_[j]);
      }
    }
    return column;
  }

  /// The bins of one recording.
  struct Part {
    std::size_t samples = 0;
    std::size_t first = 0;
    std::size_t count = 0;
  };
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }

 private:
  /// Everything but the shapes of a peak: columns white, floor, others zero.
  [[nodiscard]] LinearDensity linear(int columns) const {
    const auto count = static_cast<Eigen::Index>(bins());
    LinearDensity density;
    density.power = Eigen::Map<const Eigen::VectorXd>(power_.data(), count);
    density.weight = Eigen::Map<const Eigen::VectorXd>(weight_.data(), count);
    density.fixed = Eigen::Map<const Eigen::VectorXd>(fixed_.data(), count);
    density.shape = Eigen::MatrixXd::Zero(count, columns);
    int next = 0;
    if (free_white_ && columns > 0) {
      density.shape.col(next++) = Eigen::Map<const Eigen::VectorXd>(white_.data(), count);
    }
    if (floor_ && columns > next) {
      density.shape.col(next).setOnes();
    }
    return density;
  }

  double dt_s_;
  std::vector<double> f_hz_, power_, weight_, fixed_, white_;
  std::vector<Part> parts_;
  bool free_white_ = true;
  bool floor_ = false;
  double start_ = 1.0;
};

/// Peaks over a grid of frequencies and qualities, and their densities in the bins of every length of recording.
class PeakGrid {
 public:
  PeakGrid(double low_hz, double high_hz, double dt_s) : dt_s_(dt_s) {
    constexpr double kStep = 1.04;
    for (double f = low_hz; f < high_hz; f *= kStep) {
      for (const double quality : {2.0, 4.0, 8.0, 16.0, 32.0}) {
        peaks_.push_back({f, quality});
      }
    }
  }

  /// Where a peak would raise the likelihood fastest, by the score test; frequency 0 where none would raise it.
  [[nodiscard]] Peak best(const Stacked& stacked, const std::vector<double>& expected) {
    Peak best;
    double most = 0.0;
    for (std::size_t p = 0; p < peaks_.size(); ++p) {
      double score = 0.0;
      double information = 0.0;
      double shared = 0.0;
      double white = 1e-300;
      for (const Stacked::Part& part : stacked.parts()) {
        const Eigen::MatrixXd& densities = densities_of(stacked, part);
        for (std::size_t k = 0; k < part.count; ++k) {
          const std::size_t j = part.first + k;
          const double d = densities(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(p)) / expected[j];
          const double w = stacked.white(j) / expected[j];
          score += stacked.weight(j) * (stacked.power(j) / expected[j] - 1.0) * d;
          information += stacked.weight(j) * d * d;
          shared += stacked.weight(j) * d * w;
          white += stacked.weight(j) * w * w;
        }
      }
      const double deviations = score / std::sqrt(std::max(1e-300, information - shared * shared / white));
      if (deviations > most) {
        most = deviations;
        best = peaks_[p];
      }
    }
    return best;
  }

 private:
  const Eigen::MatrixXd& densities_of(const Stacked& stacked, const Stacked::Part& part) {
    const auto known = densities_.find(part.samples);
    if (known != densities_.end()) {
      return known->second;
    }
    Eigen::MatrixXd made(static_cast<Eigen::Index>(part.count), static_cast<Eigen::Index>(peaks_.size()));
    for (std::size_t p = 0; p < peaks_.size(); ++p) {
      const PeakDensity density(peaks_[p], dt_s_);
      for (std::size_t k = 0; k < part.count; ++k) {
        const std::size_t j = part.first + k;
        made(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(p)) =
            density.in_bin(stacked.f_hz(j), stacked.weight(j));
      }
    }
    return densities_.emplace(part.samples, std::move(made)).first->second;
  }

  double dt_s_;
  std::vector<Peak> peaks_;
  std::map<std::size_t, Eigen::MatrixXd> densities_;  ///< by samples of a recording: bins x peaks
};

/// The likelihood's top in frequency and quality, from a place near it.
Peak refined(const Stacked& stacked, Peak peak, double high_hz) {
  double top = stacked.fit(&peak).log_likelihood;
  double step_f = 0.03;
  double step_q = 0.35;
  for (int i = 0; i < 24; ++i) {
    bool moved = false;
    for (const auto& [df, dq] : {std::pair{step_f, 0.0}, {-step_f, 0.0}, {0.0, step_q}, {0.0, -step_q}}) {
      const Peak trial{std::min(peak.f_hz * std::exp(df), high_hz),
                       std::clamp(peak.quality * std::exp(dq), 0.6, kMostQuality)};
      const double l = stacked.fit(&trial).log_likelihood;
      if (l > top) {
        top = l;
        peak = trial;
        moved = true;
      }
    }
    step_f *= moved ? 1.0 : 0.6;
    step_q *= moved ? 1.0 : 0.6;
  }
  return peak;
}

/// Standard deviations of ln sigma, ln f and ln Q from the curvature of the likelihood, every other level the best.
std::array<double, 3> deviations_of(const Stacked& stacked, const Peak& peak, double variance) {
  const std::array<double, 3> step{0.05, 0.15 / peak.quality, 0.1};
  const auto at = [&](const Eigen::Vector3d& off) {
    return stacked.with({peak.f_hz * std::exp(off[1]), peak.quality * std::exp(off[2])},
                        variance * std::exp(2.0 * off[0]));
  };
  const double here = at(Eigen::Vector3d::Zero());
  Eigen::Matrix3d information;
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b) {
      Eigen::Vector3d one = Eigen::Vector3d::Zero();
      Eigen::Vector3d other = Eigen::Vector3d::Zero();
      one[a] = step.at(static_cast<std::size_t>(a));
      other[b] = step.at(static_cast<std::size_t>(b));
      const double curvature =
          a == b ? (at(one) - 2.0 * here + at(-one)) / (one[a] * one[a])
                 : (at(one + other) - at(one - other) - at(other - one) + at(-one - other)) / (4.0 * one[a] * other[b]);
      information(a, b) = information(b, a) = -curvature;
    }
  }
  const Eigen::Matrix3d covariance = information.inverse();
  std::array<double, 3> deviations{};
  for (int a = 0; a < 3; ++a) {
    const double square = covariance(a, a);
    deviations.at(static_cast<std::size_t>(a)) = square > 0.0 && std::isfinite(square) ? std::sqrt(square) : 10.0;
  }
  return deviations;
}

FoundParameter parameter(const char* name, double value, double deviation, const LabUnit& unit) {
  const double factor = std::exp(kNormal975 * std::min(deviation, 5.0));
  return {name, {value, {value / factor, value * factor}}, unit};
}

std::vector<std::vector<std::size_t>> scopes_of_peak(const FullRate& data) {
  std::vector<std::vector<std::size_t>> scopes{all_members(*data.group)};
  const std::vector<std::size_t> moving = moving_members(*data.group);
  if (moving.size() > 1 && moving.size() < data.members()) {
    scopes.push_back(moving);
  }
  for (std::size_t r = 0; data.members() > 1 && r < data.members(); ++r) {
    scopes.push_back({r});
  }
  return scopes;
}

std::optional<Evidence> peak_in(const FullRate& data, const std::vector<std::size_t>& scope, double scopes,
                                PeakGrid& grid) {
  const double nyquist = 0.5 / data.dt_s;
  const double high = kHighest * nyquist;
  const Stacked stacked(data, scope, 0.0, nyquist);
  if (stacked.bins() == 0) {
    return std::nullopt;
  }
  const std::vector<double> expected = stacked.without_peak();
  Peak peak = grid.best(stacked, expected);
  if (peak.f_hz == 0.0) {
    return std::nullopt;
  }
  const double none = stacked.fit(nullptr).log_likelihood;
  const double penalty = 3.0 + choice_penalty(kPlaces) + choice_penalty(scopes);
  if (2.0 * (stacked.fit(&peak).log_likelihood - none) < 0.5 * penalty) {
    return std::nullopt;
  }
  peak = refined(stacked, peak, high);
  const LevelFit fit = stacked.fit(&peak);
  const double variance = fit.level[fit.level.size() - 1];
  if (!(variance > 0.0) || peak.quality < kLeastQuality || peak.quality > 0.95 * kMostQuality ||
      peak.f_hz > 0.999 * high) {
    return std::nullopt;
  }
  Evidence evidence;
  evidence.members = scope;
  evidence.gain = 2.0 * (fit.log_likelihood - none);
  evidence.freedom = 3.0;
  evidence.shape = peak.f_hz;
  // The neighbourhood by itself, whose level and slope are free: what is left of the peak beside other misfit.
  const Stacked near(data, scope, peak.f_hz / 2.5, std::min(nyquist, 2.5 * peak.f_hz));
  const std::vector<double> around = near.without_peak();
  const double local = 2.0 * (near.tilted(around, &peak, peak.f_hz) - near.tilted(around, nullptr, peak.f_hz));
  evidence.score = std::min({evidence.gain, local, evidence.gain - stacked.gain_of_one_bin(expected)}) - penalty;
  const std::array<double, 3> deviation = deviations_of(stacked, peak, variance);
  evidence.parameters = {parameter("sigma", std::sqrt(variance), deviation[0], units::level(data.group->unit)),
                         parameter("frequency_hz", peak.f_hz, deviation[1], units::hertz(data.group->unit)),
                         parameter("quality", peak.quality, deviation[2], units::one(data.group->unit))};
  return evidence;
}

std::vector<Evidence> examine(const FullRate& data) {
  std::vector<Evidence> found;
  const auto seen = std::find_if(data.spectrum.begin(), data.spectrum.end(),
                                 [](const Spectrum& s) { return s.power.size() >= kFewestBins; });
  if (seen == data.spectrum.end()) {
    return found;
  }
  PeakGrid grid(2.0 * seen->f_hz.front(), kHighest * 0.5 / data.dt_s, data.dt_s);
  const auto scopes = scopes_of_peak(data);
  for (const auto& scope : scopes) {
    if (auto evidence = peak_in(data, scope, static_cast<double>(scopes.size()), grid)) {
      found.push_back(*std::move(evidence));
    }
  }
  std::sort(found.begin(), found.end(), [](const Evidence& a, const Evidence& b) { return a.score > b.score; });
  return found;
}

Resonance process_of(const Evidence& found) {
  return {found.parameters[0].estimate.value, found.parameters[1].estimate.value, found.parameters[2].estimate.value};
}

double log_gain(const FullRate& data, const Evidence& found) {
  const Stacked stacked(data, found.members, 0.0, 0.5 / data.dt_s);
  const Resonance process = process_of(found);
  return stacked.with({process.frequency_hz, process.quality}, process.sigma * process.sigma) -
         stacked.fit(nullptr).log_likelihood;
}

double density(const Evidence& found, double f_hz, double dt_s) {
  return *process_of(found).spectral_density(f_hz, dt_s);
}

void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  Resonance{values[0], values[1], values[2]}.add_path(random, draft.recording->dt_s, draft.white);
}

/// Quality 3 to 12 at a tenth to a third of the rate: the gain is that of z deviations in the bins of its width.
std::vector<double> shown_values(const Stage& stage, Random& random) {
  const double f = stage.rate_hz * (0.1 + 0.23 * random.uniform());
  const double quality = 3.0 + 9.0 * random.uniform();
  const double ordinates = stage.samples() * stage.dt_s() * f / quality;
  const double at_peak = stage.z * 2.5 / std::sqrt(ordinates) * stage.density * stage.density;
  return {std::sqrt(at_peak * 0.5 * kTurn * f / quality), f, quality};
}

}  // namespace

Cause resonance() {
  return {.name = "resonance",
          .title = "a resonance: a second-order Gauss-Markov process",
          .family = SpectralPeak{.examine = examine, .log_gain = log_gain, .density = density},
          .rivals = {"periodic_disturbance", "modulated_disturbance", "band_limited_noise"},
          .needs = "any recording",
          .separates = "another mounting or temperature: a resonance moves, a line does not spread",
          .parameters = {{"sigma", units::level}, {"frequency_hz", units::hertz}, {"quality", units::one}},
          .process = "resonance",
          .inject = inject_effect,
          .showing = {.values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
