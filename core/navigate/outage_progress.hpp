#pragma once
/// What an outage evaluation knows while its runs go on, as the name of the stage that they are: a sentence for people
/// that can be read back, so that whoever watches a job has the intervals too.
///
/// "outages, mean after 40 runs: M_stat(AV) 12 m [10, 14], M_dyn(GMWM) 9.1 m [8.3, 9.9]"
#include "core/signal/estimate.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

struct OutagesSoFar {
  struct Filter {
    std::string name;
    Estimate error_m;  ///< mean over runs and outages, and its 95 % interval
  };
  std::size_t runs = 0;
  std::vector<Filter> filters;
};

/// The sentence. Digits are those that the interval lets stand.
[[nodiscard]] std::string stage_of(const OutagesSoFar& known);

/// What a stage says; nothing where it is another sentence or a name of a filter makes it ambiguous.
[[nodiscard]] std::optional<OutagesSoFar> outages_so_far(std::string_view stage);

}  // namespace driftlab
