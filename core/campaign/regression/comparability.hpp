#pragma once
/// Whether two arms can be compared at all (spec/regression.md, section 7).
#include "core/campaign/regression/sessions.hpp"
#include "core/signal/quantity.hpp"

#include <array>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::regression {

/// What must agree for two arms to be compared, in the order in which it is told: an axis or condition that an arm
/// lacks, temperatures, full scales, sessions too short for the scales that must be shown, a rig that does not repeat.
inline constexpr std::array<std::string_view, 5> kComparedItems = {"unit", "temperature", "full_scale", "length",
                                                                   "repeatability"};

/// A reason why the arms cannot be compared: inconclusive whatever the noise says.
struct Incomparable {
  std::string item;  ///< of kComparedItems
  std::string sentence;
};

/// Units that one arm lacks, or a session that its arm's others have under the same condition; temperatures further
/// apart than the limit; and a stated full scale that changed.
[[nodiscard]] std::vector<Incomparable> compare_arms(const std::vector<PowerUp>& baseline,
                                                     const std::vector<PowerUp>& candidate,
                                                     const EventLimits& limits = {});

/// The sensors whose stated full scale is not one and the same in every recording that states it.
[[nodiscard]] std::set<Quantity> changed_full_scales(const std::vector<PowerUp>& baseline,
                                                     const std::vector<PowerUp>& candidate);

}  // namespace driftlab::regression
