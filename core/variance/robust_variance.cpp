#include "core/variance/robust_variance.hpp"

#include "core/variance/kernels.hpp"
#include "core/variance/prefix_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

namespace driftlab {
namespace {

constexpr double kTarget = 0.6;
constexpr double kHigherOrder = 2.0;  ///< measured: white noise 0.55 at edf 46-93, random walk 0.585 at 28-58
constexpr double kRoughShare = 0.02;  ///< of quantization noise, from which on every coefficient counts

/// Squares of the coefficients.
void thinned_squares(const ScaleCoefficients& coefficients, std::vector<double>& squares) {
  const std::span<const double> prefix = coefficients.prefix;
  const std::size_t m = coefficients.half;
  const std::size_t stride = coefficients.stride;
  const double scale = 1.0 / (4.0 * static_cast<double>(m) * static_cast<double>(m));
  squares.resize((prefix.size() - 2 * m + stride - 1) / stride);
  if (stride == 1) {
    kernels().square_second_differences(prefix.data() + 2 * m, prefix.data() + m, prefix.data(), squares.size(), scale,
                                        squares.data());
    return;
  }
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const double* const first = prefix.data() + i * stride;
    const double w = (first[2 * m] - first[m]) - (first[m] - first[0]);
    squares[i] = w * w * scale;
  }
}

/// mean chi - E chi as a function of nu over some of the squares.
struct Equation {
  std::span<const double> squares;
  const Biweight& biweight;
  double expected;
  double operator()(double nu) const {
    const double bound = 1.0 / (biweight.c * biweight.c * nu);
    return kernels().biweight_sum(squares.data(), squares.size(), bound) / nu / static_cast<double>(squares.size()) -
           expected;
  }
};

/// Root in [low, high], where the equation is >= 0 at `low` and < 0 at `high`; `expand`: the ends are guesses, to be
/// moved until they are. Illinois.
std::optional<double> bracketed_root(const Equation& equation, double low, double high, bool expand,
                                     const RunControl& control) {
  double at_low = equation(low);
  double at_high = equation(high);
  const double widen = high / low;
  for (int i = 0; expand && i < 12 && at_low < 0.0; ++i) {
    high = low;
    at_high = at_low;
    low /= widen;
    at_low = equation(low);
  }
  for (int i = 0; expand && i < 12 && at_high >= 0.0; ++i) {
    low = high;
    at_low = at_high;
    high *= widen;
    at_high = equation(high);
  }
  if (at_low < 0.0 || at_high >= 0.0) {
    return std::nullopt;
  }
  for (int i = 0; i < 60 && high - low > 1e-10 * high; ++i) {
    double middle = (low * at_high - high * at_low) / (at_high - at_low);
    if (!(middle > low && middle < high)) {
      middle = 0.5 * (low + high);
    }
    if (control.stop.stop_requested()) {
      return std::nullopt;
    }
    const double value = equation(middle);
    if (std::fabs(value) < 1e-10 * equation.expected) {
      return middle;
    }
    if (value >= 0.0) {
      low = middle;
      at_low = value;
      at_high *= 0.5;
    } else {
      high = middle;
      at_high = value;
      at_low *= 0.5;
    }
  }
  return 0.5 * (low + high);
}

/// The largest root of mean chi = E chi, or nothing. Scanned downwards and solved on at most some 20,000 of the
/// squares, then on all of them from a bracket of that root's standard error, which takes four or five looks at the
/// data.
std::optional<double> upper_root(const std::vector<double>& squares, double classical, const Biweight& biweight,
                                 double expected, const RunControl& control) {
  constexpr std::size_t kScan = 20000;
  constexpr double kStep = 1.25;
  std::vector<double> few;
  const std::size_t stride = std::max<std::size_t>(1, squares.size() / kScan);
  for (std::size_t i = 0; i < squares.size(); i += stride) {
    few.push_back(squares[i]);
  }
  const Equation over_few{few, biweight, expected};
  double here = 16.0 * classical;
  bool crossed = false;
  for (int i = 0; i < 200 && !crossed; ++i) {
    here /= kStep;
    crossed = over_few(here) >= 0.0;
  }
  if (!crossed) {
    return std::nullopt;
  }
  const std::optional<double> near = bracketed_root(over_few, here, here * kStep, false, control);
  if (!near || stride == 1) {
    return near;
  }
  const double error = 1.0 + 3.0 / std::sqrt(static_cast<double>(few.size()));
  return bracketed_root({squares, biweight, expected}, *near / error, *near * error, true, control);
}

/// How one scale is estimated.
struct Choice {
  Biweight biweight;
  double expected = 0.0;
  double ratio = 1.0;
  double efficiency = 0.0;
};

Choice choose(const RobustShape& shape, std::size_t j, const std::array<double, HaarCovariance::kEvenPowers>& sums,
              double edf) {
  if (shape.simulated(j)) {
    const Biweight& biweight = shape.biweight[j];
    const double scatter = (1.0 / biweight.efficiency(sums) - 1.0) * shape.inflation[j];
    return {biweight, shape.expected[j], std::exp(shape.log_ratio[j]), 1.0 / (1.0 + scatter)};
  }
  // The expansion is of first order in 1/edf: what the next order costs is aimed over.
  const double higher_order = std::min(kHigherOrder / edf, 0.1);
  Choice choice;
  choice.biweight = tune_biweight(sums, kTarget + higher_order);
  choice.expected = mean_with_uniform_share(choice.biweight, shape.uniform_at(j));
  const double scatter = (1.0 / choice.biweight.efficiency(sums) - 1.0) * shape.inflation_at(j);
  choice.efficiency = 1.0 / (1.0 + scatter) - higher_order;
  return choice;
}

}  // namespace

