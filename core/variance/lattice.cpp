#include "core/variance/lattice.hpp"

#include "core/process/distributions.hpp"
#include "core/process/random.hpp"
#include "core/variance/prefix_sums.hpp"
#include "core/variance/robust_variance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace driftlab {
namespace {

constexpr std::size_t kLooks = 20000;
constexpr double kConforming = 0.8;
constexpr double kTolerance = 0.01;  ///< of a step
constexpr double kMostSteps = 6.0;   ///< median difference of a lattice that shows
constexpr int kReach = 12;           ///< steps around the median that are counted
constexpr double kFewest = 5.0;      ///< samples on either side of a usable edge
constexpr std::size_t kShortStretch = 256;
/// Efficiency that the biweight is tuned to here: with the usual bound the outer lattice values sit where chi is flat,
/// and nothing depends on the scale.
constexpr double kLatticeTarget = 0.9;
constexpr std::size_t kRuns = 32;
constexpr std::size_t kRunSamples = 16384;
constexpr std::size_t kLongestHalf = 16;  ///< rounding has averaged out from here on

bool conforms(double steps) { return std::fabs(steps - std::round(steps)) < kTolerance; }

/// One stretch: points of the probit line.
struct ProbitLine {
  double weight = 0.0;
  double edge = 0.0;  ///< weighted mean
  double probit = 0.0;
  double edge_square = 0.0;
  double product = 0.0;
};

/// Points z = probit of the share of values up to k at edge k + 1/2, weighted by their information.
ProbitLine probit_line(std::span<const int> values) {
  std::vector<int> sorted(values.begin(), values.end());
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  const int middle = sorted[sorted.size() / 2];
  std::array<double, 2 * kReach + 1> count{};
  double total = 0.0;
  for (const int value : values) {
    if (std::abs(value - middle) <= kReach) {
      const int at = value - middle + kReach;
      count[static_cast<std::size_t>(at)] += 1.0;
      total += 1.0;
    }
  }
  struct Point {
    double edge;
    double probit;
    double weight;
  };
  std::vector<Point> points;
  double below = 0.0;
  for (int k = -kReach; k < kReach; ++k) {
    const int at = k + kReach;
    below += count[static_cast<std::size_t>(at)];
    if (below < kFewest || total - below < kFewest) {
      continue;
    }
    const double share = below / total;
    const double probit = normal_quantile(share);
    const double density = normal_density(probit);
    points.push_back({middle + k + 0.5, probit, total * density * density / (share * (1.0 - share))});
  }
  ProbitLine line;
  for (const Point& point : points) {
    line.weight += point.weight;
    line.edge += point.weight * point.edge;
    line.probit += point.weight * point.probit;
  }
  if (!(line.weight > 0.0)) {
    return line;
  }
  line.edge /= line.weight;
  line.probit /= line.weight;
  for (const Point& point : points) {
    line.edge_square += point.weight * (point.edge - line.edge) * (point.edge - line.edge);
    line.product += point.weight * (point.edge - line.edge) * (point.probit - line.probit);
  }
  return line;
}

bool is_rough(const Process& process) { return process.kind->symbol == "WN" || process.kind->symbol == "QN"; }

/// Processes that move the level, levels divided by `unit`; deterministic ones left out.
Model slow_part(const Model& mixture, double unit) {
  Model slow;
  for (const Process& process : mixture) {
    if (!is_rough(process) && process.kind->symbol != "DR") {
      slow.push_back(process);
      slow.back().parameters[0] /= unit;
    }
  }
  return slow;
}

/// The longest stretch (a power of two of samples) over which the slow part moves by less than a tenth of a step.
std::size_t quiet_stretch(const Model& slow, double dt_s, std::size_t samples) {
  std::size_t stretch = kShortStretch;
  while (2 * stretch <= samples && 2.0 * haar_variance(slow, static_cast<double>(stretch), dt_s) < 0.01) {
    stretch *= 2;
  }
  return stretch;
}

/// Rounded records of white noise of `noise.sd` steps over the slow part, as prefix sums.
std::vector<std::unique_ptr<double[]>> rounded_records(const LatticeNoise& noise, const Model& slow, double dt_s,
                                                       std::size_t samples, std::uint64_t seed) {
  std::vector<std::unique_ptr<double[]>> records;
  for (std::size_t run = 0; run < kRuns; ++run) {
    Random random(seed, run);
    std::vector<double> x = simulate(slow, random, dt_s, samples);
    x.resize(samples, 0.0);
    const double offset = noise.fixed ? noise.offset : random.uniform() - 0.5;
    for (double& value : x) {
      value = std::round(value + offset + noise.sd * random.normal());
    }
    records.push_back(prefix_sums(x, 0.0));
  }
  return records;
}

/// Adds one scale to the shape: the mean of chi over the records at their own mean squares, then what solving for that
/// mean leaves. `gaussian`: variance of ln(robust/classical) of a Gaussian record. False if too many have no root.
bool add_scale(std::span<const std::unique_ptr<double[]>> records, std::size_t samples, std::size_t half,
               const Biweight& biweight, double gaussian, RobustShape& shape) {
  double expected = 0.0;
  for (const auto& record : records) {
    const ScaleCoefficients coefficients{{record.get(), samples + 1}, half, smooth_stride(half)};
    const double mean_square = robust_root(coefficients, biweight, biweight.mean).mean_square;
    if (!(mean_square > 0.0)) {
      return false;
    }
    expected += mean_biweight(coefficients, biweight, mean_square) / static_cast<double>(records.size());
  }
  double count = 0.0;
  double mean = 0.0;
  double square = 0.0;
  for (const auto& record : records) {
    const RobustRoot root = robust_root({{record.get(), samples + 1}, half, smooth_stride(half)}, biweight, expected);
    if (root.variance) {
      const double d = std::log(*root.variance / root.mean_square);
      count += 1.0;
      mean += d;
      square += d * d;
    }
  }
  if (count < 0.9 * static_cast<double>(records.size())) {
    return false;
  }
  mean /= count;
  shape.biweight.push_back(biweight);
  shape.expected.push_back(expected);
  shape.log_ratio.push_back(mean);
  shape.inflation.push_back(std::max(1.0, (square / count - mean * mean) / gaussian));
  return true;
}

}  // namespace

