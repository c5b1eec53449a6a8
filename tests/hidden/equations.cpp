#include "tests/hidden/equations.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace driftlab::hidden {

using investigate::Draft;
using investigate::Figure;

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

using Figures = std::vector<Figure>;

double mean_square(std::span<const double> x) {
  double sum = 0.0;
  for (const double v : x) {
    sum += v * v;
  }
  return sum / static_cast<double>(x.size());
}

std::vector<double> minus(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> difference(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference[i] = a[i] - b[i];
  }
  return difference;
}

/// A mean square of n samples of which `independent` tell the level: five standard errors sqrt(2 / independent).
Figure variance(std::string what, double seen, double expected, double independent) {
  return {std::move(what), seen, expected, 5.0 * std::sqrt(2.0 / independent) * std::fabs(expected)};
}

/// A share of n places: five binomial standard errors.
Figure share(std::string what, double count, double n, double expected) {
  return {std::move(what), count / n, expected, 5.0 * std::sqrt(expected * (1.0 - expected) / n)};
}

double increments(const std::vector<double>& x, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = lag; i < x.size(); ++i) {
    sum += (x[i] - x[i - lag]) * (x[i] - x[i - lag]);
  }
  return sum / static_cast<double>(x.size() - lag);
}

double allan_variance(const std::vector<double>& x, std::size_t m) {
  std::vector<double> sum(x.size() + 1, 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum[i + 1] = sum[i] + x[i];
  }
  double square = 0.0;
  const std::size_t count = x.size() - 2 * m + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double d = (sum[i + 2 * m] - 2.0 * sum[i + m] + sum[i]) / static_cast<double>(m);
    square += d * d;
  }
  return 0.5 * square / static_cast<double>(count);
}

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += x[i] * y[i];
  }
  return sum / static_cast<double>(x.size()) / std::sqrt(mean_square(x) * mean_square(y));
}

/// A ramp through +-1 that the output stage is shown.
std::vector<double> ramp(std::size_t samples) {
  std::vector<double> values(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    values[i] = 2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(samples) - 1.0;
  }
  return values;
}

std::vector<double> put_out(const Draft& draft, std::vector<double> values) {
  for (const auto& step : draft.output) {
    step(values);
  }
  return values;
}

/// Chance of |x| < c for Student's t of nu degrees of freedom, scaled to unit variance: Simpson's rule over its
/// density.
double student_within(double c, double nu) {
  const double limit = c * std::sqrt(nu / (nu - 2.0));
  const double norm = std::tgamma(0.5 * (nu + 1.0)) / std::tgamma(0.5 * nu) / std::sqrt(nu * std::numbers::pi);
  constexpr int kSteps = 400;
  double sum = 0.0;
  for (int k = 0; k <= kSteps; ++k) {
    const double x = limit * k / kSteps;
    const double weight = k == 0 || k == kSteps ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
    sum += weight * norm * std::pow(1.0 + x * x / nu, -0.5 * (nu + 1.0));
  }
  return 2.0 * sum * limit / kSteps / 3.0;
}

/// Power of x about the frequency f: the mean of 41 neighbouring ordinates of its transform.
double power_about(const std::vector<double>& x, double f, double dt) {
  const double spacing = 1.0 / (static_cast<double>(x.size()) * dt);
  double sum = 0.0;
  for (int k = -20; k <= 20; ++k) {
    const double w = kTurn * (std::round(f / spacing) + k) * spacing * dt;
    double re = 0.0;
    double im = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      re += x[i] * std::cos(w * static_cast<double>(i));
      im += x[i] * std::sin(w * static_cast<double>(i));
    }
    sum += re * re + im * im;
  }
  return sum;
}

// --- noise ---

Figures white_noise(const Injected& in) {  // y = N / sqrt(dt) times independent normals
  const double n = static_cast<double>(in.samples());
  return {variance("variance", mean_square(in.after.white), in.values[0] * in.values[0] / in.dt_s(), n),
          {"correlation with what stood there", correlation(in.after.white, in.before.white), 0.0, 5.0 / std::sqrt(n)}};
}

