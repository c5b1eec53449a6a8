#include "core/variance/theo1.hpp"

#include "core/variance/prefix_sums.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace driftlab {
namespace {

constexpr std::size_t kMostBlocks = 127;
constexpr std::size_t kBlocks = 64;

}  // namespace

double theo1(std::span<const double> samples, double pivot, std::size_t m) {
  const std::unique_ptr<double[]> phase = prefix_sums(samples, pivot);
  const std::size_t middle = m / 2;
  const std::size_t starts = samples.size() + 1 - m;
  double sum = 0.0;
  for (std::size_t d = 0; d < middle; ++d) {
    double squares = 0.0;
    for (std::size_t i = 0; i < starts; ++i) {
      const double difference = phase[i] - phase[i + middle - d] + phase[i + m] - phase[i + middle + d];
      squares += difference * difference;
    }
    sum += squares / static_cast<double>(middle - d);
  }
  const auto length = static_cast<double>(m);
  return sum / (0.75 * static_cast<double>(starts) * length * length);
}

Theo1Value theo1_at(std::span<const double> samples, double pivot, std::size_t window, double dt_s) {
  const std::size_t block = window <= kMostBlocks ? 1 : window / kBlocks;
  const std::size_t length = samples.size() / block;
  std::vector<double> means(length);
  for (std::size_t k = 0; k < length; ++k) {
    double sum = 0.0;
    for (std::size_t t = 0; t < block; ++t) {
      sum += samples[k * block + t] - pivot;
    }
    means[k] = sum / static_cast<double>(block);
  }
  const std::size_t m = std::min(window / block, length) / 2 * 2;
  const double ratio = 0.75 * static_cast<double>(m);
  return {.tau_s = ratio * static_cast<double>(block) * dt_s,
          .variance = theo1(means, 0.0, m),
          .ratio = ratio,
          .length = length};
}

}  // namespace driftlab
