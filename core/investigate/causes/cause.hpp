#pragma once
/// A cause: one way in which a simulation can be wrong (spec/causes.md), as a value.
///
/// Each cause is one file of this folder that makes one `Cause`, and one line in registry.cpp. What it declares decides
/// which part of the search examines it:
///   `mean`       a template that the error follows, with an amplitude and at most one shape (tau, lag, t0)
///   `slow`       one more slow process in the noise
///   `examine`    anything that needs the samples at full rate: it looks for itself
///   `file_fact`  what the file itself shows, before any model
/// All evidence is one currency: `score` = twice the gain in log likelihood over the best model without the cause,
/// minus what its freedom is worth (1 per amplitude, more where a shape or time was searched, 2 ln of the scopes
/// tried).
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/slow/slow_model.hpp"
#include "core/investigate/study/study.hpp"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {
class Random;
}

namespace driftlab::investigate {

struct FullRate;
struct Draft;
struct UnitAxis;

/// A cause that adds `amplitude` times a template to the error.
struct MeanEffect {
  /// Templates over the grid of the whole file (one, or two for a free phase); false where an input is missing.
  bool (*build)(const StudyRecording& recording, const ChannelGroup& group, double shape,
                std::vector<std::vector<double>>& columns) = nullptr;
  int columns = 1;
  bool free_phase = false;  ///< two columns, and their combination differs from recording to recording: one amplitude
  /// Values of the shape to try; one value (ignored) where there is none.
  std::vector<double> (*shapes)(const ChannelGroup& group) = nullptr;
  bool continuous = false;  ///< the shape is refined between the tried values
  double penalty = 1.0;
  double (*shape_penalty)(double shape) = nullptr;  ///< added for that value
  bool scope_all = true;
  bool scope_moving = false;
  bool scope_single = false;
  bool change_point = false;  ///< a step at an unknown time, paid for as step_scan.hpp says; `build` takes t0
  /// A small part of the reference rate: what comes to more than 0.3 of it is no error of a scale factor or a mounting
  /// but of unit, axis or clock, and is left unexplained.
  bool part_of_rate = false;
};

enum class Family {
  File,        ///< seen in the file itself
  Mean,        ///< mean effects and slow noise: they explain the same slow misfit
  Variance,    ///< white noise, its level, shape and modulation
  Tails,       ///< its distribution
  Line,        ///< a sinusoid
  CommonMode,  ///< correlation between axes
};

/// One parameter as it is reported.
struct CauseParameter {
  std::string_view name;
  LabUnit (*unit)(const Unit& channel) = nullptr;
};

struct Cause {
  std::string_view name;
  std::string_view title;  ///< "a bias that follows the temperature"
  Family family = Family::Mean;
  std::vector<std::string_view> rivals;  ///< causes that can look alike
  std::string_view needs;                ///< what a study must hold to show it
  std::string_view separates;            ///< the measurement that tells it from its rivals
  std::vector<CauseParameter> parameters;

  const MeanEffect* mean = nullptr;
  const SlowKind* slow = nullptr;
  /// Why the cause cannot be examined in this group; empty: it can.
  std::string (*lacks)(const Study& study, const ChannelGroup& group) = nullptr;
  std::vector<Evidence> (*examine)(const FullRate& data) = nullptr;
  /// Standard deviation of each innovation of member r relative to no effect; what is found can so be taken out.
  void (*deviation)(const FullRate& data, const Evidence& found, std::size_t r, std::vector<double>& sd) = nullptr;
  /// The deviation changes within one recording; with an automatic baseline that recording's own level is free, for the
  /// change says how much louder one part is than the other and not which of them is the usual one.
  bool within_recording = false;
  /// Chance of an innovation beyond e >= 0 on one side, under the symmetric distribution found; normal scores by it
  /// take the finding out.
  std::function<double(double)> (*tail)(const FullRate& data, const Evidence& found) = nullptr;
  /// The found effect once more in a part of the data, where `examine` would have to find it among all there could be.
  Evidence (*find_again)(const FullRate& part, const Evidence& found) = nullptr;
  /// Log likelihood gained on `data` by the effect as found elsewhere, nothing refitted.
  double (*log_gain)(const FullRate& data, const Evidence& found) = nullptr;
  /// The same over several axes at once; members are those of the first.
  std::vector<Evidence> (*examine_together)(std::span<const FullRate> axes) = nullptr;
  std::vector<Evidence> (*file_fact)(const ChannelGroup& group) = nullptr;
  /// Marks the grid places of member r that the found fact has spoilt; nothing after it uses them.
  void (*spoils)(const ChannelGroup& group, const Evidence& found, std::size_t r,
                 std::vector<unsigned char>& mask) = nullptr;
  /// Puts the effect into a simulated recording (core/investigate/causes/draft.hpp); `values` in the order of
  /// `parameters`, SI.
  void (*inject)(Draft& draft, std::span<const double> values, Random& random) = nullptr;
  /// Makes what was found part of a simulated inertial unit (unit_axis.hpp); false where its values do not fit. Null: a
  /// navigation simulation cannot hold the cause. At least one parameter has been found.
  bool (*in_unit)(const Evidence& found, UnitAxis& axis) = nullptr;
};

/// Every cause once.
[[nodiscard]] const std::vector<Cause>& cause_registry();
[[nodiscard]] const Cause* find_cause(std::string_view name);

}  // namespace driftlab::investigate