/// Increments over a lag h have variance 2 sigma^2 (1 - exp(-beta h)); every path starts in the stationary
/// distribution.
Figures gauss_markov(const Injected& in) {
  const double sigma = in.values[0];
  const double beta = in.values[1];
  const std::vector<double> x = minus(in.after.slow, in.before.slow);
  std::vector<double> starts;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    starts.push_back(in.again(seed).slow[0] - in.before.slow[0]);
  }
  const double step = 2.0 * sigma * sigma * -std::expm1(-beta * in.dt_s());
  const double duration = static_cast<double>(in.samples()) * in.dt_s();
  return {variance("increments", increments(x, 1), step, static_cast<double>(in.samples())),
          variance("level", mean_square(x), sigma * sigma, beta * duration),
          variance("level at the start", mean_square(starts), sigma * sigma, 200.0)};
}

Figures random_walk(const Injected& in) {  // zero at the first sample; increments over h have variance K^2 h
  const std::vector<double> x = minus(in.after.slow, in.before.slow);
  const double k2 = in.values[0] * in.values[0];
  const double n = static_cast<double>(in.samples());
  return {variance("increments", increments(x, 1), k2 * in.dt_s(), n),
          variance("increments over 100 samples", increments(x, 100), k2 * 100.0 * in.dt_s(), n / 100.0),
          {"first value", x[0], 0.0, 0.0}};
}

Figures flicker_noise(const Injected& in) {  // Allan variance B^2 2 ln 2 / pi; neighbouring scales share some power
  const std::vector<double> x = minus(in.after.slow, in.before.slow);
  const double floor = in.values[0] * in.values[0] * 2.0 * std::numbers::ln2 / std::numbers::pi;
  const double n = static_cast<double>(in.samples());
  return {variance("Allan variance at 16 samples", allan_variance(x, 16), floor, n / 16.0),
          variance("Allan variance at 64 samples", allan_variance(x, 64), floor, n / 64.0)};
}

Figures quantization_noise(const Injected& in) {  // Allan variance 3 Q^2 / tau^2
  const std::vector<double> x = minus(in.after.slow, in.before.slow);
  const auto expected = [&](double tau) { return 3.0 * in.values[0] * in.values[0] / (tau * tau); };
  const double n = static_cast<double>(in.samples());
  return {variance("Allan variance at one sample", allan_variance(x, 1), expected(in.dt_s()), n / 4.0),
          variance("Allan variance at 8 samples", allan_variance(x, 8), expected(8.0 * in.dt_s()), n / 4.0)};
}

/// |H|^2 of the second-order Butterworth low-pass in bilinear form is 1 / (1 + (tan(pi f dt) / tan(pi fc dt))^4).
Figures band_limited_noise(const Injected& in) {
  Figures figures;
  for (const double f : {0.5, 4.0, 8.0, 14.0}) {
    const double ratio =
        std::tan(std::numbers::pi * f * in.dt_s()) / std::tan(std::numbers::pi * in.values[0] * in.dt_s());
    const double gain = 1.0 / (1.0 + std::pow(ratio, 4.0));
    const double seen = power_about(in.after.white, f, in.dt_s()) / power_about(in.before.white, f, in.dt_s());
    figures.push_back({"gain at " + std::to_string(f) + " Hz", seen, gain, 0.02 * gain + 0.002});
  }
  return figures;
}

Figures heavy_tailed_noise(const Injected& in) {  // Student-t of the variance that the white part had
  Figures figures;
  const double sd = std::sqrt(mean_square(in.before.white));
  for (const double c : {0.5, 1.0, 3.0}) {
    const auto inside =
        std::count_if(in.after.white.begin(), in.after.white.end(), [&](double v) { return std::fabs(v) < c * sd; });
    figures.push_back(share("share within " + std::to_string(c) + " deviations", static_cast<double>(inside),
                            static_cast<double>(in.samples()), student_within(c, in.values[0])));
  }
  return figures;
}

