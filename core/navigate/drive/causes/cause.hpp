#pragma once
/// A cause that a drive can show, as a value: one way in which a drive differs from what its filter and its simulation
/// are told (spec/drives.md, section 6).
///
/// Each cause is one file of this folder, which defines one function returning a `Cause`, and one line in registry.cpp.
/// All that is specific to the cause is in that file. A cause declares one or more of:
///
///   - knobs: numbers of the filter's options. The search turns every knob that applies to the drive, an injection into
///     a simulated drive turns the same one the other way. A knob that measurements depend on may be a state of the
///     filter: it then declares the standard deviation with which a filter that is to estimate it begins;
///   - what the drive's files show of it before any filter runs;
///   - levels: factors of the model's white noise, which are fitted before anything is sought and named last.
///
/// No other code knows it by name; tests/house/causes.py refuses the name anywhere else.
#include "core/navigate/drive/evaluation.hpp"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::drive {

/// A parameter that the drive shows.
struct DriveFinding {
  std::string cause;  ///< its name in documents; people read words_of
  std::string parameter;
  std::string title;
  std::string unit;
  double value = 0.0;  ///< in `unit`
  double se = 0.0;
  double score = 0.0;
  std::string pair;      ///< a cause whose score was within 2 of this one's when it was named; empty: none
  std::string evidence;  ///< what showed it: the file, the fixes alone, the innovations
  std::string told_apart;
  bool from_files = false;  ///< the files showed it, no filter
  /// The value lies where the search ends (Knob::most), beyond what the cause can be: something else looks like it.
  bool at_bound = false;
  bool judged = false;         ///< outages that it has not seen say what it is worth
  bool kept = true;            ///< in the extended model
  double held_out_gain = 0.0;  ///< mean log score gained on outages that it has not seen
};

/// One parameter of a cause that the filter's options hold.
struct Knob {
  std::string_view cause = {};  ///< filled in by the registry
  std::string_view parameter;   ///< name in documents
  std::string_view title;       ///< for people: "the unit's clock is off by"
  std::string_view unit;        ///< lab unit
  double per_si = 1.0;          ///< lab units in one SI unit
  double step = 0.0;            ///< first step of the search, SI
  double most = 0.0;            ///< SI: a change from the document by more is not what the cause is called
  void (*turn)(FilterOptions& options, double by) = nullptr;                    ///< SI
  double (*value)(const FilterOptions& options) = nullptr;                      ///< what the options hold, SI
  bool (*applies)(const Drive& drive, const FilterOptions& options) = nullptr;  ///< null: always
  std::string_view told_apart;  ///< the measurement that separates it from its rivals
  /// A share of a whole: it has its own ends, 0 and `most`, and is what it is called at either of them.
  bool share = false;
  /// A further error of the estimate beside its standard error, SI; it is included in the stated error. Null: none.
  double (*systematic)(const Drive& drive, const FilterOptions& options) = nullptr;
  /// What is known of it beforehand, SI, where a filter is to estimate it as a state; 0: nothing is to be estimated by
  /// these. Null: it is no state.
  double (*prior_sd)(const Document& document, const FilterOptions& options) = nullptr;
  /// The sign says nothing: findings have none.
  bool magnitude = false;
  /// Fitted as soon as it applies, and reported with the cause's first parameter, never before it, because that
  /// parameter has another meaning without this one.
  bool companion = false;
};

/// The evidence for a cause in the drive's files, before any filter runs.
struct FromFiles {
  DriveFinding finding;  ///< all but the cause, and what the explanation fills in
  /// What the options are then; null: the loading has mended the drive already.
  std::function<void(FilterOptions&)> use;
  /// True if the cause decides which readings may be used: every filter then gets the options. False if it is a value
  /// of the model: it is then a step of the explanation by itself.
  bool of_readings = false;
};

/// A factor of the model's white noise.
struct NoiseLevel {
  std::string_view parameter;
  std::string_view title;
  double FilterOptions::* factor = nullptr;
  double named_from = 1.25;  ///< this factor, or one over it, is worth a name
  std::string_view told_apart;
};

struct Cause {
  std::string_view name;   ///< in documents; the function's and the file's
  std::string_view words;  ///< as people call it: "lasting errors of positions"
  std::vector<Knob> knobs = {};
  /// Nothing where the files do not show it. `options`: what the filter is told so far.
  std::optional<FromFiles> (*from_files)(const Drive& drive, const FilterOptions& options) = nullptr;
  std::vector<NoiseLevel> levels = {};
  /// A sentence beside a finding of the innovations; `known`: the files had shown the cause before. Empty: none.
  std::string (*note)(const DriveFinding& finding, bool known) = nullptr;
  /// What the files show of a finding of the innovations: a phrase beside its evidence. Empty: nothing.
  std::string (*seen_in_files)(const Drive& drive) = nullptr;
  /// What the outages of the mended model show of one: a sentence. Empty: nothing.
  std::string (*seen_in_outages)(const Drive& drive, const DriveEvaluation& mended) = nullptr;
};

/// Every cause once, in the order of the specification.
[[nodiscard]] const std::vector<Cause>& cause_registry();

/// Null for an unknown name.
[[nodiscard]] const Cause* find_cause(std::string_view name);

/// Every knob once, in the order of their causes.
[[nodiscard]] const std::vector<Knob>& all_knobs();

/// The knob of a cause's parameter; null for one that has none.
[[nodiscard]] const Knob* find_knob(std::string_view cause, std::string_view parameter);

/// The states that the causes declare for a filter with these options.
[[nodiscard]] std::vector<EstimatedConstant> declared_states(const Document& document, const FilterOptions& options);

/// A cause as people call it. `cause` is a registered name.
[[nodiscard]] std::string_view words_of(std::string_view cause);

/// One parameter of a cause in words: the cause alone where it has no other, else "misaligned gyroscope axes (xz)".
[[nodiscard]] std::string words_of(const Knob& knob);

/// The finding of a knob by the innovations, without its numbers.
[[nodiscard]] DriveFinding finding_of(const Knob& knob);

}  // namespace driftlab::drive
