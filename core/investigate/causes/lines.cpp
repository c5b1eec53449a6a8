#include "core/investigate/causes/lines.hpp"

#include "core/investigate/causes/units.hpp"
#include "core/investigate/fullrate/fourier.hpp"
#include "core/investigate/slow/profile.hpp"
#include "core/signal/progress.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <span>

namespace driftlab::investigate {
namespace {

constexpr double kPi = std::numbers::pi;

/// X on a common grid of frequencies for every recording.
struct LineSpectra {
  double df_hz = 0.0;
  std::vector<std::span<const double>> x;  ///< per recording
  std::vector<double> samples;             ///< n_r
  std::size_t bins = 0;
  std::vector<std::vector<double>> memory;  ///< of all x but the last
  std::vector<std::complex<double>> last;   ///< the transform that holds the last one
};

/// Divides values by the larger of two running means that leave out the centre.
void put_against_neighbours(std::span<double> power, double per_hz, double oversampling) {
  const std::size_t n = power.size();
  const auto narrow = static_cast<std::ptrdiff_t>(std::max(24.0 * oversampling, 0.15 * per_hz));
  const auto wide = std::max<std::ptrdiff_t>(4 * narrow, static_cast<std::ptrdiff_t>(2.0 * per_hz));
  // Running sums up to each value, of which those within the wider mean are kept.
  const std::size_t kept = std::min(2 * static_cast<std::size_t>(wide) + 3, n + 1);
  std::vector<double> sum(kept, 0.0);
  const auto gap = static_cast<std::ptrdiff_t>(std::lround(4.0 * oversampling));
  const auto mean_over = [&](std::size_t i, std::ptrdiff_t half) {
    const auto at = static_cast<std::ptrdiff_t>(i);
    const auto clamp = [&](std::ptrdiff_t k) {
      return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k, 1, static_cast<std::ptrdiff_t>(n)));
    };
    const std::size_t a = clamp(at - half);
    const std::size_t b = clamp(at - gap);
    const std::size_t c = clamp(at + gap + 1);
    const std::size_t d = clamp(at + half + 1);
    const auto count = static_cast<double>((b - a) + (d - c));
    return count > 0.0 ? (sum[b % kept] - sum[a % kept] + sum[d % kept] - sum[c % kept]) / count : 1.0;
  };
  std::size_t summed = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (; summed < std::min(n, i + static_cast<std::size_t>(wide) + 1); ++summed) {
      sum[(summed + 1) % kept] = sum[summed % kept] + power[summed];
    }
    power[i] /= std::max(mean_over(i, narrow), mean_over(i, wide));
  }
}

/// The factor times the squared moduli of complex values, in the front half of their own memory: of the padded
/// transform of a day that is a quarter of a gigabyte.
std::span<double> moduli_in_place(std::vector<std::complex<double>>& z, double numerator, double denominator) {
  auto* const parts = reinterpret_cast<double*>(z.data());  // [complex.numbers.general]: real part, imaginary part
  for (std::size_t i = 0; i < z.size(); ++i) {
    parts[i] = numerator * std::norm(z[i]) / denominator;
  }
  return {parts, z.size()};
}

LineSpectra line_spectra(const FullRate& data) {
  LineSpectra spectra;
  std::size_t longest = 0;
  for (const auto& e : data.innovation) {
    longest = std::max(longest, e.size());
  }
  std::size_t length = 1;
  while (length < 2 * longest) {
    length *= 2;
  }
  spectra.df_hz = 1.0 / (static_cast<double>(length) * data.dt_s);
  spectra.bins = length / 2 + 1;
  for (const Series& e : data.innovation) {
    if (!spectra.x.empty()) {
      spectra.x.back() = spectra.memory.emplace_back(spectra.x.back().begin(), spectra.x.back().end());
      spectra.last = {};
    }
    spectra.last = half_spectrum(
        length, [&](std::size_t i) { return i < e.size() ? std::clamp(e[i], -6.0, 6.0) : 0.0; }, kWholeTransform,
        data.stop);
    if (data.stopped()) {
      break;  // no line will be looked for
    }
    const auto n = static_cast<double>(e.size());
    const std::span<double> x = moduli_in_place(spectra.last, 2.0, n);
    put_against_neighbours(x, 1.0 / spectra.df_hz, static_cast<double>(length) / n);
    for (double& v : x) {
      v *= 2.0;
    }
    spectra.x.push_back(x);
    spectra.samples.push_back(n);
  }
  return spectra;
}

