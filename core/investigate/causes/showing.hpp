#pragma once
/// How tests show a cause: the simulated study in which it is hidden, the size at which it can be detected there, and
/// the equation that its injection obeys.
///
/// The hidden tests go through the registry. Each cause is hidden in its scenario and must be named, and the change
/// that its injection makes to a recording must obey its law. The law is the equation of the effect (spec/causes.md),
/// written independently of the template or process that the search uses, so that the same error of sign or unit cannot
/// be in both.
#include "core/investigate/slow/slow_model.hpp"
#include "core/investigate/study/study.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {
class Random;
}

namespace driftlab::investigate {

struct Draft;

enum class Scenario {
  Static,       ///< two or three static recordings
  Rates,        ///< static, three to five constant rates of both signs, a ramp
  Profile,      ///< static and two profiles with a reference column
  Shake,        ///< static and a recording with bursts of vibration, an accelerometer beside the gyro
  SixPosition,  ///< six positions, accelerometers beside the gyro
  Temperature,  ///< two static recordings while the temperature rises and falls
  Axes,         ///< one static recording of three axes
  TwoAxes,      ///< static, rates about z; gyroscopes x and z
  Headings,     ///< six static recordings, turned by 60 deg each
  Turning,      ///< static, rates about z; accelerometers x and y
};

enum class Acting { Everywhere, SecondAlone, AllButFirst };  ///< in which recordings of the scenario

/// The facts about the study that are known when the size of an effect is chosen.
struct Stage {
  const Study& study;  ///< simulated without any effect
  double z;            ///< size of the effect in standard deviations, for known base and template
  bool given;          ///< the baseline is given
  double density;      ///< N of the white noise [SI sqrt(s)]
  double rate_hz;
  double duration_s;  ///< of each recording

  [[nodiscard]] double dt_s() const { return 1.0 / rate_hz; }
  [[nodiscard]] double recordings() const { return static_cast<double>(study.recordings.size()); }
  [[nodiscard]] double samples_each() const { return duration_s * rate_hz; }
  [[nodiscard]] double samples() const { return samples_each() * recordings(); }
  [[nodiscard]] double white_sd() const;  ///< of one sample
};

/// One figure that an injected recording must show.
struct Figure {
  std::string what;
  double seen = 0.0;
  double expected = 0.0;
  double tolerance = 0.0;
};

/// Compares the recording before and after the injection of `values`. Its figures must be such that the right equation
/// gives them, and that half, twice or the negative of the values would not.
using Law = std::vector<Figure> (*)(const Draft& before, const Draft& after, std::span<const double> values);

struct Showing {
  Scenario scenario = Scenario::Static;
  Acting acting = Acting::Everywhere;
  bool given = false;          ///< to be seen only beside a given baseline
  std::string_view axis = {};  ///< the only axis it is put on; empty: all
  /// The shape of a mean effect, or beta of a slow process; null: 0.
  double (*shape)(const Stage& stage, Random& random) = nullptr;
  /// Values of the parameters, SI. A mean effect and a slow process may leave it null: their amplitude is then the one
  /// that an oracle who knows base and template sees at z standard deviations.
  std::vector<double> (*values)(const Stage& stage, Random& random) = nullptr;
  bool oracle = true;  ///< what an oracle gains at that size is z^2/2, near enough to compare with
  /// The causes of spec/causes.md leave it null: tests/hidden/equations.cpp has theirs, by another hand.
  Law law = nullptr;
};

}  // namespace driftlab::investigate
