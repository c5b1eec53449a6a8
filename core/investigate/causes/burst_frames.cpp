#include "core/investigate/causes/burst_frames.hpp"

#include "core/investigate/causes/two_kinds.hpp"
#include "core/investigate/fullrate/autoregression.hpp"
#include "core/investigate/study/measured_constants.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

namespace driftlab::investigate {
namespace {

constexpr double kFrame = 1.0;   ///< [s]
constexpr double kWidth = 3.0;   ///< [Hz] of a band
constexpr double kLowest = 2.0;  ///< [Hz]
constexpr double kFewest = 30.0;
constexpr double kMostCoherent = 0.7;  ///< from one frame to the next

/// Sums of a frame's power up to each ordinate.
struct Frames {
  std::size_t samples = 0;
  double df_hz = 0.0;
  std::size_t lowest = 0, top = 0;  ///< ordinates in use
  std::vector<std::size_t> from;    ///< first sample of each frame
  std::vector<std::vector<double>> sums;
};

std::vector<double> autoregression_of(const FullRate& data, const std::vector<std::size_t>& scope) {
  PooledAutocovariance covariance;
  for (const std::size_t r : scope) {
    covariance.begin_recording();
    for (std::size_t i = 0; i < data.innovation[r].size(); ++i) {
      covariance.take(data.innovation[r][i], data.used[r][i] != 0);
    }
  }
  return covariance.autoregression();
}

/// The innovations of a frame less what those before it foretell.
std::vector<double> whitened(const Series& e, std::size_t from, std::size_t samples, const std::vector<double>& a) {
  std::vector<double> rest(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    rest[i] = e[from + i];
    for (std::size_t k = 1; k <= a.size(); ++k) {
      rest[i] -= a[k - 1] * e[from + i - k];
    }
  }
  return rest;
}

/// Each ordinate in units of its mean over the frames, then their sums.
void normalise(Frames& frames) {
  std::vector<double> mean(frames.top, 0.0);
  for (const auto& power : frames.sums) {
    for (std::size_t k = 0; k < frames.top; ++k) {
      mean[k] += power[k + 1] / static_cast<double>(frames.sums.size());
    }
  }
  for (auto& sums : frames.sums) {
    for (std::size_t k = 0; k < frames.top; ++k) {
      sums[k + 1] = sums[k] + (mean[k] > 0.0 ? sums[k + 1] / mean[k] : 0.0);
    }
  }
}

Frames frames_of(const FullRate& data, std::size_t r, const std::vector<double>& a) {
  const Series& e = data.innovation[r];
  Frames frames;
  frames.samples = fast_length(static_cast<std::size_t>(std::max(16.0, std::round(kFrame / data.dt_s))));
  frames.df_hz = 1.0 / (static_cast<double>(frames.samples) * data.dt_s);
  frames.lowest = static_cast<std::size_t>(std::ceil(kLowest / frames.df_hz));
  frames.top = frames.samples / 2;
  for (std::size_t from = a.size(); from + frames.samples <= e.size(); from += frames.samples) {
    const auto used = std::span(data.used[r]).subspan(from - a.size(), frames.samples + a.size());
    if (std::find(used.begin(), used.end(), 0) != used.end()) {
      continue;  // the ordinates of a frame with holes are not independent
    }
    const auto z = half_spectrum_of(whitened(e, from, frames.samples, a));
    std::vector<double> power(frames.top + 1, 0.0);
    for (std::size_t k = 0; k < frames.top; ++k) {
      power[k + 1] = std::norm(z[k]);
    }
    frames.sums.push_back(std::move(power));
    frames.from.push_back(from);
  }
  normalise(frames);
  return frames;
}

/// Ordinates [first, first + count) of a band; none where it does not fit.
struct Ordinates {
  std::size_t first = 0;
  std::size_t count = 0;
};

Ordinates ordinates_of(const Frames& frames, double centre_hz) {
  const auto count = static_cast<std::size_t>(std::max(2.0, std::round(kWidth / frames.df_hz)));
  const double first = std::round(centre_hz / frames.df_hz - 0.5 * static_cast<double>(count - 1));
  if (first < static_cast<double>(frames.lowest) || frames.top < frames.lowest + 3 * count) {
    return {};
  }
  const auto from = static_cast<std::size_t>(first);
  return from + count <= frames.top ? Ordinates{from, count} : Ordinates{};
}

double ratio_of(const Frames& frames, std::size_t frame, const Ordinates& band) {
  const std::vector<double>& sums = frames.sums[frame];
  const double inside = sums[band.first + band.count] - sums[band.first];
  const double outside = sums[frames.top] - sums[frames.lowest] - inside;
  const auto others = static_cast<double>(frames.top - frames.lowest - band.count);
  return outside > 0.0 ? inside / static_cast<double>(band.count) / (outside / others) : 0.0;
}

struct InBand {
  FrameLaw law;
  FrameRuns ratios;
  std::size_t frames = 0;
};

InBand ratios_in(const std::vector<Frames>& all, double centre_hz) {
  InBand in;
  for (const Frames& frames : all) {
    const Ordinates band = ordinates_of(frames, centre_hz);
    if (band.count == 0) {
      return {};
    }
    in.law = {static_cast<double>(band.count), static_cast<double>(frames.top - frames.lowest - band.count)};
    std::vector<double>& own = in.ratios.emplace_back();
    for (std::size_t f = 0; f < frames.sums.size(); ++f) {
      own.push_back(ratio_of(frames, f, band));
    }
    in.frames += own.size();
  }
  return in;
}

std::vector<Frames> all_frames(const FullRate& data, const std::vector<std::size_t>& scope) {
  const std::vector<double> a = autoregression_of(data, scope);
  std::vector<Frames> all;
  for (const std::size_t r : scope) {
    all.push_back(frames_of(data, r, a));
  }
  return all;
}

/// A band, its two kinds of frames, and how loud each frame is, 0 to 1, by member of the scope.
struct Seen {
  std::vector<Frames> frames;
  Ordinates band;
  InBand in;
  TwoKinds kinds;
  FrameRuns loud;
};

Seen look(std::vector<Frames> frames, double centre_hz) {
  Seen seen;
  seen.in = ratios_in(frames, centre_hz);
  seen.frames = std::move(frames);
  if (seen.in.frames > 0) {
    seen.band = ordinates_of(seen.frames.front(), centre_hz);
    seen.kinds = fit_two_kinds(seen.in.law, seen.in.ratios);
    seen.loud = loud_chances(seen.in.law, seen.in.ratios, seen.kinds);
  }
  return seen;
}

/// Mean power of each ordinate of the residuals in loud frames and in the others [SI^2, as part of the variance].
struct Powers {
  std::size_t first = 0;  ///< ordinate of the first value: two below the band
  std::vector<double> loud, rest;
  double loud_frames = 0.0, other_frames = 0.0;
  std::vector<std::complex<double>> carried;  ///< mean of z z'* of loud frames that follow each other, as `loud`