/// -2 ln of the tail probability of T = s^2.
double surprise(double s2, const std::vector<std::size_t>& scope, const LineSpectra& spectra, double total) {
  const auto r = static_cast<double>(scope.size());
  double log_p = -0.5 * s2 + 0.5 * (r - 1.0) * std::log(2.0 * kPi * std::max(s2, 1.0));
  for (const std::size_t m : scope) {
    log_p += 0.5 * std::log(spectra.samples[m] / total);
  }
  return -2.0 * std::min(0.0, log_p);
}

struct Peak {
  double surprise = 0.0;
  double s2 = 0.0;
  std::size_t at = 0;
};

double combined(const LineSpectra& spectra, const std::vector<std::size_t>& scope, std::size_t i, double total) {
  double sum = 0.0;
  for (const std::size_t r : scope) {
    sum += std::sqrt(spectra.samples[r] * spectra.x[r][i]);
  }
  return sum * sum / total;
}

/// Amplitude and phase of one sinusoid in one recording: a = A cos, b = A sin with their variance.
struct Phasor {
  double a = 0.0, b = 0.0, variance = 1.0;
};

/// The angle of a line at sample i.
double angle_at(const FullRate& data, double f_hz, std::size_t i) {
  return 2.0 * kPi * f_hz * static_cast<double>(i) * data.dt_s;
}

Phasor measure(const FullRate& data, std::size_t r, double f_hz, double level) {
  const std::size_t n = data.residual[r].size();
  double ss = 0.0;
  double cc = 0.0;
  double sc = 0.0;
  double ys = 0.0;
  double yc = 0.0;
  double mean = 0.0;
  for (const double y : data.residual[r]) {
    mean += y / static_cast<double>(n);
  }
  for (std::size_t i = 0; i < n && !polled(data.stop, i); ++i) {
    if (data.used[r][i] == 0) {
      continue;
    }
    const double y = data.residual[r][i] - mean;
    const double angle = angle_at(data, f_hz, i);
    const double sine = std::sin(angle);
    const double cosine = std::cos(angle);
    ss += sine * sine;
    cc += cosine * cosine;
    sc += sine * cosine;
    ys += y * sine;
    yc += y * cosine;
  }
  const double det = ss * cc - sc * sc;
  if (!(det > 0.0)) {  // no sample in use, as in the half of a recording that froze: nothing is known of a line
    return {0.0, 0.0, std::numeric_limits<double>::infinity()};
  }
  return {(ys * cc - yc * sc) / det, (yc * ss - ys * sc) / det, level / (0.5 * (ss + cc)) / data.dt_s};
}

/// Density of the residual around f, without the line itself [SI^2 s].
double density_near(const FullRate& data, std::size_t r, double f_hz) {
  if (data.stopped()) {
    return 1.0;
  }
  const std::size_t n = fast_length(data.residual[r].size());
  const auto z = half_spectrum_of(data.residual[r].part(0, n), 0, data.stop);
  const double df = 1.0 / (static_cast<double>(n) * data.dt_s);
  const auto centre = static_cast<std::ptrdiff_t>(std::lround(f_hz / df));
  const auto half = static_cast<std::ptrdiff_t>(std::max(30.0, 0.2 / df));
  std::vector<double> around;
  for (std::ptrdiff_t k = centre - half; k <= centre + half; ++k) {
    if (k > 1 && k < static_cast<std::ptrdiff_t>(z.size()) && std::abs(k - centre) > 3) {
      around.push_back(std::norm(z[static_cast<std::size_t>(k)]) * data.dt_s / static_cast<double>(n));
    }
  }
  double sum = 0.0;
  for (const double p : around) {
    sum += p / static_cast<double>(around.size());
  }
  // Samples out of use hold no noise.
  const auto end = data.used[r].begin() + static_cast<std::ptrdiff_t>(n);
  const auto used = std::count_if(data.used[r].begin(), end, [](unsigned char u) { return u != 0; });
  return used > 0 ? sum * static_cast<double>(n) / static_cast<double>(used) : sum;
}

