#include "core/variance/spectral_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLinearFrom = 0.03;
constexpr int kLinearBins = 256;
constexpr int kPerOctave = 20;
/// Bins of the table of products, in bins of the density.
constexpr std::size_t kCoarse = 4;
/// Periods of sin^2(pi f m) in a bin beyond which integrals are taken over whole oscillations.
constexpr double kFast = 0.7;

/// Eight points of Gauss and Legendre's rule on [-1, 1]: the positive half.
constexpr std::array<double, 4> kNode{0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
constexpr std::array<double, 4> kWeight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};

double square(double x) { return x * x; }

double filter(double f, double m) {
  const double wide = square(std::sin(kPi * f * m));
  return square(wide / (m * std::sin(kPi * f)));
}

/// Edges of the bins. The lowest bin begins where the longest filter passes next to nothing even of a random walk.
std::vector<double> bin_edges(double longest_half) {
  const double lowest = std::min(1e-3 / longest_half, 0.5 * kLinearFrom);
  const int octaves = static_cast<int>(std::ceil(kPerOctave * std::log2(kLinearFrom / lowest)));
  std::vector<double> edges;
  for (int i = octaves; i > 0; --i) {
    edges.push_back(kLinearFrom * std::exp2(-static_cast<double>(i) / kPerOctave));
  }
  for (int i = 0; i <= kLinearBins; ++i) {
    edges.push_back(kLinearFrom + (0.5 - kLinearFrom) * i / kLinearBins);
  }
  return edges;
}

/// int |H_m|^2 df over a bin of half width h about c.
double filter_integral(double c, double h, double m) {
  double sum = 0.0;
  if (2.0 * h * m < kFast) {
    for (std::size_t k = 0; k < kNode.size(); ++k) {
      sum += kWeight[k] * (filter(c - h * kNode[k], m) + filter(c + h * kNode[k], m));
    }
    return h * sum;
  }
  // 1/sin^2 as a parabola times (3 - 4 cos 2 pi f m + cos 4 pi f m)/8, exactly.
  const auto smooth = [](double f) { return 1.0 / square(std::sin(kPi * f)); };
  const double middle = smooth(c);
  const double curvature = (smooth(c + h) - 2.0 * middle + smooth(c - h)) / (2.0 * h * h);
  const double slope = (smooth(c + h) - smooth(c - h)) / (2.0 * h);
  sum = 3.0 * (2.0 * h * middle + curvature * 2.0 * h * h * h / 3.0);
  for (const double harmonic : {1.0, 2.0}) {
    const double k = 2.0 * kPi * m * harmonic;
    const double sine = std::sin(k * h);
    const double cosine = std::cos(k * h);
    const double even = 2.0 * std::cos(k * c);
    const double zeroth = even * sine / k;
    const double first = -2.0 * std::sin(k * c) * (sine / (k * k) - h * cosine / k);
    const double second = even * (h * h * sine / k + 2.0 * h * cosine / (k * k) - 2.0 * sine / (k * k * k));
    sum += (harmonic == 1.0 ? -4.0 : 1.0) * (middle * zeroth + slope * first + curvature * second);
  }
  return sum / (8.0 * m * m);
}

/// Mean of cos(2 pi k f) over a bin of half width h about c.
double mean_cosine(double k, double c, double h) {
  const double x = 2.0 * kPi * k * h;
  return std::fabs(x) > 20.0 ? 0.0 : std::cos(2.0 * kPi * k * c) * (x == 0.0 ? 1.0 : std::sin(x) / x);
}

Eigen::Index pair_count(Eigen::Index scales) { return scales * (scales + 1) / 2; }

}  // namespace

SpectralTable::SpectralTable(std::span<const std::size_t> half, std::size_t samples)
    : half_(half.begin(), half.end()), samples_(samples) {
  const std::vector<double> edges = bin_edges(static_cast<double>(half_.back()));
  const auto bins = static_cast<Eigen::Index>(edges.size() - 1);
  filters_.resize(scales(), bins);
  for (Eigen::Index b = 0; b < bins; ++b) {
    const double low = edges[static_cast<std::size_t>(b)];
    const double high = edges[static_cast<std::size_t>(b) + 1];
    frequency_.push_back(std::sqrt(low * high));
    width_.push_back(high - low);
    for (Eigen::Index j = 0; j < scales(); ++j) {
      const auto m = static_cast<double>(half_[static_cast<std::size_t>(j)]);
      filters_(j, b) = 2.0 * filter_integral(0.5 * (low + high), 0.5 * (high - low), m);  // both signs of f
    }
  }
  tabulate_products(edges);
}

