#include "core/investigate/causes/burst_frames.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <utility>

namespace driftlab::investigate {
namespace {

constexpr double kFrame = 1.0;   ///< [s]
constexpr double kWidth = 3.0;   ///< [Hz] of a band
constexpr double kLowest = 2.0;  ///< [Hz]
constexpr double kFewest = 30.0;

/// Sums of a frame's power up to each ordinate.
struct Frames {
  std::size_t samples = 0;
  double df_hz = 0.0;
  std::size_t lowest = 0, top = 0;  ///< ordinates in use
  std::vector<std::size_t> from;    ///< first sample of each frame
  std::vector<std::vector<double>> sums;
};

Frames frames_of(const FullRate& data, std::size_t r) {
  const Series& e = data.innovation[r];
  Frames frames;
  frames.samples = fast_length(static_cast<std::size_t>(std::max(16.0, std::round(kFrame / data.dt_s))));
  frames.df_hz = 1.0 / (static_cast<double>(frames.samples) * data.dt_s);
  frames.lowest = static_cast<std::size_t>(std::ceil(kLowest / frames.df_hz));
  frames.top = frames.samples / 2;
  for (std::size_t from = 0; from + frames.samples <= e.size(); from += frames.samples) {
    const auto used = std::span(data.used[r]).subspan(from, frames.samples);
    if (std::find(used.begin(), used.end(), 0) != used.end()) {
      continue;  // the ordinates of a frame with holes are not independent
    }
    const auto z = transform(e.part(from, frames.samples));
    std::vector<double> sums(frames.top + 1, 0.0);
    for (std::size_t k = 0; k < frames.top; ++k) {
      sums[k + 1] = sums[k] + std::norm(z[k]) / static_cast<double>(frames.samples);
    }
    frames.sums.push_back(std::move(sums));
    frames.from.push_back(from);
  }
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

/// The F law with its numbers of ordinates.
struct Law {
  double m = 1.0;
  double others = 1.0;
  [[nodiscard]] double log_density(double x, double scale) const {
    return -m * std::log(scale) - (m + others) * std::log1p(m / others * x / scale);
  }
};

double best_scale(const Law& law, const std::vector<double>& ratios) {
  double low = std::log(0.1);
  double high = std::log(10.0);
  const auto value = [&](double log_scale) {
    double sum = 0.0;
    for (const double x : ratios) {
      sum += law.log_density(x, std::exp(log_scale));
    }
    return sum;
  };
  for (int i = 0; i < 30; ++i) {  // one maximum in ln s
    const double third = (high - low) / 3.0;
    if (value(low + third) < value(high - third)) {
      low += third;
    } else {
      high -= third;
    }
  }
  return std::exp(0.5 * (low + high));
}

double log_likelihood(const Law& law, const std::vector<double>& ratios, double scale, double ratio, double fraction) {
  double sum = 0.0;
  for (const double x : ratios) {
    const double rest = std::log1p(-fraction) + law.log_density(x, scale);
    const double loud = fraction > 0.0 ? std::log(fraction) + law.log_density(x, scale * ratio) : -1e300;
    const double top = std::max(rest, loud);
    sum += top + std::log(std::exp(rest - top) + std::exp(loud - top));
  }
  return sum;
}

/// Chance that a frame is loud.
double chance_of(const Law& law, double x, double scale, double ratio, double fraction) {
  const double odds =
      law.log_density(x, scale * ratio) - law.log_density(x, scale) + std::log(fraction / (1.0 - fraction));
  return 1.0 / (1.0 + std::exp(-odds));
}

/// Expectation and maximisation: given who is loud, x / (1 + m x / (M s)) has the mean s M / (m + M).
Burstiness two_kinds(const Law& law, const std::vector<double>& ratios) {
  constexpr int kRounds = 60;
  Burstiness best;
  best.scale = best_scale(law, ratios);
  best.frames = static_cast<double>(ratios.size());
  best.ordinates = law.m;
  const double plain = log_likelihood(law, ratios, best.scale, 1.0, 0.0);
  const double one = best.scale;
  for (const double start : {3.0, 12.0}) {
    double scale = one;
    double ratio = start;
    double fraction = 0.1;
    for (int round = 0; round < kRounds; ++round) {
      double loud = 0.0;
      double loud_sum = 0.0;
      double rest_sum = 0.0;
      for (const double x : ratios) {
        const double p = chance_of(law, x, scale, ratio, fraction);
        loud += p;
        loud_sum += p * x / (1.0 + law.m / law.others * x / (scale * ratio));
        rest_sum += (1.0 - p) * x / (1.0 + law.m / law.others * x / scale);
      }
      const double correction = (law.m + law.others) / law.others;
      const double rest = std::max(1e-9, best.frames - loud);
      scale = std::clamp(correction * rest_sum / rest, 0.02, 50.0);
      ratio = std::clamp(correction * loud_sum / std::max(1e-9, loud) / scale, 1.2, 1e5);
      fraction = std::clamp(loud / best.frames, 1e-4, 0.5);
    }
    const double gain = 2.0 * (log_likelihood(law, ratios, scale, ratio, fraction) - plain);
    if (gain > best.gain) {
      best.gain = gain;
      best.scale = scale;
      best.ratio = ratio;
      best.fraction = fraction;
    }
  }
  return best;
}

struct InBand {
  Law law;
  std::vector<double> ratios;
};

InBand ratios_in(const std::vector<Frames>& all, double centre_hz) {
  InBand in;
  for (const Frames& frames : all) {
    const Ordinates band = ordinates_of(frames, centre_hz);
    if (band.count == 0) {
      return {};
    }
    in.law = {static_cast<double>(band.count), static_cast<double>(frames.top - frames.lowest - band.count)};
    for (std::size_t f = 0; f < frames.sums.size(); ++f) {
      in.ratios.push_back(ratio_of(frames, f, band));
    }
  }
  return in;
}

std::vector<Frames> all_frames(const FullRate& data, const std::vector<std::size_t>& scope) {
  std::vector<Frames> all;
  for (const std::size_t r : scope) {
    all.push_back(frames_of(data, r));
  }
  return all;
}

/// The factor by which bursts of an amplitude raise the band [1].
double ratio_of_amplitude(const FullRate& data, double scale, double amplitude) {
  const double band = data.innovation_sd * data.innovation_sd * scale * 2.0 * kWidth * data.dt_s;
  return std::max(1.001, 1.0 + amplitude * amplitude / band);
}

/// Second moment over the squared mean: large where few frames are loud.
double unevenness(const std::vector<double>& ratios) {
  double sum = 0.0;
  double square = 0.0;
  for (const double x : ratios) {
    sum += x;
    square += x * x;
  }
  return sum > 0.0 ? square * static_cast<double>(ratios.size()) / (sum * sum) : 0.0;
}

}  // namespace

std::optional<Burstiness> strongest_bursts(const FullRate& data, const std::vector<std::size_t>& scope, double& tried) {
  const std::vector<Frames> all = all_frames(data, scope);
  const double nyquist_hz = 0.5 / data.dt_s;
  double most = 0.0;
  double at = 0.0;
  tried = 0.0;
  for (double centre = kLowest + 0.5 * kWidth; centre < nyquist_hz; centre += 0.5 * kWidth) {
    const InBand in = ratios_in(all, centre);
    if (static_cast<double>(in.ratios.size()) < kFewest) {
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
  const InBand in = ratios_in(all, at);
  Burstiness bursts = two_kinds(in.law, in.ratios);
  bursts.centre_hz = at;
  bursts.width_hz = kWidth;
  return bursts;
}

Burstiness bursts_near(const FullRate& data, const std::vector<std::size_t>& scope, double centre_hz) {
  const InBand in = ratios_in(all_frames(data, scope), centre_hz);
  Burstiness bursts = in.ratios.empty() ? Burstiness{} : two_kinds(in.law, in.ratios);
  bursts.centre_hz = centre_hz;
  bursts.width_hz = kWidth;
  return bursts;
}

double burst_gain(const FullRate& data, const std::vector<std::size_t>& scope, double centre_hz, double amplitude,
                  double fraction) {
  const InBand in = ratios_in(all_frames(data, scope), centre_hz);
  if (in.ratios.empty() || !(fraction > 0.0)) {
    return 0.0;
  }
  const double one = best_scale(in.law, in.ratios);
  const Burstiness own = two_kinds(in.law, in.ratios);
  const double ratio = ratio_of_amplitude(data, own.scale, amplitude);
  return log_likelihood(in.law, in.ratios, own.scale, ratio, std::min(fraction, 0.5)) -
         log_likelihood(in.law, in.ratios, one, 1.0, 0.0);
}

std::vector<double> burst_values(const FullRate& data, std::size_t r, double centre_hz, double amplitude,
                                 double fraction) {
  const Series& y = data.residual[r];
  std::vector<double> values(y.size(), 0.0);
  const Frames frames = frames_of(data, r);
  const Ordinates band = ordinates_of(frames, centre_hz);
  if (band.count == 0) {
    return values;
  }
  const InBand in = ratios_in({frames}, centre_hz);
  const double scale = two_kinds(in.law, in.ratios).scale;
  const double ratio = ratio_of_amplitude(data, scale, amplitude);
  for (std::size_t f = 0; f < frames.sums.size(); ++f) {
    if (chance_of(in.law, in.ratios[f], scale, ratio, std::clamp(fraction, 1e-4, 0.5)) < 0.5) {
      continue;
    }
    // What the band holds beyond its noise, by the share of the loud power that is not noise.
    const double kept = 1.0 - 1.0 / ratio;
    const std::size_t from = frames.from[f];
    const auto z = transform(y.part(from, frames.samples));
    const auto n = static_cast<double>(frames.samples);
    for (std::size_t k = band.first; k < band.first + band.count; ++k) {
      const std::complex<double> turn = std::polar(1.0, 2.0 * std::numbers::pi * static_cast<double>(k) / n);
      std::complex<double> phase = 1.0;
      for (std::size_t i = 0; i < frames.samples; ++i) {
        values[from + i] += kept * 2.0 / n * (z[k] * phase).real();
        phase *= turn;
      }
    }
  }
  return values;
}

}  // namespace driftlab::investigate
