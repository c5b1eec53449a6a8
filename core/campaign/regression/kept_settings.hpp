#pragma once
/// The settings that are fixed before a candidate is seen: margins, scope and alpha stay with the anchor, and a run
/// that takes others says so (spec/regression.md, sections 3 and 8).
#include "core/campaign/regression/recordings.hpp"

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::regression {

/// `alpha`, `margin`, `through_s`, `design_power`: whether an anchor keeps the setting of that name.
[[nodiscard]] bool is_kept_setting(std::string_view name);

/// `settings` with what the anchor keeps, but for the settings that a run names (`stated`): a margin that is named
/// replaces all margins.
[[nodiscard]] Settings with_kept(const Settings& kept, Settings settings, const std::set<std::string>& stated);

struct ChangedSetting {
  std::string name;  ///< `margin.gyroscope`
  std::string kept;  ///< as people read it, with its unit
  std::string now;
};

/// The settings of a run that differ from those kept with its anchor; empty if none does.
[[nodiscard]] std::vector<ChangedSetting> changed_settings(const Settings& kept, const Settings& now);

/// "Settings differ from those kept with the anchor: margin.gyroscope 20, 25, 50 % (kept: 10, 25, 50 %)."; empty
/// without a change.
[[nodiscard]] std::string changed_sentence(const std::vector<ChangedSetting>& changes);

}  // namespace driftlab::regression