Figures noise_level_change(const Injected& in) {  // white and slow parts times ratio from t0 on, the mean untouched
  std::vector<double> white = in.before.white;
  std::vector<double> slow = in.before.slow;
  for (std::size_t i = 0; i < white.size(); ++i) {
    if (static_cast<double>(i) * in.dt_s() >= in.values[1]) {
      white[i] *= in.values[0];
      slow[i] *= in.values[0];
    }
  }
  return {deviation("white part", in.after.white, white, 1e-12), deviation("slow part", in.after.slow, slow, 1e-12),
          deviation("mean", in.after.mean, in.before.mean, 1e-12)};
}

Figures common_mode_noise(const Injected& in) {  // axes correlate pairwise, each keeps its variance
  const double n = static_cast<double>(in.samples());
  return {{"correlation of two axes", correlation(in.after.white, in.other.white), in.values[0], 5.0 / std::sqrt(n)},
          variance("variance", mean_square(in.after.white), mean_square(in.before.white), n)};
}

Figures outliers(const Injected& in) {
  const std::vector<double> added = in.added();
  double count = 0.0;
  double positive = 0.0;
  double least = 1e300;
  double largest = 0.0;
  for (const double v : added) {
    if (std::fabs(v) > 1e-9) {
      count += 1.0;
      positive += v > 0.0 ? 1.0 : 0.0;
      least = std::min(least, std::fabs(v));
      largest = std::max(largest, std::fabs(v));
    }
  }
  return {share("fraction", count, static_cast<double>(in.samples()), in.values[0]),
          {"smallest", least, in.values[1], 1e-9},
          {"largest", largest, in.values[1], 1e-9},
          share("positive ones", positive, count, 0.5)};
}

Figures noise_with_rate(const Injected& in) {  // N(w) = N0 (1 + k |w|)
  std::vector<double> white = in.before.white;
  for (std::size_t i = 0; i < white.size(); ++i) {
    white[i] *= 1.0 + in.values[0] * std::fabs(motion::rate(static_cast<double>(i) * in.dt_s()));
  }
  return {deviation("white part", in.after.white, white, 1e-9)};
}

Figures noise_with_acceleration(const Injected& in) {  // N(a) = N0 (1 + k |a|)
  std::vector<double> white = in.before.white;
  for (std::size_t i = 0; i < white.size(); ++i) {
    white[i] *= 1.0 + in.values[0] * std::fabs(motion::acceleration(static_cast<double>(i) * in.dt_s()));
  }
  return {deviation("white part", in.after.white, white, 1e-4)};
}

// --- the file ---

Figures output_resolution(const Injected& in) {  // multiples of the step, the nearest one
  const double step = in.values[0];
  const std::vector<double> clean = ramp(in.samples());
  const std::vector<double> out = put_out(in.after, clean);
  double off = 0.0;
  double moved = 0.0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    off = std::max(off, std::fabs(out[i] / step - std::round(out[i] / step)));
    moved = std::max(moved, std::fabs(out[i] - clean[i]));
  }
  return {{"off the lattice", off, 0.0, 1e-9}, {"largest rounding", moved, 0.5 * step, 0.01 * step}};
}

Figures saturation(const Injected& in) {
  const std::vector<double> clean = ramp(in.samples());
  std::vector<double> clipped = clean;
  for (double& v : clipped) {
    v = std::max(-in.values[0], std::min(in.values[0], v));
  }
  return {deviation("output", put_out(in.after, clean), clipped, 1e-12)};
}

/// Runs start independently and are geometric: k runs of mean m have a mean repeat count with standard error
/// sqrt(m (m - 1) / k), and k itself scatters by its root.
Figures stuck_samples(const Injected& in) {
  const std::vector<double> out = put_out(in.after, ramp(in.samples()));
  double repeats = 0.0;
  double runs = 0.0;
  for (std::size_t i = 1; i < out.size(); ++i) {
    repeats += out[i] == out[i - 1] ? 1.0 : 0.0;
    runs += out[i] == out[i - 1] && (i == 1 || out[i - 1] != out[i - 2]) ? 1.0 : 0.0;
  }
  const double m = in.values[1];
  const double relative = std::sqrt((1.0 + (m - 1.0) / m) / runs);
  return {{"fraction", repeats / static_cast<double>(out.size()), in.values[0], 5.0 * relative * in.values[0]},
          {"mean run", repeats / runs, m, 5.0 * std::sqrt(m * (m - 1.0) / runs)}};
}

