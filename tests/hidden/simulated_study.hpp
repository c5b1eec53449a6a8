#pragma once
/// Studies out of driftlab's own simulator: known base model, known (or no) effect, files in memory.
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/study/study.hpp"

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace driftlab::hidden {

/// White noise and slow processes per sample, gyroscope units SI.
struct BaseModel {
  std::string name;
  double n = 0.0;  ///< [rad/sqrt(s)] or [m/s/sqrt(s)]
  std::vector<investigate::SlowComponent> slow;
};

/// Base models with up to two Gauss-Markov processes and a random walk, levels of consumer sensors, drawn from the
/// seed.
[[nodiscard]] BaseModel draw_base(Random& random, bool accelerometer);

using investigate::Scenario;

struct World {
  Scenario scenario = Scenario::Static;
  bool given = false;  ///< baseline: the true base, else automatic
  bool accelerometer = false;
  double rate_hz = 50.0;
  double duration_s = 600.0;
  std::uint64_t seed = 1;
  std::uint64_t replicate = 0;  ///< other noise of the same base, motion and bias
};

/// An effect to be hidden: values SI in declared order, and the recordings it acts in (empty: all).
struct Hidden {
  std::string cause;
  std::vector<double> values;
  std::vector<std::size_t> recordings;
};

struct SimulatedStudy {
  investigate::Study study;
  BaseModel base;
  std::deque<std::vector<double>> memory;  ///< the columns
};

/// Deterministic in the world's seed. The loader of the product reads the columns, as from files.
[[nodiscard]] SimulatedStudy simulate_study(const World& world, const std::vector<Hidden>& effects);

/// A scenario in which the cause can be seen, and parameters that an oracle would see at about z standard deviations.
struct Case {
  World world;
  Hidden effect;
};
[[nodiscard]] Case make_case(const std::string& cause, double z, std::uint64_t seed);

}  // namespace driftlab::hidden
