#include "core/fit/outlier_mixture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace driftlab {
namespace {

constexpr double kPerOctave = 4.0;

/// Density at z up to a constant.
double density(double z, double variance) { return std::exp(-0.5 * z * z / variance) / std::sqrt(variance); }

}  // namespace

std::size_t ResidualHistogram::bin_of(double magnitude) {
  if (magnitude < kFineEnd) {
    return static_cast<std::size_t>(magnitude * kPerUnit);
  }
  const double octave = kPerOctave * std::log2(magnitude / kFineEnd);
  return kFine + static_cast<std::size_t>(std::min(octave, static_cast<double>(kBins - kFine - 1)));
}

double ResidualHistogram::lower_end(std::size_t bin) {
  return bin < kFine ? static_cast<double>(bin) / kPerUnit
                     : kFineEnd * std::exp2(static_cast<double>(bin - kFine) / kPerOctave);
}

double ResidualHistogram::centre(std::size_t bin) { return 0.5 * (lower_end(bin) + lower_end(bin + 1)); }

std::uint64_t ResidualHistogram::total() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
}

double ResidualHistogram::largest() const {
  for (std::size_t bin = kBins; bin-- > 0;) {
    if (counts_[bin] > 0) {
      return centre(bin);
    }
  }
  return 0.0;
}

OutlierMixture OutlierMixture::up_to(double largest) {
  OutlierMixture mixture;
  for (double size = kSmallestSize; mixture.ratio.size() < kMostSizes; size *= 2.0) {
    mixture.ratio.push_back(size * size);
    if (size >= largest) {
      break;
    }
  }
  mixture.weight.assign(mixture.ratio.size(), 0.01 / static_cast<double>(mixture.ratio.size()));
  return mixture;
}

void OutlierMixture::refine(const ResidualHistogram& histogram, int steps) {
  const auto total = static_cast<double>(histogram.total());
  if (!(total > 0.0)) {
    return;
  }
  const std::size_t sizes = ratio.size();
  std::vector<double> share(sizes + 1);
  std::vector<double> sum(sizes + 1);
  for (int step = 0; step < steps; ++step) {
    std::fill(sum.begin(), sum.end(), 0.0);
    double square = 0.0;
    const double good = 1.0 - outlier_share();
    for (std::size_t bin = 0; bin < ResidualHistogram::kBins; ++bin) {
      const auto count = static_cast<double>(histogram.count(bin));
      if (count == 0.0) {
        continue;
      }
      const double z = ResidualHistogram::centre(bin);
      share[0] = good * density(z, core);
      double all = share[0];
      for (std::size_t k = 0; k < sizes; ++k) {
        share[k + 1] = weight[k] * density(z, core + ratio[k]);
        all += share[k + 1];
      }
      if (!(all > 0.0)) {
        share.back() = all = 1.0;
      }
      for (std::size_t k = 0; k <= sizes; ++k) {
        const double p = count * share[k] / all;
        sum[k] += p;
        if (k == 0) {
          square += p * z * z;
        } else {  // expected square of the good part of a sample that carries an error
          const double own = core / (core + ratio[k - 1]);
          square += p * (own * own * z * z + own * ratio[k - 1]);
        }
      }
    }
    for (std::size_t k = 0; k < sizes; ++k) {
      weight[k] = sum[k + 1] / total;
    }
    core = std::max(square / total, 1e-6);
  }
}

double OutlierMixture::outlier_share() const { return std::accumulate(weight.begin(), weight.end(), 0.0); }

double OutlierMixture::posterior(double z) const {
  // Relative to the good density, in logarithms: z may be anything.
  double odds = 0.0;
  for (std::size_t k = 0; k < ratio.size(); ++k) {
    const double variance = core + ratio[k];
    const double exponent = 0.5 * z * z * (1.0 / core - 1.0 / variance);
    odds += weight[k] * std::sqrt(core / variance) * std::exp(std::min(exponent, 600.0));
  }
  const double good = 1.0 - outlier_share();
  return odds / (odds + good);
}

std::size_t OutlierMixture::pick_size(double z, double u) const {
  std::vector<double> log_share(ratio.size());
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < ratio.size(); ++k) {
    const double variance = core + ratio[k];
    log_share[k] = std::log(std::max(weight[k], 1e-300)) - 0.5 * std::log(variance) - 0.5 * z * z / variance;
    highest = std::max(highest, log_share[k]);
  }
  double all = 0.0;
  for (double& share : log_share) {
    share = std::exp(share - highest);
    all += share;
  }
  double left = u * all;
  for (std::size_t k = 0; k + 1 < ratio.size(); ++k) {
    left -= log_share[k];
    if (left < 0.0) {
      return k;
    }
  }
  return ratio.size() - 1;
}

double false_discovery_limit(const ResidualHistogram& histogram, double core, double rate) {
  const auto total = static_cast<double>(histogram.total());
  double limit = std::numeric_limits<double>::infinity();
  double above = 0.0;
  for (std::size_t bin = ResidualHistogram::kBins; bin-- > 0;) {
    above += static_cast<double>(histogram.count(bin));
    const double z = ResidualHistogram::lower_end(bin);
    const double expected = total * std::erfc(z / std::sqrt(2.0 * core));
    if (above > 0.0 && expected <= rate * above) {
      limit = z;
    }
  }
  return limit;
}

}  // namespace driftlab
