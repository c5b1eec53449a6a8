#pragma once
/// Whether two arms can be compared at all (spec/regression.md, section 7).
#include "core/campaign/regression/sessions.hpp"
#include "core/signal/quantity.hpp"

#include <set>
#include <string>
#include <vector>

namespace driftlab::regression {

/// A reason why the arms cannot be compared: inconclusive whatever the noise says.
struct Incomparable {
  std::string item;  ///< unit, temperature, full_scale, length, repeatability
  std::string sentence;
};

/// Units that one arm lacks, or a session that its arm's others have under the same condition; temperatures more than
/// 5 K apart; and a stated full scale that changed.
[[nodiscard]] std::vector<Incomparable> compare_arms(const std::vector<PowerUp>& baseline,
                                                     const std::vector<PowerUp>& candidate);

/// The sensors whose stated full scale is not one and the same in every recording that states it.
[[nodiscard]] std::set<Quantity> changed_full_scales(const std::vector<PowerUp>& baseline,
                                                     const std::vector<PowerUp>& candidate);

}  // namespace driftlab::regression
