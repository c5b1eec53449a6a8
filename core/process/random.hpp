#pragma once
/// Random numbers that have the same bits everywhere. std::normal_distribution may differ between standard libraries,
/// so the transforms are written here. The engine is std::mt19937_64, whose output the C++ standard defines.
#include <cstdint>
#include <random>

namespace driftlab {

/// One stream of random numbers. Same seed and stream, same numbers. Not thread safe: one per call.
class Random {
 public:
  /// `stream` separates the runs of one seed (repetition number, channel number): streams share no state.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

  /// Uniform on (0, 1), 53 bits, neither end included.
  double uniform() { return (static_cast<double>(engine_() >> 11U) + 0.5) * 0x1p-53; }

  /// Standard normal, by the ziggurat of Marsaglia and Tsang (2000) with 128 layers and exact tails.
  double normal();

  /// Uniform on 0 .. bound - 1; bound > 0.
  std::uint64_t below(std::uint64_t bound);

  /// Student's t with `nu` degrees of freedom (nu >= 1), as a normal over the root of a chi-square made of a Gamma draw
  /// (Marsaglia and Tsang 2000, "A simple method for generating gamma variables").
  double student(double nu);

 private:
  double gamma(double shape);
  std::mt19937_64 engine_;
};

}  // namespace driftlab
