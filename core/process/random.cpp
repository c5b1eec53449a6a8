#include "core/process/random.hpp"

#include <array>
#include <cmath>

namespace driftlab {
namespace {

constexpr int kLayers = 128;
constexpr double kTailStart = 3.442619855899;       // abscissa where the tail begins, for 128 layers
constexpr double kLayerArea = 9.91256303526217e-3;  // area of every layer

struct Ziggurat {
  std::array<double, kLayers + 1> x{};
  std::array<double, kLayers> ratio{};
};

const Ziggurat& ziggurat() {
  static const Ziggurat shared_table = [] {
    Ziggurat table;
    double density = std::exp(-0.5 * kTailStart * kTailStart);
    table.x[0] = kLayerArea / density;  // the base layer, widened so that it also holds the tail's area
    table.x[1] = kTailStart;
    for (int i = 2; i < kLayers; ++i) {
      table.x[i] = std::sqrt(-2.0 * std::log(kLayerArea / table.x[i - 1] + density));
      density = std::exp(-0.5 * table.x[i] * table.x[i]);
    }
    table.x[kLayers] = 0.0;
    for (int i = 0; i < kLayers; ++i) {
      table.ratio[i] = table.x[i + 1] / table.x[i];
    }
    return table;
  }();
  return shared_table;
}

/// SplitMix64, to turn neighbouring seeds and streams into unrelated words.
std::uint64_t mix(std::uint64_t word) {
  word += 0x9E3779B97F4A7C15ULL;
  word = (word ^ (word >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  word = (word ^ (word >> 27U)) * 0x94D049BB133111EBULL;
  return word ^ (word >> 31U);
}

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream) : engine_(mix(mix(seed) ^ (stream * 0xD1342543DE82EF95ULL))) {}

double Random::normal() {
  const Ziggurat& table = ziggurat();
  for (;;) {
    const std::uint64_t word = engine_();
    const auto layer = static_cast<std::size_t>(word & (kLayers - 1));  // the low 7 bits; the value takes the top 53
    const double u = (static_cast<double>(word >> 11U) + 0.5) * 0x1p-52 - 1.0;
    if (std::fabs(u) < table.ratio[layer]) {
      return u * table.x[layer];
    }
    if (layer == 0) {  // the tail: Marsaglia (1964)
      double x = 0.0;
      double y = 0.0;
      do {
        x = -std::log(uniform()) / kTailStart;
        y = -std::log(uniform());
      } while (y + y < x * x);
      return u > 0.0 ? kTailStart + x : -kTailStart - x;
    }
    const double x = u * table.x[layer];
    const double above = std::exp(-0.5 * (table.x[layer] * table.x[layer] - x * x));
    const double below = std::exp(-0.5 * (table.x[layer + 1] * table.x[layer + 1] - x * x));
    if (below + uniform() * (above - below) < 1.0) {
      return x;
    }
  }
}

std::uint64_t Random::below(std::uint64_t bound) {
  const std::uint64_t threshold = (0 - bound) % bound;  // rejection keeps every value equally likely
  for (;;) {
    const std::uint64_t word = engine_();
    if (word >= threshold) {
      return word % bound;
    }
  }
}

double Random::gamma(double shape) {
  const double d = shape - 1.0 / 3.0;
  const double c = 1.0 / std::sqrt(9.0 * d);
  for (;;) {
    const double z = normal();
    const double t = 1.0 + c * z;
    if (t <= 0.0) {
      continue;
    }
    const double v = t * t * t;
    if (std::log(uniform()) < 0.5 * z * z + d - d * v + d * std::log(v)) {
      return d * v;
    }
  }
}

double Random::student(double nu) {
  const double z = normal();
  // Gamma(nu/2) needs shape >= 1; below that, Gamma(a) = Gamma(a + 1) U^(1/a).
  const double half = 0.5 * nu;
  const double draw = half >= 1.0 ? gamma(half) : gamma(half + 1.0) * std::pow(uniform(), 1.0 / half);
  return z / std::sqrt(draw / half);
}

}  // namespace driftlab
