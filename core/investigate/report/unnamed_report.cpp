#include "core/investigate/report/unnamed_report.hpp"

#include "core/investigate/report/earned.hpp"
#include "core/investigate/report/remains.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace driftlab::investigate {
namespace {

/// The check that a profile without a name has failed, and the sentence.
void report_profile(const UnnamedFinding& found, std::size_t channels, Report& report) {
  Check check;
  check.id = found.effect.column + ".";
  check.id.append(name_of(found.effect.kind)).append("_").append(name_of(found.effect.against));
  check.title = std::string(name_of(found.effect.kind)) + " by " + std::string(words_of(found.effect.against));
  check.channel = found.effect.column;
  check.observed = found.heldout_gain;
  const auto quantile = [&](double p) { return std::max(0.0, 2.0 * std::log(found.tried / (1.0 - p))); };
  check.median = quantile(0.5);
  check.q975 = quantile(0.975);
  check.p = found.chance(1);
  check.p_adjusted = found.chance(channels);
  report_unexplained(std::move(check), found.sentence, report);
}

}  // namespace

void report_unnamed(std::vector<UnnamedFinding> unnamed, std::size_t channels, Report& report) {
  const auto is_unexplained = [&](const UnnamedFinding& one) {
    return std::any_of(report.unexplained.begin(), report.unexplained.end(),
                       [&](const Unexplained& left) { return left.channel == one.effect.column; });
  };
  for (const UnnamedFinding& one : unnamed) {
    if (shows_itself(one, channels) && !is_unexplained(one)) {
      report_profile(one, channels, report);
    }
  }
  std::erase_if(unnamed, [&](const UnnamedFinding& one) { return !is_unexplained(one); });
  report.unnamed = std::move(unnamed);
  for (const UnnamedFinding& one : report.unnamed) {
    if (report.outages) {
      report.outages->left_out.push_back("a profile without a name of " + one.effect.column);
    }
  }
}

}  // namespace driftlab::investigate