Figures missing_samples(const Injected& in) {
  const auto absent = std::count(in.after.present.begin(), in.after.present.end(), 0);
  return {share("fraction", static_cast<double>(absent), static_cast<double>(in.samples()), in.values[0]),
          {"first sample", static_cast<double>(in.after.present.front()), 1.0, 0.0},
          {"last sample", static_cast<double>(in.after.present.back()), 1.0, 0.0}};
}

Figures timestamp_jitter(const Injected& in) {
  return {variance("variance of the stamps", mean_square(in.after.stamp_error_s), in.values[0] * in.values[0],
                   static_cast<double>(in.samples()))};
}

Figures turn_on_bias(const Injected& in) {  // constant within a recording, normal over recordings
  const std::vector<double> here = in.added();
  std::vector<double> biases;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Draft draft = in.again(seed);
    biases.push_back(draft.slow[0] + draft.mean[0] - in.before.slow[0] - in.before.mean[0]);
  }
  const auto [low, high] = std::minmax_element(here.begin(), here.end());
  return {variance("variance over recordings", mean_square(biases), in.values[0] * in.values[0], 400.0),
          {"change within one", *high - *low, 0.0, 1e-12}};
}

}  // namespace

Figure deviation(std::string what, const std::vector<double>& seen, const std::vector<double>& expected,
                 double tolerance) {
  return {std::move(what), std::sqrt(mean_square(minus(seen, expected)) / mean_square(expected)), 0.0, tolerance};
}

std::vector<double> Injected::added() const {
  std::vector<double> sum(samples());
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] = after.white[i] - before.white[i] + after.slow[i] - before.slow[i] + after.mean[i] - before.mean[i];
  }
  return sum;
}

const std::vector<Equation>& equations() {
  static const std::vector<Equation> all = [] {
    std::vector<Equation> list = recording_equations();
    for (const std::vector<Equation>& others : {oscillation_equations(), mean_equations()}) {
      list.insert(list.end(), others.begin(), others.end());
    }
    list.insert(list.end(), {
                                {"white_noise_level", {3e-3}, {"y*sqrt(s)"}, white_noise},
                                {"gauss_markov", {0.02, 0.5}, {"y", "1/s"}, gauss_markov},
                                {"random_walk", {0.01}, {"y/sqrt(s)"}, random_walk},
                                {"flicker_noise", {0.02}, {"y"}, flicker_noise},
                                {"quantization_noise", {1e-3}, {"y*s"}, quantization_noise},
                                {"output_resolution", {0.01}, {"y"}, output_resolution},
                                {"band_limited_noise", {8.0}, {"1/s"}, band_limited_noise},
                                {"heavy_tailed_noise", {6.0}, {"1"}, heavy_tailed_noise},
                                {"noise_level_change", {1.7, 300.01}, {"1", "s"}, noise_level_change},
                                {"common_mode_noise", {0.3}, {"1"}, common_mode_noise},
                                {"outliers", {0.02, 0.5}, {"1", "y"}, outliers},
                                {"turn_on_bias", {0.02}, {"y"}, turn_on_bias},
                                {"stuck_samples", {0.04, 4.0}, {"1", "1"}, stuck_samples},
                                {"missing_samples", {0.02}, {"1"}, missing_samples},
                                {"timestamp_jitter", {2e-4}, {"s"}, timestamp_jitter},
                                {"saturation", {0.6}, {"y"}, saturation},
                                {"rate_dependent_noise", {0.8}, {"s/rad"}, noise_with_rate},
                                {"acceleration_dependent_noise", {5.0}, {"s^2/rad"}, noise_with_acceleration},
                            });
    return list;
  }();
  return all;
}

}  // namespace driftlab::hidden
