#pragma once
/// A cause, as a value: one way in which a simulation can differ from the recordings (spec/causes.md).
///
/// Each cause is one file of this folder, which defines one function returning a `Cause`, and one line in registry.cpp.
/// All that is specific to the cause is in that file: its family (family.hpp) and what the family requires, its
/// injection into a simulated recording, its meaning for an inertial unit, and the study in which tests show it
/// (showing.hpp). No other code knows it by name; tests/house/causes.py refuses the name anywhere else.
///
/// All evidence is measured on one scale, the score: twice the gain in log likelihood over the best model without the
/// cause, minus a penalty for its freedom. The penalty is 1 per amplitude, more if a shape or a time was searched for,
/// and 2 ln of the number of scopes that were tried.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/causes/family.hpp"
#include "core/investigate/causes/showing.hpp"

#include <optional>
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
  double doubtful_below = -1e300;  ///< an estimate below it is at the bound of the search, and says nothing [SI]
};

/// What a finding asks a laboratory to do, in the order in which it would: record anew or mend the file, calibrate,
/// model the noise, know the format.
enum class Concern { Recording, Calibration, Noise, Format };

struct Cause {
  std::string_view name;
  std::string_view title;  ///< "a bias that follows the temperature"
  /// The equation of the effect in print, one line of plain text: "y = R t, t from the first sample of the file". In it
  /// y is the error of the channel, x what the sensor sees, z what the file says, k the number of a sample. It names
  /// each parameter by its symbol or by `spoken_name`.
  std::string_view equation;
  Family family;
  std::vector<std::string_view> rivals;  ///< causes that can look alike
  std::string_view needs;                ///< what a study must hold to show it
  std::string_view separates;            ///< the measurement that tells it from its rivals
  std::vector<CauseParameter> parameters;
  /// The registered process that the cause adds, with the same parameters; empty: the cause is not a process.
  std::string_view process = {};
  /// Empty: the concern that its family implies (`concern_of`).
  std::optional<Concern> concern = {};
  /// Why the cause cannot be examined in this group; empty: it can.
  std::string (*lacks)(const Study& study, const ChannelGroup& group) = nullptr;
  /// Puts the effect into a simulated recording (draft.hpp), with `values` in the order of `parameters`, SI. Null for a
  /// mean effect, whose template is added, and for a slow process.
  void (*inject)(Draft& draft, std::span<const double> values, Random& random) = nullptr;
  /// Adds the finding to the model of a simulated inertial unit (unit_axis.hpp); false if its values do not fit. If it
  /// is null, a cause that is a process is added to the axis as that process, and any other cause cannot be part of a
  /// navigation simulation. Precondition: at least one parameter has been found.
  bool (*in_unit)(const Evidence& found, UnitAxis& axis) = nullptr;
  Showing showing = {};  ///< how tests show it

  /// The declarations of the cause for family F; null if it belongs to another family.
  template <class F>
  [[nodiscard]] const F* as() const {
    return std::get_if<F>(&family);
  }
  /// True for mean effects and slow noise, which explain the same slow misfit.
  [[nodiscard]] bool is_slow() const { return as<MeanEffect>() != nullptr || as<SlowNoise>() != nullptr; }
};

/// The cause's own concern if it states one; else Format for a fact that gives the lattice step, Recording for all
/// other facts of the file and faults of recordings, Calibration for mean effects and Noise for the rest.
[[nodiscard]] Concern concern_of(const Cause& cause);

/// The function that looks for a cause at full rate; null for causes that are not looked for there.
using Examine = std::vector<Evidence> (*)(const FullRate& data);
[[nodiscard]] Examine examine_of(const Cause& cause);

/// The parameter that the amplitude of a mean effect is reported as where its shape is `shape`.
[[nodiscard]] const CauseParameter& amplitude_of(const Cause& cause, double shape);

/// Every cause once.
[[nodiscard]] const std::vector<Cause>& cause_registry();
[[nodiscard]] const Cause* find_cause(std::string_view name);
/// The cause that adds a registered process to the model.
[[nodiscard]] const Cause* cause_of_process(std::string_view process);

}  // namespace driftlab::investigate
