#pragma once
/// The evidence for a cause: where it acts, how much the log likelihood gains by it, and its parameters.
#include "core/signal/estimate.hpp"
#include "core/signal/unit.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::investigate {

struct Cause;

/// A unit for people: value in `symbol` = SI value * per_si.
struct LabUnit {
  std::string symbol;
  double per_si = 1.0;
};

/// The channel's own unit as reports write it: deg/s, m/s^2, or 1; with something behind it ("/s", "/degC").
[[nodiscard]] LabUnit level_unit(const Unit& channel, std::string_view suffix = "");

/// "frequency" of `frequency_hz`, "mean run" of `mean_run`: a parameter's name in sentences, which write its unit
/// beside its value.
[[nodiscard]] std::string spoken_name(std::string_view parameter);

struct FoundParameter {
  std::string name;
  Estimate estimate;  ///< SI
  LabUnit unit;
};

struct Evidence {
  const Cause* cause = nullptr;
  std::size_t group = 0;
  std::vector<std::size_t> also_groups;  ///< further channel groups it acts on
  std::vector<std::size_t> members;      ///< recordings of the group it acts in
  double score = 0.0;                    ///< see cause.hpp
  double gain = 0.0;                     ///< twice the log likelihood ratio, no penalty
  double freedom = 1.0;                  ///< parameters spent
  double shape = 0.0;                    ///< tau, lag, t0, frequency, corner: what the template needs
  std::vector<FoundParameter> parameters;
  double heldout_gain = 0.0;  ///< log likelihood gained on samples the effect was not fitted to
  double heldout_samples = 0.0;
  double share_heldout = 0.5;  ///< of the samples, per fold
  bool heldout = false;
  std::vector<Evidence> rivals;  ///< that come near, best first
  bool ambiguous = false;
  std::string note;   ///< one more sentence for the report
  std::string doubt;  ///< why an effect outside the registry may be behind it; empty: no doubt
};

/// The most rivals that a finding keeps, and the most alternatives that are reported of it.
inline constexpr std::size_t kMostAlternatives = 5;

/// The reported alternatives to a finding: the names of its rivals, best first. If an effect outside the registry may
/// be behind it, `unnamed` comes last, and rivals are dropped so that there are kMostAlternatives at most.
[[nodiscard]] std::vector<std::string> alternatives_of(const Evidence& evidence);

/// Penalty for having chosen among `choices` equally likely places.
[[nodiscard]] double choice_penalty(double choices);

}  // namespace driftlab::investigate
