#pragma once
/// The sessions of a comparison, and the units that they share: an axis of a sensor in one condition.
#include "core/campaign/regression/pooled_unit.hpp"
#include "core/campaign/regression/sessions.hpp"
#include "core/signal/quantity.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace driftlab::regression {

/// All sessions in one list: baseline, candidate, then the releases.
struct ComparedSessions {
  PowerUps baseline;
  PowerUps candidate;
  std::vector<PowerUps> history;

  /// Baseline, candidate, then the releases as they are listed.
  [[nodiscard]] std::vector<const PowerUp*> all() const;
  /// How many of them are of the two arms.
  [[nodiscard]] std::size_t compared() const { return baseline.sessions.size() + candidate.sessions.size(); }
};

struct NamedUnit {
  std::string name;
  std::string condition;
  Quantity quantity = Quantity::Unspecified;
  std::string axis;
};

/// Units of the sessions' channels by name; channels that no name can be given to are left out.
[[nodiscard]] std::map<std::string, NamedUnit> units_of(const std::vector<PowerUp>& sessions);

/// What one session measured of a unit; empty where it has none of it.
[[nodiscard]] SessionChannels channels_of(const PowerUp& session, const std::string& unit);

/// The best model of one arm, by the least sum of criteria over its channels; empty where no model was fitted to all.
[[nodiscard]] std::string structure_of(const std::vector<PowerUp>& sessions, const std::string& unit);

}  // namespace driftlab::regression