std::size_t smooth_stride(std::size_t half) { return std::max<std::size_t>(1, half / 8); }

double mean_biweight(const ScaleCoefficients& coefficients, const Biweight& biweight, double nu) {
  std::vector<double> squares;
  thinned_squares(coefficients, squares);
  return Equation{squares, biweight, 0.0}(nu);
}

RobustRoot robust_root(const ScaleCoefficients& coefficients, const Biweight& biweight, double expected,
                       const RunControl& control) {
  std::vector<double> squares;
  thinned_squares(coefficients, squares);
  RobustRoot root;
  bool any = false;
  for (const double square : squares) {
    root.mean_square += square;
    any = any || square > 0.0;
  }
  root.mean_square /= static_cast<double>(squares.size());
  if (any && !control.stop.stop_requested()) {
    root.variance = upper_root(squares, root.mean_square, biweight, expected, control);
  }
  return root;
}

RobustVariance robust_variance(std::span<const double> samples, double pivot, const HaarVariance& curve,
                               const VarianceIntervals& classical, HaarCovariance& plan, RobustShape shape,
                               const RunControl& control) {
  const std::unique_ptr<double[]> prefix = prefix_sums(samples, pivot, control);
  RobustVariance result;
  if (!prefix) {
    return result;
  }
  result.shape = std::move(shape);
  for (std::size_t j = 0; j < curve.scales(); ++j) {
    if (control.stop.stop_requested()) {
      return {};
    }
    const auto sums = plan.correlation_sums(j, j, classical.mixture);
    const Choice choice = choose(result.shape, j, sums, classical.edf[j]);
    const Biweight& biweight = choice.biweight;
    const double rough = quantization_share(classical, plan, j);
    const std::size_t stride = rough < kRoughShare ? smooth_stride(curve.half[j]) : 1;
    std::optional<double> root;
    if (!result.shape.refused) {
      root =
          robust_root({{prefix.get(), samples.size() + 1}, curve.half[j], stride}, biweight, choice.expected, control)
              .variance;
    }
    if (root) {
      *root /= choice.ratio;
    }
    const double efficiency = choice.efficiency;
    result.biweight.push_back(biweight);
    result.stride.push_back(stride);
    result.efficiency.push_back(efficiency);
    result.edf.push_back(classical.edf[j] * efficiency);
    result.variance.push_back(root);
    result.ci95.push_back(root ? chi_square_interval(*root, result.edf.back()) : Interval{0.0, 0.0});
  }
  return result;
}

}  // namespace driftlab
