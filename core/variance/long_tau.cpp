#include "core/variance/long_tau.hpp"

#include "core/variance/theo1.hpp"
#include "core/variance/total_variance.hpp"
#include "core/variance/variance_intervals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

namespace driftlab {
namespace {

constexpr std::size_t kFewest = 32;
constexpr std::size_t kShortestWindow = 16;
constexpr std::size_t kFinestPart = 64;

/// What is known of white noise, flicker noise and random walk, in this order.
using ByNoise = std::array<double, 3>;

double at_slope(const ByNoise& known, double slope) {
  const double position = std::clamp(slope, -1.0, 1.0);
  return position < 0.0 ? known[1] - position * (known[0] - known[1]) : known[1] + position * (known[2] - known[1]);
}

/// A generalised covariance g of the running sum of a process at level 1, up to a factor: the mean square of any
/// combination of phases that cancels a constant and a trend is the sum of products of its weights with g.
double phase_covariance(const Process& process, double t, double dt_s) {
  const std::string_view symbol = process.kind->symbol;
  if (symbol == "QN") {
    return t > 0.0 ? -1.0 : 0.0;
  }
  if (symbol == "FN") {
    return t > 0.0 ? t * t * std::log(t) : 0.0;
  }
  if (symbol == "RW") {
    return t * t * t;
  }
  if (symbol == "GM") {  // minus half of the variance of the sum of t samples, relative to sigma^2
    const double phi = std::exp(-process.parameters[1] * dt_s);
    const double gap = -std::expm1(-process.parameters[1] * dt_s);
    return -0.5 * (t * (1.0 + phi) / gap + 2.0 * phi * std::expm1(-t * process.parameters[1] * dt_s) / (gap * gap));
  }
  return -t;  // white
}

/// Mean square of x(h + s) - x(s) - x(h) + x(0).
double increments_apart(const Process& process, double h, double s, double dt_s) {
  if (process.kind->symbol == "DR") {
    return h * h * s * s;
  }
  const auto g = [&](double t) { return phase_covariance(process, t, dt_s); };
  return 4.0 * g(0.0) - 4.0 * g(h) - 4.0 * g(s) + 2.0 * g(h + s) + 2.0 * g(std::fabs(s - h));
}

/// E Theo1 over the Allan variance at its tau, for one process; windows of m blocks of `block` samples.
double theo1_share(const Process& process, double m, double block, double dt_s) {
  double sum = 0.0;
  for (double h = 1.0; h <= 0.5 * m; h += 1.0) {
    sum += increments_apart(process, h * block, (m - h) * block, dt_s) / h;
  }
  const double tau = 0.75 * m * block;
  const double allan = increments_apart(process, tau, tau, dt_s) / (2.0 * tau * tau);
  return sum / (0.75 * m * m * block * block * allan);
}

/// What the mean of an estimator is of the Allan variance of a mixture at tau, from what it is for each process.
template <class ShareOf>
double mean_share(const Model& mixture, double tau_s, double dt_s, ShareOf share_of) {
  double allan = 0.0;
  double mean = 0.0;
  for (const Process& process : mixture) {
    const double variance = process.haar_variance(tau_s / dt_s, dt_s);
    allan += variance;
    mean += variance * share_of(process);
  }
  return allan > 0.0 ? mean / allan : 1.0;
}

/// Equivalent degrees of freedom of Theo1: NIST SP 1065 table 8. Its line for a random walk falls below nothing at the
/// end of the record, where simulation gives 0.85 T/tau.
ByNoise theo1_degrees(double n, double r) {
  const double root = std::pow(r, 1.5);
  const double cube = r * r * r;
  const double a = 4.4 * n - 1.0;
  const double b = 4.4 * n - 3.0;
  return {((4.1 * n + 0.8) / r - (3.1 * n + 6.5) / n) * root / (root + 5.2),
          (2.0 * n * n - 1.3 * n * r - 3.5 * r) / (n * r) * cube / (cube + 2.3),
          std::max((4.4 * n - 2.0) / (2.9 * r) * (a * a - 8.6 * r * a + 11.4 * r * r) / (b * b), 0.85 * n / r)};
}

/// Of the total variance at T/tau = `ratio`: NIST SP 1065 table 7.
ByNoise total_degrees(double ratio) { return {1.5 * ratio, 1.168 * ratio - 0.222, 0.927 * ratio - 0.358}; }

/// Relative variance of the bias of Theo1, whose noise type is read off the record: this over the degrees of freedom
/// that the record gives to one tau.
constexpr double kTypeUnknown = 1.04;

void append(LongTauCurve& curve, double tau_s, double variance, double edf) {
  const double degrees = std::max(edf, 1.0);
  curve.tau_s.push_back(tau_s);
  curve.variance.push_back(variance);
  curve.ci95.push_back(chi_square_interval(variance, degrees));
  curve.edf.push_back(degrees);
}

/// N/2, N/3, N/4, N/6, ... N/64 in rising order, from the shortest window on.
std::vector<std::size_t> parts_of(std::size_t samples) {
  std::vector<std::size_t> parts;
  for (std::size_t divisor = 2; divisor <= kFinestPart; divisor *= 2) {
    for (const std::size_t part : {2 * samples / (2 * divisor), 2 * samples / (3 * divisor)}) {
      if (part >= kShortestWindow) {
        parts.push_back(part);
      }
    }
  }
  std::reverse(parts.begin(), parts.end());
  return parts;
}

}  // namespace

double allan_slope(const Model& mixture, double tau_s, double dt_s) {
  constexpr double kStep = 1.25;
  const double m = tau_s / dt_s;
  const double low = haar_variance(mixture, std::max(1.0, m / kStep), dt_s);
  const double high = haar_variance(mixture, std::max(1.0, m * kStep), dt_s);
  return low > 0.0 && high > 0.0 ? std::log(high / low) / (2.0 * std::log(kStep)) : -1.0;
}

LongTauCurve total_curve(std::span<const double> samples, double pivot, double unit_square, const Model& mixture,
                         double dt_s) {
  LongTauCurve curve;
  if (samples.size() < kFewest) {
    return curve;
  }
  const std::vector<std::size_t> m = parts_of(samples.size());
  const std::vector<double> raw = total_variance(samples, pivot, m);
  for (std::size_t k = 0; k < m.size(); ++k) {
    const double tau = static_cast<double>(m[k]) * dt_s;
    const double share = static_cast<double>(m[k]) / static_cast<double>(samples.size());
    const double slope = allan_slope(mixture, tau, dt_s);
    const double mean = mean_share(mixture, tau, dt_s, [&](const Process& process) {
      return 1.0 - share * at_slope({0.0, 1.0 / (3.0 * std::numbers::ln2), 0.75}, allan_slope({process}, tau, dt_s));
    });
    const double edf = at_slope(total_degrees(1.0 / share), slope);
    append(curve, tau, raw[k] / unit_square / mean, edf);
  }
  return curve;
}

LongTauCurve theo1_curve(std::span<const double> samples, double pivot, double unit_square, const Model& mixture,
                         double dt_s) {
  LongTauCurve curve;
  if (samples.size() < kFewest) {
    return curve;
  }
  std::vector<std::size_t> windows = parts_of(samples.size());
  for (const std::size_t longer : {samples.size() * 3 / 4, samples.size()}) {
    windows.push_back(longer);
  }
  for (const std::size_t window : windows) {
    const Theo1Value found = theo1_at(samples, pivot, window, dt_s);
    const double slope = allan_slope(mixture, found.tau_s, dt_s);
    const double m = found.ratio / 0.75;
    const double block = found.tau_s / (found.ratio * dt_s);
    const double mean = mean_share(mixture, found.tau_s, dt_s,
                                   [&](const Process& process) { return theo1_share(process, m, block, dt_s); });
    const auto length = static_cast<double>(found.length);
    const double own = std::max(at_slope(theo1_degrees(length, found.ratio), slope), 1.0);
    const double record = std::max(at_slope(total_degrees(length / found.ratio), slope), 1.0);
    const double edf = 2.0 / (2.0 / own + kTypeUnknown / record);
    append(curve, found.tau_s, found.variance / unit_square / mean, edf);
  }
  return curve;
}

}  // namespace driftlab
