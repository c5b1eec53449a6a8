#include "core/campaign/regression/held_share.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

namespace driftlab::regression {
namespace {

constexpr double kMostSteps = 1e3;       ///< standard deviation in steps above which rounding makes no equal neighbours
constexpr double kStandardErrors = 4.0;  ///< that chance may add
constexpr double kDependence = 4.0;      ///< times the variance of independent neighbours
constexpr double kOtherNoise = 0.1;      ///< of p, for noise that is not Gaussian
constexpr std::array kPlaces{0.0, 0.125, 0.25, 0.375, 0.5};  ///< of the mean between two steps; the rest mirrors them

double density(double z) { return std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2; }
double below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

/// What rounding makes of noise: the share of equal neighbours, and the mean square of the rounded differences
/// [step^2].
struct Rounded {
  double equal = 1.0;
  double mean_square = 0.0;
};

/// The share of equal neighbours where differences are N(0, s^2) [step] at every place between two steps: E(1 - |d|)+.
double equal_of_differences(double s) {
  return 2.0 * below(1.0 / s) - 1.0 - 2.0 * s * (density(0.0) - density(1.0 / s));
}

/// Differences d ~ N(0, s^2) [step] at every place between two steps: n + f steps become n with probability 1 - f.
Rounded of_differences(double s) {
  Rounded rounded{equal_of_differences(s), 0.0};
  const int far = static_cast<int>(std::ceil(8.0 * s)) + 1;
  for (int n = 0; n < far; ++n) {
    const double mass = 2.0 * (below((n + 1) / s) - below(n / s));
    const double part = 2.0 * s * (density(n / s) - density((n + 1) / s)) - n * mass;  // E f over n <= |d| < n + 1
    rounded.mean_square += (mass - part) * n * n + part * (n + 1) * (n + 1);
  }
  return rounded;
}

/// White noise of standard deviation s [step] about a mean at `place` between two steps.
Rounded of_white_noise(double s, double place) {
  Rounded rounded{0.0, 0.0};
  double mean = 0.0;
  double square = 0.0;
  const int far = static_cast<int>(std::ceil(8.0 * s)) + 1;
  for (int k = -far; k <= far; ++k) {
    const double share = below((k + 0.5 - place) / s) - below((k - 0.5 - place) / s);
    rounded.equal += share * share;
    mean += share * k;
    square += share * k * k;
  }
  rounded.mean_square = 2.0 * (square - mean * mean);
  return rounded;
}

/// The share of equal neighbours of noise whose rounded differences have that mean square [step^2]; nothing where such
/// noise has no differences so small.
std::optional<double> equal_at(double mean_square, const std::function<Rounded(double)>& noise) {
  double low = 0.01;
  double high = kMostSteps;
  if (noise(low).mean_square > mean_square) {
    return std::nullopt;
  }
  constexpr int kHalvings = 30;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(low * high);
    (noise(middle).mean_square < mean_square ? low : high) = middle;
  }
  return noise(low).equal;
}

struct Bounds {
  double least = 1.0;
  double most = 0.0;
};

/// p of (1), over the kinds of noise and the places.
Bounds rounding_of(double mean_square) {
  Bounds bounds;
  const auto take = [&](const std::optional<double>& equal) {
    if (equal) {
      bounds.least = std::min(bounds.least, *equal);
      bounds.most = std::max(bounds.most, *equal);
    }
  };
  take(equal_at(mean_square, of_differences));
  for (const double place : kPlaces) {
    take(equal_at(mean_square, [place](double s) { return of_white_noise(s, place); }));
  }
  constexpr double kMostOfTwo = 0.5;
  if (mean_square <= kMostOfTwo) {
    take(1.0 - mean_square);  // readings of two neighbouring values, in whatever shares
  }
  return bounds;
}

/// The same from a table: a run asks some thousand times. From noise of more than 1.7 steps on all kinds are one, and
/// rounding adds 1/6 to the mean square.
Bounds rounding_at(double mean_square) {
  constexpr double kLeast = 1e-2;
  constexpr double kMost = 6.0;
  constexpr std::size_t kPoints = 65;
  if (mean_square >= kMost) {
    const double equal = equal_of_differences(std::sqrt(mean_square - 1.0 / 6.0));
    return {equal, equal};
  }
  if (mean_square <= kLeast) {
    return {0.0, 1.0};
  }
  const double interval = std::log(kMost / kLeast) / (kPoints - 1);
  static const std::array<Bounds, kPoints> table = [interval] {
    std::array<Bounds, kPoints> points;
    for (std::size_t i = 0; i < kPoints; ++i) {
      points[i] = rounding_of(kLeast * std::exp(interval * static_cast<double>(i)));
    }
    return points;
  }();
  const double place = std::log(mean_square / kLeast) / interval;
  const std::size_t i = std::min(static_cast<std::size_t>(place), kPoints - 2);
  const double part = place - static_cast<double>(i);
  return {std::lerp(table[i].least, table[i + 1].least, part), std::lerp(table[i].most, table[i + 1].most, part)};
}

/// h of (1) with one bound of p.
double held_at(double equal, double mean_square, double Bounds::* bound) {
  const auto rest = [&](double held) { return held + (1.0 - held) * rounding_at(mean_square / (1.0 - held)).*bound; };
  if (rest(0.0) >= equal) {
    return 0.0;
  }
  double low = 0.0;
  double high = equal;
  constexpr int kHalvings = 14;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (rest(middle) < equal ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

HeldShare held_share(double equal, std::size_t samples, double mean_square, double step) {
  constexpr double kFine = 1e4;  // steps^2: fewer than one neighbour in two hundred is equal by rounding
  if (!(step > 0.0) || equal <= 0.0 || mean_square > kFine * step * step) {
    return {equal, equal};
  }
  if (!(mean_square > 0.0) || equal >= 1.0) {
    return {0.0, equal};
  }
  const double steps = mean_square / (step * step);
  const double p = rounding_at(steps).most;
  const double spread = kStandardErrors * std::sqrt(kDependence * p * (1.0 - p) /
                                                    static_cast<double>(std::max<std::size_t>(samples, 1))) +
                        kOtherNoise * p;
  return {held_at(std::max(0.0, equal - spread), steps, &Bounds::most),
          held_at(std::min(1.0, equal + spread), steps, &Bounds::least)};
}

}  // namespace driftlab::regression
