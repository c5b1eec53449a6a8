#pragma once
/// A cause: one way in which a simulation can be wrong (spec/causes.md), as a value.
///
/// Each cause is one file of this folder that defines one function returning a `Cause`, and one line in registry.cpp.
/// Everything that is special to the cause stands in that file: its family (family.hpp) with what that must declare,
/// how it is put into a simulated recording, what it means to an inertial unit, and how tests show it (showing.hpp). No
/// other code knows it by name; tests/house/causes.py refuses the name anywhere else.
///
/// All evidence is one currency: `score` = twice the gain in log likelihood over the best model without the cause,
/// minus what its freedom is worth (1 per amplitude, more where a shape or time was searched, 2 ln of the scopes
/// tried).
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/causes/family.hpp"
#include "core/investigate/causes/showing.hpp"

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace driftlab {
class Random;
}

namespace driftlab::investigate {

struct UnitAxis;

/// One parameter as it is reported.
struct CauseParameter {
  std::string_view name;
  LabUnit (*unit)(const Unit& channel) = nullptr;
};

struct Cause {
  std::string_view name;
  std::string_view title;  ///< "a bias that follows the temperature"
  Family family;
  std::vector<std::string_view> rivals;  ///< causes that can look alike
  std::string_view needs;                ///< what a study must hold to show it
  std::string_view separates;            ///< the measurement that tells it from its rivals
  std::vector<CauseParameter> parameters;
  /// The registered process that it is, parameter for parameter; empty: it is none.
  std::string_view process = {};
  /// Why the cause cannot be examined in this group; empty: it can.
  std::string (*lacks)(const Study& study, const ChannelGroup& group) = nullptr;
  /// Puts the effect into a simulated recording (draft.hpp); `values` in the order of `parameters`, SI. Null for a mean
  /// effect, whose template is added, and for a slow process.
  void (*inject)(Draft& draft, std::span<const double> values, Random& random) = nullptr;
  /// Makes what was found part of a simulated inertial unit (unit_axis.hpp); false where its values do not fit. Null: a
  /// cause that is a process is added to the axis as that, and any other cannot be held by a navigation simulation. At
  /// least one parameter has been found.
  bool (*in_unit)(const Evidence& found, UnitAxis& axis) = nullptr;
  Showing showing = {};  ///< how tests show it

  /// What the cause declares where it belongs to family F, else null.
  template <class F>
  [[nodiscard]] const F* as() const {
    return std::get_if<F>(&family);
  }
  /// Mean effects and slow noise: they explain the same slow misfit.
  [[nodiscard]] bool is_slow() const { return as<MeanEffect>() != nullptr || as<SlowNoise>() != nullptr; }
};

/// How a cause that is seen at full rate is sought there; null for the others.
using Examine = std::vector<Evidence> (*)(const FullRate& data);
[[nodiscard]] Examine examine_of(const Cause& cause);

/// The parameter that the amplitude of a mean effect is reported as where its shape is `shape`.
[[nodiscard]] const CauseParameter& amplitude_of(const Cause& cause, double shape);

/// Every cause once.
[[nodiscard]] const std::vector<Cause>& cause_registry();
[[nodiscard]] const Cause* find_cause(std::string_view name);
/// The cause that is one more of a registered process.
[[nodiscard]] const Cause* cause_of_process(std::string_view process);

}  // namespace driftlab::investigate
