#include "core/variance/robust_variance.hpp"

#include "core/variance/kernels.hpp"
#include "core/variance/prefix_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <span>
#include <utility>

namespace driftlab {
namespace {

constexpr double kTarget = 0.6;
constexpr double kHigherOrder = 2.0;  ///< measured: white noise 0.55 at edf 46-93, random walk 0.585 at 28-58
constexpr double kRoughShare = 0.02;  ///< of quantization noise, from which on every coefficient counts

constexpr std::size_t kBlock = 4096;

/// Squares of the coefficients of one scale, block by block; where not all of them are used they are formed once.
class Squares {
 public:
  explicit Squares(const ScaleCoefficients& coefficients)
      : from_(coefficients),
        count_((coefficients.prefix.size() - 2 * coefficients.half + coefficients.stride - 1) / coefficients.stride),
        scale_(1.0 / (4.0 * static_cast<double>(coefficients.half) * static_cast<double>(coefficients.half))) {
    if (from_.stride > 1) {
      thinned_.resize(count_);
      for (std::size_t i = 0; i < count_; ++i) {
        thinned_[i] = of(i);
      }
    } else {
      block_.resize(std::min(kBlock, count_));
    }
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  /// One of them.
  [[nodiscard]] double of(std::size_t i) const {
    const double* const first = from_.prefix.data() + i * from_.stride;
    const std::size_t m = from_.half;
    const double d = (first[2 * m] - first[m]) - (first[m] - first[0]);
    return d * d * scale_;
  }
  /// Those from `start` on, at most kBlock of them. Valid until the next call.
  std::span<const double> block(std::size_t start) {
    const std::size_t size = std::min(kBlock, count_ - start);
    if (from_.stride > 1) {
      return std::span(thinned_).subspan(start, size);
    }
    const double* const first = from_.prefix.data() + start;
    const std::size_t m = from_.half;
    kernels().square_second_differences(first + 2 * m, first + m, first, size, scale_, block_.data());
    return std::span(block_).first(size);
  }
  [[nodiscard]] double sum() {
    if (from_.stride == 1) {
      const double* const first = from_.prefix.data();
      const std::size_t m = from_.half;
      return kernels().second_difference_power(first + 2 * m, first + m, first, count_) * scale_;
    }
    return std::accumulate(thinned_.begin(), thinned_.end(), 0.0);
  }

 private:
  ScaleCoefficients from_;
  std::size_t count_;
  double scale_;
  std::vector<double> thinned_;
  std::vector<double> block_;
};

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

/// The same over all squares. Between two values of nu the squares that are inside the bound of the lower count for all
/// nu there, by their power sums, and those beyond the bound of the upper for none: the few between are kept. One look
/// at the data thus serves all nu of an interval.
class IntervalEquation {
 public:
  IntervalEquation(Squares& squares, const Biweight& biweight, double wanted, double low, double high)
      : expected(wanted), squares_(squares), c_square_(biweight.c * biweight.c) {
    collect(low, high);
  }

  double operator()(double nu) {
    if (nu < low_ || nu > high_) {
      collect(std::min(nu, nu < low_ ? low_ : high_), std::max(nu, nu < low_ ? low_ : high_));
    }
    const double r = low_ / nu;
    double sum = power_[0] - r * (4.0 * power_[1] - r * (6.0 * power_[2] - r * (4.0 * power_[3] - r * power_[4])));
    for (const double t : between_) {
      const double inside = std::max(0.0, 1.0 - r * t);
      sum += t * (inside * inside) * (inside * inside);
    }
    return sum * c_square_ * r / static_cast<double>(squares_.count()) - expected;
  }

  double expected;  // NOLINT(misc-non-private-member-variables-in-classes): as that of Equation

 private:
  void collect(double low, double high) {
    low_ = low;
    high_ = high;
    power_.fill(0.0);
    between_.clear();
    const double bound = 1.0 / (c_square_ * low);
    for (std::size_t start = 0; start < squares_.count(); start += kBlock) {
      const std::span<const double> block = squares_.block(start);
      const std::size_t known = between_.size();
      between_.resize(known + block.size() + 1);
      between_.resize(known + kernels().biweight_powers(block.data(), block.size(), bound, high / low, power_.data(),
                                                        between_.data() + known));
    }
  }

  Squares& squares_;
  double c_square_;
  double low_ = 0.0;
  double high_ = 0.0;
  std::array<double, 5> power_{};
  std::vector<double> between_;
};

/// Root in [low, high], where the equation is >= 0 at `low` and < 0 at `high`; `expand`: the ends are guesses, to be
/// moved until they are. Illinois.
template <class OfNu>
std::optional<double> bracketed_root(OfNu&& equation, double low, double high, bool expand, const RunControl& control) {
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
/// squares, then on all of them from a bracket of that root's standard error, which takes one look at the data if the
/// root lies in it.
std::optional<double> upper_root(Squares& squares, double classical, const Biweight& biweight, double expected,
                                 const RunControl& control) {
  constexpr std::size_t kScan = 20000;
  constexpr double kStep = 1.25;
  std::vector<double> few;
  const std::size_t stride = std::max<std::size_t>(1, squares.count() / kScan);
  few.reserve(squares.count() / stride + 1);
  for (std::size_t i = 0; i < squares.count(); i += stride) {
    few.push_back(squares.of(i));
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
  const double low = *near / error;
  const double high = *near * error;
  return bracketed_root(IntervalEquation(squares, biweight, expected, low, high), low, high, true, control);
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
  Squares squares(coefficients);
  const double bound = 1.0 / (biweight.c * biweight.c * nu);
  double sum = 0.0;
  for (std::size_t start = 0; start < squares.count(); start += kBlock) {
    const std::span<const double> block = squares.block(start);
    sum += kernels().biweight_sum(block.data(), block.size(), bound);
  }
  return sum / nu / static_cast<double>(squares.count());
}

RobustRoot robust_root(const ScaleCoefficients& coefficients, const Biweight& biweight, double expected,
                       const RunControl& control) {
  Squares squares(coefficients);
  RobustRoot root;
  root.mean_square = squares.sum() / static_cast<double>(squares.count());
  if (root.mean_square > 0.0 && !control.stop.stop_requested()) {
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