std::optional<double> lattice_step(std::span<const double> samples) {
  const std::size_t stride = std::max<std::size_t>(1, samples.size() / kLooks);
  std::vector<double> differences;
  for (std::size_t t = 1; t < samples.size(); t += stride) {
    if (const double d = std::fabs(samples[t] - samples[t - 1]); d > 0.0) {
      differences.push_back(d);
    }
  }
  if (differences.size() < 16) {
    return std::nullopt;
  }
  std::sort(differences.begin(), differences.end());
  const double median = differences[differences.size() / 2];
  const auto first = std::lower_bound(differences.begin(), differences.end(), 1e-6 * median);
  const double candidate = *(first + (differences.end() - first) / 50);
  double sum = 0.0;
  double steps = 0.0;
  std::size_t conforming = 0;
  for (auto d = first; d != differences.end(); ++d) {
    const double multiple = *d / candidate;
    if (multiple < 1000.0 && conforms(multiple)) {
      ++conforming;
      sum += *d;
      steps += std::round(multiple);
    }
  }
  const auto count = static_cast<double>(differences.end() - first);
  if (static_cast<double>(conforming) < kConforming * count || median > kMostSteps * candidate) {
    return std::nullopt;
  }
  return sum / steps;
}

std::optional<LatticeNoise> lattice_noise(std::span<const double> samples, double step, std::size_t stretch,
                                          const RunControl& control) {
  if (samples.empty() || !(step > 0.0)) {
    return std::nullopt;
  }
  std::vector<double> sorted(
      samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(samples.size(), 1001)));
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  const double origin = sorted[sorted.size() / 2];
  std::vector<int> values;
  std::vector<ProbitLine> lines;
  for (std::size_t first = 0; first + stretch <= samples.size(); first += stretch) {
    if (control.stop.stop_requested()) {
      return std::nullopt;
    }
    values.clear();
    for (const double sample : samples.subspan(first, stretch)) {
      const double steps = (sample - origin) / step;
      if (std::fabs(steps) < 1e6 && std::fabs(steps - std::round(steps)) < 0.05) {
        values.push_back(static_cast<int>(std::lround(steps)));
      }
    }
    if (!values.empty()) {
      lines.push_back(probit_line(values));
    }
  }
  double square = 0.0;
  double product = 0.0;
  for (const ProbitLine& line : lines) {
    square += line.edge_square;
    product += line.product;
  }
  if (!(square > 0.0) || !(product > 0.0)) {
    return std::nullopt;
  }
  LatticeNoise noise;
  noise.sd = square / product;
  double sum = 0.0;
  double sum_square = 0.0;
  double count = 0.0;
  for (const ProbitLine& line : lines) {
    if (line.weight > 0.0) {
      const double level = line.edge - noise.sd * line.probit;
      count += 1.0;
      const double moved = level - sum;
      sum += moved / count;
      sum_square += moved * (level - sum);
    }
  }
  noise.offset = sum - std::round(sum);
  noise.fixed = sum_square / count < 0.01;
  return noise;
}

