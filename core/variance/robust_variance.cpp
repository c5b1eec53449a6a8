#include "core/variance/robust_variance.hpp"

#include "core/variance/wide.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace driftlab {
namespace {

constexpr std::size_t kLanes = 8;

/// Mean of chi(sqrt(u/nu)) over squares u.
DRIFTLAB_WIDE double mean_chi(const double* squares, std::size_t count, double nu, double c) {
  const double inverse = 1.0 / nu;
  const double bound = 1.0 / (c * c * nu);
  std::array<double, kLanes> sum{};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const double u = squares[i + k];
      const double inside = 1.0 - u * bound;
      const double kept = inside > 0.0 ? inside : 0.0;
      const double square = kept * kept;
      sum[k] += u * square * square;
    }
  }
  double total = 0.0;
  for (const double part : sum) {
    total += part;
  }
  for (; i < count; ++i) {
    const double kept = std::max(0.0, 1.0 - squares[i] * bound);
    total += squares[i] * kept * kept * kept * kept;
  }
  return total * inverse / static_cast<double>(count);
}

/// Squares of every m/8-th coefficient at half length m, from prefix sums.
void thinned_squares(const std::vector<double>& prefix, std::size_t m, std::vector<double>& squares) {
  const std::size_t stride = std::max<std::size_t>(1, m / 8);
  const double scale = 1.0 / (2.0 * static_cast<double>(m));
  squares.clear();
  for (std::size_t end = 2 * m; end < prefix.size(); end += stride) {
    const double w = ((prefix[end] - prefix[end - m]) - (prefix[end - m] - prefix[end - 2 * m])) * scale;
    squares.push_back(w * w);
  }
}

/// The largest root of mean chi = target, or nothing. Scanned downwards on at most some 20,000 of the squares, then
/// refined on all of them.
std::optional<double> upper_root(const std::vector<double>& squares, double classical, const Biweight& biweight) {
  constexpr std::size_t kScan = 20000;
  constexpr double kStep = 1.25;
  std::vector<double> few;
  const std::size_t stride = std::max<std::size_t>(1, squares.size() / kScan);
  for (std::size_t i = 0; i < squares.size(); i += stride) {
    few.push_back(squares[i]);
  }
  const auto excess = [&](const std::vector<double>& over, double nu) {
    return mean_chi(over.data(), over.size(), nu, biweight.c) - biweight.mean;
  };
  double above = 16.0 * classical;
  double here = above;
  bool crossed = false;
  for (int i = 0; i < 200 && !crossed; ++i) {
    above = here;
    here /= kStep;
    crossed = excess(few, here) >= 0.0;
  }
  if (!crossed) {
    return std::nullopt;
  }
  double low = here;
  double high = above;
  double at_low = excess(squares, low);
  double at_high = excess(squares, high);
  for (int i = 0; i < 8 && at_low < 0.0; ++i) {  // the few and the many disagree by a step or two
    high = low;
    at_high = at_low;
    low /= kStep;
    at_low = excess(squares, low);
  }
  for (int i = 0; i < 8 && at_high >= 0.0; ++i) {
    low = high;
    at_low = at_high;
    high *= kStep;
    at_high = excess(squares, high);
  }
  if (at_low < 0.0 || at_high >= 0.0) {
    return std::nullopt;
  }
  for (int i = 0; i < 60 && high - low > 1e-9 * high; ++i) {  // Illinois
    double middle = (low * at_high - high * at_low) / (at_high - at_low);
    if (!(middle > low && middle < high)) {
      middle = 0.5 * (low + high);
    }
    const double value = excess(squares, middle);
    if (value >= 0.0) {
      low = middle;
      at_low = value;
      at_high *= 0.5;
    } else {
      high = middle;
      at_high = value;
      at_low *= 0.5;
    }
    if (std::fabs(value) < 1e-10) {
      return middle;
    }
  }
  return 0.5 * (low + high);
}

}  // namespace

RobustVariance robust_variance(std::span<const double> samples, double pivot, const HaarVariance& curve,
                               const VarianceIntervals& classical, HaarCovariance& plan) {
  std::vector<double> prefix(samples.size() + 1, 0.0);
  double sum = 0.0;
  double carry = 0.0;
  for (std::size_t t = 0; t < samples.size(); ++t) {
    const double y = (samples[t] - pivot) - carry;
    const double next = sum + y;
    carry = (next - sum) - y;
    sum = next;
    prefix[t + 1] = sum;
  }
  RobustVariance result;
  std::vector<double> squares;
  for (std::size_t j = 0; j < curve.scales(); ++j) {
    const auto sums = plan.correlation_sums(j, j, classical.mixture);
    const Biweight biweight = tune_biweight(sums);
    thinned_squares(prefix, curve.half[j], squares);
    const auto raw = *std::max_element(squares.begin(), squares.end());
    double mean_square = 0.0;
    for (const double square : squares) {
      mean_square += square;
    }
    mean_square /= static_cast<double>(squares.size());
    const auto root = raw > 0.0 ? upper_root(squares, mean_square, biweight) : std::nullopt;
    const double efficiency = biweight.efficiency(sums);
    result.biweight.push_back(biweight);
    result.efficiency.push_back(efficiency);
    result.edf.push_back(classical.edf[j] * efficiency);
    result.variance.push_back(root);
    result.ci95.push_back(root ? chi_square_interval(*root, result.edf.back()) : Interval{0.0, 0.0});
  }
  return result;
}

}  // namespace driftlab