  [[nodiscard]] double more(std::size_t k) const { return loud[k] - rest[k]; }
};

Powers powers_of(const FullRate& data, const std::vector<std::size_t>& scope, const Seen& seen) {
  // Bins to either side of the band, into which the window of a frame leaks.
  constexpr std::size_t kBeside = 2;
  Powers powers;
  powers.first = seen.band.first - std::min(kBeside, seen.band.first - 1);
  const std::size_t end = std::min(seen.band.first + seen.band.count + kBeside, seen.frames.front().top);
  powers.loud.assign(end - powers.first, 0.0);
  powers.rest.assign(end - powers.first, 0.0);
  powers.carried.assign(end - powers.first, 0.0);
  double pairs = 0.0;
  for (std::size_t m = 0; m < scope.size(); ++m) {
    const Frames& frames = seen.frames[m];
    const double scale = 2.0 / (static_cast<double>(frames.samples) * static_cast<double>(frames.samples));
    std::vector<std::complex<double>> last;
    for (std::size_t f = 0; f < frames.from.size(); ++f) {
      const auto z = half_spectrum_of(data.residual[scope[m]].part(frames.from[f], frames.samples));
      const double p = seen.loud[m][f];
      powers.loud_frames += p;
      powers.other_frames += 1.0 - p;
      for (std::size_t k = powers.first; k < end; ++k) {
        powers.loud[k - powers.first] += p * scale * std::norm(z[k]);
        powers.rest[k - powers.first] += (1.0 - p) * scale * std::norm(z[k]);
      }
      if (f > 0 && frames.from[f] == frames.from[f - 1] + frames.samples) {
        const double both = p * seen.loud[m][f - 1];
        pairs += both;
        for (std::size_t k = powers.first; k < end; ++k) {
          powers.carried[k - powers.first] += both * scale * z[k] * std::conj(last[k]);
        }
      }
      last = z;
    }
  }
  for (std::size_t k = 0; k < powers.loud.size(); ++k) {
    powers.loud[k] /= std::max(1e-9, powers.loud_frames);
    powers.rest[k] /= std::max(1e-9, powers.other_frames);
    powers.carried[k] /= std::max(1e-9, pairs);
  }
  return powers;
}

/// How much of what loud frames hold more goes on in the next frame with its phase, 0 to 1: all of a line that swells,
/// little of noise that is wide against the length of a frame.
double coherence(const Powers& powers) {
  double carried = 0.0;
  double more = 0.0;
  for (std::size_t k = 0; k < powers.loud.size(); ++k) {
    if (powers.more(k) > 0.0) {
      more += powers.more(k);
      carried += std::abs(powers.carried[k]);
    }
  }
  return more > 0.0 ? carried / more : 1.0;
}

/// Amplitude and centroid of what loud frames hold more. Narrow noise stays alike for about two frames.
void measure(const Powers& powers, double df_hz, Burstiness& bursts) {
  // Frames that narrow noise stays alike for, about; the error of the amplitude counts them as one.
  constexpr double kAlike = 2.0;
  double more = 0.0;
  double moment = 0.0;
  for (std::size_t k = 0; k < powers.loud.size(); ++k) {
    more += powers.more(k);
    moment += powers.more(k) * static_cast<double>(powers.first + k) * df_hz;
  }
  if (!(more > 0.0)) {
    return;
  }
  bursts.amplitude = std::sqrt(more);
  bursts.frequency_hz = moment / more;
  double variance = 0.0;
  double spread = 0.0;
  for (std::size_t k = 0; k < powers.loud.size(); ++k) {
    const double own = kAlike * powers.loud[k] * powers.loud[k] / std::max(1.0, powers.loud_frames) +
                       powers.rest[k] * powers.rest[k] / std::max(1.0, powers.other_frames);
    const double off = static_cast<double>(powers.first + k) * df_hz - bursts.frequency_hz;
    variance += own;
    spread += own * off * off;
  }
  bursts.amplitude_sd = 0.5 * std::sqrt(variance) / bursts.amplitude;
  bursts.frequency_sd = std::sqrt(spread) / more + 0.02 * df_hz;
}

double runs_in(const Seen& seen) {
  double runs = 0.0;
  for (std::size_t m = 0; m < seen.loud.size(); ++m) {
    bool last = false;
    for (const double p : seen.loud[m]) {
      runs += p > 0.5 && !last ? 1.0 : 0.0;
      last = p > 0.5;
    }
  }
  return runs;
}

Burstiness describe(const FullRate& data, const std::vector<std::size_t>& scope, const Seen& seen, double centre_hz) {
  Burstiness bursts;
  bursts.centre_hz = centre_hz;
  bursts.frequency_hz = centre_hz;
  if (seen.loud.empty()) {
    return bursts;
  }
  bursts.gain = seen.kinds.gain;
  bursts.fraction = seen.kinds.fraction;
  bursts.bursts = runs_in(seen);
  const Powers powers = powers_of(data, scope, seen);
  bursts.coherence = coherence(powers);
  measure(powers, seen.frames.front().df_hz, bursts);
  return bursts;
}

/// Second moment over the squared mean of sums over a few frames: large where few stretches are loud.
double unevenness(const FrameRuns& runs) {
  // Frames that are summed. Chosen, not measured: bursts of a few frames to a few tens stand out.
  constexpr std::size_t kTogether = 4;
  double count = 0.0;
  double sum = 0.0;
  double square = 0.0;
  for (const std::vector<double>& run : runs) {
    for (std::size_t f = 0; f + kTogether <= run.size(); ++f) {
      const auto at = run.begin() + static_cast<std::ptrdiff_t>(f);
      const double x = std::accumulate(at, at + kTogether, 0.0);
      count += 1.0;
      sum += x;
      square += x * x;
    }
  }
  return sum > 0.0 ? square * count / (sum * sum) : 0.0;
}

}  // namespace

std::optional<Burstiness> strongest_bursts(const FullRate& data, const std::vector<std::size_t>& scope, double& tried) {
  std::vector<Frames> all = all_frames(data, scope);
  const double nyquist_hz = 0.5 / data.dt_s;
  double most = 0.0;
  double at = 0.0;
  tried = 0.0;
  for (double centre = kLowest + 0.5 * kWidth; centre < nyquist_hz && !data.stopped(); centre += 0.5 * kWidth) {
    const InBand in = ratios_in(all, centre);
    if (static_cast<double>(in.frames) < kFewest) {
      continue;
    }
    tried += 1.0;
    const double uneven = unevenness(in.ratios);
    if (uneven > most) {
      most = uneven;
      at = centre;
    }
  }
  if (tried == 0.0) {
    return std::nullopt;
  }
  const Burstiness bursts = describe(data, scope, look(std::move(all), at), at);
  const double fewest = std::max(3.0, static_cast<double>(scope.size()) + 1.0);
  const bool noise = bursts.coherence < kMostCoherent && bursts.fraction < kMostOften;
  return bursts.bursts >= fewest && bursts.amplitude > 0.0 && noise ? std::optional(bursts) : std::nullopt;
}

Burstiness bursts_near(const FullRate& data, const std::vector<std::size_t>& scope, double centre_hz) {
  return describe(data, scope, look(all_frames(data, scope), centre_hz), centre_hz);
}

double burst_gain(const FullRate& data, const std::vector<std::size_t>& scope, double centre_hz, double amplitude,
                  double fraction) {
  const Seen seen = look(all_frames(data, scope), centre_hz);
  if (seen.loud.empty() || !(fraction > 0.0) || !(amplitude > 0.0)) {
    return 0.0;
  }
  const Powers powers = powers_of(data, scope, seen);
  double rest = 0.0;
  for (std::size_t k = seen.band.first; k < seen.band.first + seen.band.count; ++k) {
    rest += powers.rest[k - powers.first];
  }
  const double ratio = 1.0 + amplitude * amplitude / std::max(rest, 1e-300);
  const InBand& in = seen.in;
  const TwoKinds kinds{seen.kinds.scale, ratio, std::min(fraction, 0.5), std::max(2.0, seen.kinds.length), 0.0};
  const TwoKinds one{.scale = best_scale(in.law, in.ratios)};
  return log_likelihood(in.law, in.ratios, kinds) - log_likelihood(in.law, in.ratios, one);
}

std::vector<double> burst_values(const FullRate& data, const std::vector<std::size_t>& scope, std::size_t r,
                                 double centre_hz) {
  const Series& y = data.residual[r];
  std::vector<double> values(y.size(), 0.0);
  const Seen seen = look(all_frames(data, scope), centre_hz);
  const auto own = static_cast<std::size_t>(std::find(scope.begin(), scope.end(), r) - scope.begin());
  if (own >= seen.loud.size()) {
    return values;
  }
  const Powers powers = powers_of(data, scope, seen);
  const Frames& frames = seen.frames[own];
  const auto n = static_cast<double>(frames.samples);
  for (std::size_t f = 0; f < frames.from.size(); ++f) {
    if (seen.loud[own][f] < 0.5) {
      continue;
    }
    const std::size_t from = frames.from[f];
    const auto z = half_spectrum_of(y.part(from, frames.samples));
    for (std::size_t k = 0; k < powers.loud.size(); ++k) {
      const double more = powers.more(k) > 0.0 ? 1.0 - std::sqrt(powers.rest[k] / powers.loud[k]) : 0.0;
      const auto ordinate = static_cast<double>(powers.first + k);
      const std::complex<double> turn = std::polar(1.0, 2.0 * std::numbers::pi * ordinate / n);
      std::complex<double> phase = 1.0;
      for (std::size_t i = 0; i < frames.samples; ++i) {
        values[from + i] += more * 2.0 / n * (z[powers.first + k] * phase).real();
        phase *= turn;
      }
    }
  }
  return values;
}

}  // namespace driftlab::investigate