Evidence describe(const FullRate& data, const LineSpectra& spectra, const std::vector<std::size_t>& scope,
                  const Peak& peak, double total) {
  // Refine the frequency on the combined statistic by a parabola through three points.
  double f = static_cast<double>(peak.at) * spectra.df_hz;
  if (peak.at > 1 && peak.at + 1 < spectra.bins) {
    const double y0 = combined(spectra, scope, peak.at - 1, total);
    const double y2 = combined(spectra, scope, peak.at + 1, total);
    const double curve = y0 - 2.0 * peak.s2 + y2;
    if (curve < 0.0) {
      f += 0.5 * (y0 - y2) / curve * spectra.df_hz;
    }
  }
  // The same by least squares on the residuals themselves: A^2 summed over recordings, two more parabolas.
  std::vector<double> level(scope.size());
  for (std::size_t k = 0; k < scope.size(); ++k) {
    level[k] = density_near(data, scope[k], f);
  }
  const auto strength = [&](double freq) {
    double sum = 0.0;
    for (std::size_t k = 0; k < scope.size(); ++k) {
      const Phasor p = measure(data, scope[k], freq, level[k]);
      sum += (p.a * p.a + p.b * p.b) / p.variance;
    }
    return sum;
  };
  double step = 0.15 * spectra.df_hz;
  for (int i = 0; i < 2; ++i, step *= 0.3) {
    const double y0 = strength(f - step);
    const double y1 = strength(f);
    const double y2 = strength(f + step);
    const double curve = y0 - 2.0 * y1 + y2;
    if (curve < 0.0) {
      f += std::clamp(0.5 * (y0 - y2) / curve, -1.5, 1.5) * step;
    }
  }
  // Common amplitude: weighted mean of the moduli, less the noise's share of each, A ~ m - var/(2 m).
  double weight = 0.0;
  double mean = 0.0;
  double bias = 0.0;
  double information = 0.0;  // of the frequency
  for (std::size_t k = 0; k < scope.size(); ++k) {
    const Phasor p = measure(data, scope[k], f, level[k]);
    const double modulus = std::hypot(p.a, p.b);
    weight += 1.0 / p.variance;
    mean += modulus / p.variance;
    bias += 1.0;
    const double length = spectra.samples[scope[k]] * data.dt_s;
    information += modulus * modulus / p.variance * length * length / 12.0;
  }
  mean /= weight;
  const double amplitude = std::max(0.0, mean - 0.5 * bias / weight / mean);
  const double sd = std::sqrt(1.0 / weight);
  const double sd_f = 1.0 / (2.0 * kPi * std::sqrt(std::max(information, 1e-12)));
  Evidence evidence;
  evidence.members = scope;
  evidence.gain = peak.s2;
  evidence.freedom = 2.0 + static_cast<double>(scope.size());
  evidence.shape = f;
  evidence.parameters = {{"amplitude",
                          {amplitude, {std::max(0.0, amplitude - 1.96 * sd), amplitude + 1.96 * sd}},
                          units::level(data.group->unit)},
                         {"frequency_hz", {f, {f - 1.96 * sd_f, f + 1.96 * sd_f}}, units::hertz(data.group->unit)}};
  return evidence;
}

/// Other peaks within 3 Hz, farther than a few resolution widths.
std::size_t company(const LineSpectra& spectra, const std::vector<std::size_t>& scope, const Peak& peak, double total) {
  const double longest = spectra.samples[scope.front()];
  const auto width = static_cast<std::ptrdiff_t>(6.0 * static_cast<double>(2 * spectra.bins) / longest);
  const auto reach = static_cast<std::ptrdiff_t>(3.0 / spectra.df_hz);
  std::size_t peaks = 0;
  std::ptrdiff_t last = -1000000;
  const auto centre = static_cast<std::ptrdiff_t>(peak.at);
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(1, centre - reach);
       i < std::min(static_cast<std::ptrdiff_t>(spectra.bins), centre + reach); ++i) {
    if (std::abs(i - centre) <= width || i - last <= width) {
      continue;
    }
    const double s2 = combined(spectra, scope, static_cast<std::size_t>(i), total);
    if (surprise(s2, scope, spectra, total) > 22.0) {
      ++peaks;
      last = i;
    }
  }
  return peaks;
}

}  // namespace