RobustShape lattice_shape(std::span<const double> samples, double unit_square, const VarianceIntervals& intervals,
                          HaarCovariance& plan, std::uint64_t seed, const RunControl& control) {
  RobustShape shape;
  const std::optional<double> step = lattice_step(samples);
  if (!step) {
    return shape;
  }
  const double unit = *step / std::sqrt(unit_square);  // a step in the units of the curve
  const double first = 2.0 * intervals.modelled(0) / (unit * unit);
  const Model slow = slow_part(intervals.mixture, unit);
  const double slow_share = slow.empty() ? 0.0 : 2.0 * haar_variance(slow, 1.0, plan.dt_s()) / first;
  // Rounding adds a twelfth of a square step (Sheppard); counts say it better where the rough part dominates.
  LatticeNoise noise{std::sqrt(std::max(0.0, first * (1.0 - slow_share) - 1.0 / 12.0)), 0.0, false};
  double deviation = std::sqrt(std::max(0.0, first - 1.0 / 12.0));
  if (slow_share < 0.1) {
    const std::size_t stretch = quiet_stretch(slow, plan.dt_s(), samples.size());
    if (const auto counted = lattice_noise(samples, *step, std::min(stretch, samples.size()), control)) {
      noise = *counted;
      deviation = counted->sd;
    } else {
      deviation = 0.0;  // too few values for a count: coarser than anything that can be cured
    }
  }
  if (deviation >= kCoarseLattice) {
    return shape;
  }
  if (deviation < kTooCoarseLattice) {
    shape.refused = true;
    return shape;
  }
  const std::size_t length = std::min(samples.size(), kRunSamples);
  const auto records = rounded_records(noise, slow, plan.dt_s(), length, seed);
  std::vector<std::size_t> half;
  for (std::size_t m = 1; m <= kLongestHalf && 2 * m <= length; m *= 2) {
    half.push_back(m);
  }
  HaarCovariance brief(half, length, plan.dt_s());
  // The mean of the simulations has an error of its own.
  const double own = 1.0 + static_cast<double>(samples.size()) / static_cast<double>(kRuns * length);
  for (std::size_t j = 0; j < half.size(); ++j) {
    if (control.stop.stop_requested()) {
      return {};
    }
    const Biweight biweight = tune_biweight(plan.correlation_sums(j, j, intervals.mixture), kLatticeTarget);
    const auto sums = brief.correlation_sums(j, j, intervals.mixture);
    const double gaussian = 2.0 * (1.0 / biweight.efficiency(sums) - 1.0) * sums[0];
    if (!add_scale(records, length, half[j], biweight, gaussian, shape)) {
      RobustShape none;
      none.refused = true;
      return none;
    }
    shape.inflation[j] *= own;
  }
  return shape;
}

}  // namespace driftlab
