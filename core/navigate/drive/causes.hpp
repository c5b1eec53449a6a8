#pragma once
/// The causes that a drive can show, as values: each a number that the filter's options take (spec/drives.md, section
/// 6).
///
/// A cause is one line of the list in causes.cpp, with one knob for each of its parameters. Nothing else knows it: the
/// search turns every knob that applies to the drive, and injection into a simulated or recorded drive turns the same
/// one the other way.
#include "core/navigate/drive/filter_run.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace driftlab::drive {

/// One parameter of a cause.
struct Knob {
  std::string_view cause;      ///< name in documents
  std::string_view parameter;  ///< of the cause
  std::string_view title;      ///< for people: "the unit's clock is off by"
  std::string_view unit;       ///< lab unit
  double per_si = 1.0;         ///< lab units in one SI unit
  double step = 0.0;           ///< first step of the search, SI
  double most = 0.0;           ///< beyond this magnitude it is not sought, SI
  void (*turn)(FilterOptions& options, double by) = nullptr;
  bool (*applies)(const Drive& drive, const FilterOptions& options) = nullptr;  ///< null: always
  std::string_view told_apart;  ///< the measurement that separates it from its rivals
  /// A ratio of variances. Its standard error grows with it, so that their quotient stays small however large the
  /// effect is (at most sqrt(dof / 2)); what the likelihood loses without it decides alone.
  bool ratio = false;
};

/// Every knob once, in the order of the specification.
[[nodiscard]] const std::vector<Knob>& all_knobs();

/// The knob of a cause's parameter; null for an unknown one.
[[nodiscard]] const Knob* find_knob(std::string_view cause, std::string_view parameter);

/// A cause as people call it, with what a drive's files and readings show without a knob: "lasting errors of
/// positions". `cause` is one of a knob or of a finding.
[[nodiscard]] std::string_view words_of(std::string_view cause);

/// One parameter of a cause in words: the cause alone where it has no other, else "misaligned gyroscope axes (xz)".
[[nodiscard]] std::string words_of(const Knob& knob);

}  // namespace driftlab::drive