std::vector<double> fitted_line(const FullRate& data, std::size_t r, double f_hz) {
  const Phasor phasor = measure(data, r, f_hz, 1.0);
  std::vector<double> line(data.residual[r].size());
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double angle = angle_at(data, f_hz, i);
    line[i] = phasor.a * std::sin(angle) + phasor.b * std::cos(angle);
  }
  return line;
}

std::vector<Evidence> find_lines(const FullRate& data) {
  const LineSpectra spectra = line_spectra(data);
  std::vector<std::vector<std::size_t>> scopes{all_members(*data.group)};
  if (data.members() > 1) {
    const auto moving = moving_members(*data.group);
    if (moving.size() > 1 && moving.size() < data.members()) {
      scopes.push_back(moving);
    }
    for (std::size_t r = 0; r < data.members(); ++r) {
      scopes.push_back({r});
    }
  }
  std::vector<Evidence> found;
  for (const auto& scope : scopes) {
    if (data.stopped()) {
      break;
    }
    double total = 0.0;
    double longest = 0.0;
    for (const std::size_t r : scope) {
      total += spectra.samples[r];
      longest = std::max(longest, spectra.samples[r]);
    }
    // Below twelve periods of the record a random walk has lines of its own.
    const auto first = static_cast<std::size_t>(12.0 / (longest * data.dt_s) / spectra.df_hz) + 1;
    Peak peak;
    for (std::size_t i = first; i + 2 < spectra.bins; ++i) {
      const double s2 = combined(spectra, scope, i, total);
      if (s2 > peak.s2) {
        peak = {0.0, s2, i};
      }
    }
    peak.surprise = surprise(peak.s2, scope, spectra, total);
    const double score =
        peak.surprise - choice_penalty(0.75 * longest) - choice_penalty(static_cast<double>(scopes.size()));
    if (score < 4.0) {
      continue;
    }
    Evidence evidence = describe(data, spectra, scope, peak, total);
    evidence.score = score;
    if (company(spectra, scope, peak, total) >= 3) {
      evidence.score = 0.0;
      evidence.note = "narrow-band noise";
    }
    found.push_back(std::move(evidence));
  }
  return found;
}

Evidence line_near(const FullRate& data, const std::vector<std::size_t>& scope, double f_hz, double within_hz) {
  const LineSpectra spectra = line_spectra(data);
  if (data.stopped()) {
    return {};
  }
  double total = 0.0;
  for (const std::size_t r : scope) {
    total += spectra.samples[r];
  }
  const auto from = static_cast<std::size_t>(std::max(1.0, std::ceil((f_hz - within_hz) / spectra.df_hz)));
  const auto to = static_cast<std::size_t>((f_hz + within_hz) / spectra.df_hz);
  Peak peak{0.0, 0.0, from};
  for (std::size_t i = from; i <= to && i + 2 < spectra.bins; ++i) {
    const double s2 = combined(spectra, scope, i, total);
    if (s2 > peak.s2) {
      peak = {0.0, s2, i};
    }
  }
  return describe(data, spectra, scope, peak, total);
}

double line_gain(const FullRate& data, const std::vector<std::size_t>& scope, double f_hz, double amplitude) {
  double gain = 0.0;
  for (const std::size_t r : scope) {
    const Phasor p = measure(data, r, f_hz, density_near(data, r, f_hz));
    const double x = amplitude * std::hypot(p.a, p.b) / p.variance;
    const double log_bessel = x < 50.0 ? std::log(std::cyl_bessel_i(0.0, x)) : x - 0.5 * std::log(2.0 * kPi * x);
    gain += log_bessel - 0.5 * amplitude * amplitude / p.variance;
  }
  return gain;
}

}  // namespace driftlab::investigate