void SpectralTable::tabulate_products(const std::vector<double>& edges) {
  const Eigen::Index count = scales();
  const std::size_t bins = width_.size();
  const std::size_t coarse = (bins + kCoarse - 1) / kCoarse;
  products_.resize(pair_count(count), static_cast<Eigen::Index>(coarse));
  constexpr Eigen::Index kPoints = 2 * static_cast<Eigen::Index>(kNode.size());
  Eigen::MatrixXd values(count, kPoints * static_cast<Eigen::Index>(kCoarse));
  for (std::size_t wide = 0; wide < coarse; ++wide) {
    const std::size_t from = wide * kCoarse;
    const std::size_t to = std::min(bins, from + kCoarse);
    values.setZero();
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(count, count);
    for (std::size_t b = from; b < to; ++b) {
      const double c = 0.5 * (edges[b] + edges[b + 1]);
      const double h = 0.5 * width_[b];
      const Eigen::Index column = kPoints * static_cast<Eigen::Index>(b - from);
      Eigen::VectorXd fast = Eigen::VectorXd::Zero(count);  // 1/(m^2 sin^2) of the scales that oscillate in the bin
      for (Eigen::Index j = 0; j < count; ++j) {
        const auto m = static_cast<double>(half_[static_cast<std::size_t>(j)]);
        const bool oscillates = 2.0 * h * m >= kFast;
        fast(j) = oscillates ? 1.0 / square(m * std::sin(kPi * c)) : 0.0;
        for (Eigen::Index k = 0; k < kPoints; ++k) {
          const double node =
              k % 2 == 0 ? kNode[static_cast<std::size_t>(k / 2)] : -kNode[static_cast<std::size_t>(k / 2)];
          const double value = oscillates ? 0.375 * fast(j) : filter(c + h * node, m);
          values(j, column + k) = value * std::sqrt(h * kWeight[static_cast<std::size_t>(k / 2)]);
        }
      }
      for (Eigen::Index j = 0; j < count; ++j) {  // what two oscillations have in common
        for (Eigen::Index i = 0; fast(j) > 0.0 && i <= j; ++i) {
          if (fast(i) == 0.0) {
            continue;
          }
          const auto a = static_cast<double>(half_[static_cast<std::size_t>(i)]);
          const auto z = static_cast<double>(half_[static_cast<std::size_t>(j)]);
          const double common = 8.0 * mean_cosine(z - a, c, h) + 0.5 * mean_cosine(2.0 * (z - a), c, h) -
                                2.0 * mean_cosine(2.0 * a - z, c, h) - 2.0 * mean_cosine(2.0 * z - a, c, h);
          sum(j, i) += fast(i) * fast(j) * 2.0 * h * common / 64.0;
        }
      }
    }
    sum.triangularView<Eigen::Lower>() += values * values.transpose();
    Eigen::Index row = 0;
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index j = i; j < count; ++j, ++row) {
        const auto coefficients = static_cast<double>(samples_ - 2 * half_[static_cast<std::size_t>(j)] + 1);
        // Both signs of f; the smaller number of coefficients stands with the longer filter.
        const double longer = static_cast<double>(samples_ - 2 * half_[static_cast<std::size_t>(i)] + 1);
        products_(row, static_cast<Eigen::Index>(wide)) = 4.0 / std::max(coefficients, longer) * sum(j, i);
      }
    }
  }
}

Eigen::MatrixXd SpectralTable::covariance(const Eigen::VectorXd& density) const {
  Eigen::VectorXd squares(products_.cols());
  for (Eigen::Index wide = 0; wide < squares.size(); ++wide) {
    const auto from = static_cast<std::size_t>(wide) * kCoarse;
    const std::size_t to = std::min(width_.size(), from + kCoarse);
    double sum = 0.0;
    double total = 0.0;
    for (std::size_t b = from; b < to; ++b) {
      sum += width_[b] * square(density(static_cast<Eigen::Index>(b)));
      total += width_[b];
    }
    squares(wide) = sum / total;
  }
  const Eigen::VectorXd entries = products_ * squares;
  Eigen::MatrixXd covariance(scales(), scales());
  Eigen::Index row = 0;
  for (Eigen::Index i = 0; i < scales(); ++i) {
    for (Eigen::Index j = i; j < scales(); ++j, ++row) {
      covariance(i, j) = covariance(j, i) = entries(row);
    }
  }
  return covariance;
}

std::vector<std::size_t> dense_half_lengths(std::size_t samples, int per_octave) {
  std::vector<std::size_t> half;
  for (int k = 0;; ++k) {
    const auto m = static_cast<std::size_t>(std::lround(std::exp2(static_cast<double>(k) / per_octave)));
    if (4 * m > samples) {
      return half;
    }
    if (half.empty() || m > half.back()) {
      half.push_back(m);
    }
  }
}

}  // namespace driftlab
