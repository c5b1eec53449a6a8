#include "core/investigate/unnamed/period_search.hpp"

#include "core/investigate/fullrate/fourier.hpp"
#include "core/investigate/fullrate/spectrum.hpp"
#include "core/signal/progress.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <span>
#include <vector>

namespace driftlab::investigate {
namespace {

constexpr std::array<unsigned, 7> kDoublings{2, 3, 4, 5, 6, 7, 8};  ///< combs have 2^d teeth
constexpr double kPeriods = 8.0;                            ///< in a recording, as the next three chosen, not measured
constexpr double kCap = 20.0;                               ///< of an ordinate over its mean
constexpr std::size_t kMostValues = std::size_t{1} << 18U;  ///< a day at 100 Hz would take a minute
constexpr std::size_t kFewestValues = 256;

/// Ordinates of twice as many frequencies as there are independent ones, over their mean, capped; of the values without
/// their mean.
std::vector<float> ordinates(std::span<const double> values, const std::stop_token& stop) {
  double power = 0.0;
  for (const double value : values) {
    power += value * value;
  }
  const auto padded = [&](std::size_t i) { return i < values.size() ? values[i] : 0.0; };
  std::vector<float> p;
  for (const std::complex<double>& one : half_spectrum(2 * values.size(), padded, kWholeTransform, stop)) {
    p.push_back(static_cast<float>(power > 0.0 ? std::min(std::norm(one) / power, kCap) : 0.0));
  }
  return p;
}

/// The first n, those that there are without their mean.
std::vector<double> centred(std::size_t n, const std::function<double(std::size_t)>& at) {
  std::vector<double> values(n);
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    values[i] = at(i);
    sum += values[i];
    count += values[i] != 0.0 ? 1.0 : 0.0;
  }
  for (double& value : values) {
    value -= value != 0.0 ? sum / std::max(count, 1.0) : 0.0;
  }
  return values;
}

/// At most -ln of the chance of a comb's sum.
double nats_of(double sum, double teeth) { return sum > teeth ? sum - teeth - teeth * std::log(sum / teeth) : 0.0; }

/// Of periods around one that a comb of so many teeth has told, the one whose phases tell most: a tooth is half of a
/// line's width uncertain, by which a pulse moves from one end of the recording to the other.
double sharpened(double period, std::size_t teeth, std::span<const double> values, double dt_s) {
  constexpr int kEachWay = 16;
  constexpr std::size_t kFinest = 512;  // phases
  const std::size_t phases = std::min(4 * teeth, kFinest);
  double best = period;
  double most = -1.0;
  for (int d = -kEachWay; d <= kEachWay; ++d) {
    const double drift = static_cast<double>(d) / kEachWay * period / static_cast<double>(teeth);
    const double tried = period * (1.0 + drift / (static_cast<double>(values.size()) * dt_s));
    std::vector<double> sum(phases, 0.0);
    std::vector<double> count(phases, 0.0);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double turns = static_cast<double>(i) * dt_s / tried;
      const auto phase = static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(phases));
      sum[std::min(phase, phases - 1)] += values[i];
      count[std::min(phase, phases - 1)] += values[i] != 0.0 ? 1.0 : 0.0;
    }
    double told = 0.0;
    for (std::size_t b = 0; b < phases; ++b) {
      told += count[b] > 0.0 ? sum[b] * sum[b] / count[b] : 0.0;
    }
    if (told > most) {
      most = told;
      best = tried;
    }
  }
  return best;
}

}  // namespace

std::optional<FoundPeriod> find_period(std::size_t n, double dt_s, const std::function<double(std::size_t)>& at,
                                       const std::stop_token& stop) {
  n = fast_length(std::min(n, kMostValues));
  if (n < kFewestValues) {
    return std::nullopt;
  }
  const std::vector<double> values = centred(n, at);
  const std::vector<float> p = ordinates(values, stop);
  const double places = static_cast<double>(p.size() - 1);
  FoundPeriod best;
  best.tried = 0.0;
  double most = 0.0;
  for (const unsigned doublings : kDoublings) {
    const std::size_t teeth = std::size_t{1} << doublings;
    // Fundamentals in places of the spectrum; steps by which the last tooth moves one place.
    const double step = 1.0 / static_cast<double>(teeth);
    const auto first = static_cast<std::size_t>(2.0 * kPeriods / step);
    const auto end = static_cast<std::size_t>(places);  // where the last tooth is at the end of the spectrum
    double largest = 0.0;
    std::size_t at_largest = first;
    for (std::size_t j = first; j < end && !polled(stop, j); ++j) {
      double sum = 0.0;
      for (std::size_t k = 1; k <= teeth; ++k) {
        sum += static_cast<double>(p[(k * j + teeth / 2) >> doublings]);
      }
      if (sum > largest) {
        largest = sum;
        at_largest = j;
      }
    }
    if (const double nats = nats_of(largest, static_cast<double>(teeth)); nats > most) {
      most = nats;
      best.teeth = teeth;
      best.period_s = static_cast<double>(2 * n) * dt_s / (static_cast<double>(at_largest) * step);
    }
    best.tried += end > first ? 0.5 * static_cast<double>(end - first) : 0.0;
  }
  if (!(best.tried > 0.0 && most > std::log(best.tried))) {
    return std::nullopt;
  }
  best.period_s = sharpened(best.period_s, best.teeth, values, dt_s);
  return best;
}

}  // namespace driftlab::investigate
