/// gnss_coloured_noise: errors of positions last from fix to fix. The filter estimates them beside everything else.
#include "core/navigate/drive/causes/cause.hpp"
#include "core/navigate/drive/rest_correlation.hpp"
#include "core/signal/significant.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>

namespace driftlab::drive {
namespace {

constexpr double kShortestColour = 0.5;  ///< [s]
constexpr std::string_view kColourApart = "the correlation of fixes at rest, and of innovations once their level fits";

std::string correlation_at_rest(const Drive& drive) {
  const auto found = rest_correlation(drive);
  if (!found) {
    return "";
  }
  return "at rest (" + how_often(found->rests) + ", " + significant(found->seconds) +
         " s in all) positions correlate by " + significant(found->after_1s) + " after 1 s and " +
         (found->lasts_s ? "by 1/e after " + significant(*found->lasts_s) + " s"
                         : "by more than 1/e within half of the longest rest");
}

}  // namespace

Cause gnss_coloured_noise() {
  return {.name = "gnss_coloured_noise",
          .words = "lasting errors of positions",
          .knobs = {{.parameter = "sigma",
                     .title = "positions of fixes have lasting errors of",
                     .unit = "m",
                     .step = 0.02,
                     .most = 20.0,
                     .turn = [](FilterOptions& o, double by) { o.coloured.sigma_m += by; },
                     .value = [](const FilterOptions& o) { return o.coloured.sigma_m; },
                     .told_apart = kColourApart,
                     .magnitude = true},
                    {.parameter = "tau_s",
                     .title = "lasting errors of positions last",
                     .unit = "s",
                     .step = 3.0,
                     .most = 300.0,
                     .turn = [](FilterOptions& o,
                                double by) { o.coloured.tau_s = std::max(o.coloured.tau_s + by, kShortestColour); },
                     .value = [](const FilterOptions& o) { return o.coloured.tau_s; },
                     .applies = [](const Drive&, const FilterOptions& o) { return !o.coloured.none(); },
                     .told_apart = kColourApart,
                     .companion = true}},
          .seen_in_files = correlation_at_rest};
}

}  // namespace driftlab::drive
