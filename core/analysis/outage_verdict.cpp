#include "core/analysis/outage_verdict.hpp"

#include "core/signal/significant.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace driftlab {
namespace {

constexpr double kPercent = 100.0;

std::string seconds(double time_s) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", time_s);
  return text.data();
}

/// 5.1 m [4.9, 5.3], in `factor` of SI: the digits are those that the interval lets stand.
std::string with_interval(const Estimate& estimate, double factor, const std::string& unit) {
  const double low = factor * estimate.ci95.low;
  const double high = factor * estimate.ci95.high;
  std::string text = significant(factor * estimate.value, low, high);
  text.append(unit.empty() ? "" : " " + unit).append(" [").append(significant(low, low, high));
  return text.append(", ").append(significant(high, low, high)).append("]");
}

std::string metres(const Estimate& estimate) {
  return significant(estimate.value, estimate.ci95.low, estimate.ci95.high) + " m";
}

std::string share(double fraction) { return std::to_string(std::lround(kPercent * fraction)) + " %"; }

/// "after 10 s without GNSS"; outages of several lengths are named by the shortest and the longest.
std::string when(const FilterEvaluation& filter) {
  double least = INFINITY;
  double most = 0.0;
  for (const OutageSummary& outage : filter.outages) {
    least = std::min(least, outage.end_s - outage.start_s);
    most = std::max(most, outage.end_s - outage.start_s);
  }
  const std::string longest = seconds(most);
  const std::string shortest = seconds(std::min(least, most));
  return "after " + (shortest == longest ? longest : shortest + " to " + longest) + " s without GNSS";
}

std::string honesty(const FilterEvaluation& filter) {
  const std::string held = "its 95 % ellipse holds the truth in " + share(filter.coverage95) + " of outages";
  if (filter.coverage95 < kHonestShare) {
    return held + ": it is too sure of itself";
  }
  return filter.nees.ci95.high < kShyNees ? held + ", and is larger than it need be" : held;
}

const FilterEvaluation& filter_with(const std::vector<FilterEvaluation>& filters, bool least) {
  const auto smaller = [](const FilterEvaluation& a, const FilterEvaluation& b) {
    return a.mean_error_m.value < b.mean_error_m.value;
  };
  return least ? *std::min_element(filters.begin(), filters.end(), smaller)
               : *std::max_element(filters.begin(), filters.end(), smaller);
}

const FilterEvaluation& compared_with(const std::vector<FilterEvaluation>& filters) {
  const auto usual = std::find_if(filters.begin(), filters.end(),
                                  [](const FilterEvaluation& filter) { return filter.name == "M_stat(AV)"; });
  return usual == filters.end() ? filter_with(filters, false) : *usual;
}

/// The gain in a clause, or that there is none to speak of.
std::string gain(const FilterEvaluation& best, const FilterEvaluation& other, const PairedDifference& pair) {
  const std::string errors = metres(other.mean_error_m) + " to " + metres(best.mean_error_m);
  if (pair.difference_m.ci95.high < 0.0 && -pair.relative.value >= kPracticalSize) {
    const Estimate lowered{-pair.relative.value, {-pair.relative.ci95.high, -pair.relative.ci95.low}};
    return best.name + " lowers the mean error " + when(best) + " from " + errors + ", by " +
           with_interval(lowered, kPercent, "%") + "; ";
  }
  const std::string off = metres(best.mean_error_m) + " off " + when(best);
  if (pair.difference_m.ci95.high < 0.0) {
    return best.name + " is " + off + ", less than 1 % better than " + other.name + "; ";
  }
  return best.name + " is " + off + " and cannot be told from " + other.name + "; ";
}

void add_facts(const OutageEvaluation& evaluation, const FilterEvaluation& filter, Verdict& verdict) {
  const auto at = static_cast<std::size_t>(&filter - evaluation.filters.data());
  const std::string pointer = "/filters/" + std::to_string(at);
  verdict.facts.emplace_back(pointer + "/mean_error_m/value", filter.mean_error_m.value);
  verdict.facts.emplace_back(pointer + "/coverage95", filter.coverage95);
}

void add_pair(const OutageEvaluation& evaluation, const PairedDifference& pair, Verdict& verdict) {
  for (std::size_t i = 0; i < evaluation.paired.size(); ++i) {
    if (evaluation.paired[i].filter == pair.filter && evaluation.paired[i].against == pair.against) {
      verdict.facts.emplace_back("/paired/" + std::to_string(i) + "/relative/value", pair.relative.value);
    }
  }
}

std::string where_from(const Attribution& parts) {
  return "Of the change of " + with_interval(parts.total.difference_m, 1.0, "m") + ", " +
         with_interval(parts.low_frequency_noise.difference_m, 1.0, "m") +
         " come from telling the filter of low-frequency noise, " +
         with_interval(parts.gauss_markov_states.difference_m, 1.0, "m") + " from Gauss-Markov states and " +
         with_interval(parts.switching.difference_m, 1.0, "m") + " from following the rate.";
}

}  // namespace

Verdict verdict_of(const OutageEvaluation& evaluation, const std::optional<Attribution>& attribution,
                   const std::vector<Claim>& claims) {
  const FilterEvaluation& best = filter_with(evaluation.filters, true);
  const FilterEvaluation& other = compared_with(evaluation.filters);
  Verdict verdict;
  verdict.level = best.coverage95 < kHonestShare ? VerdictLevel::Look : VerdictLevel::Fine;
  add_facts(evaluation, best, verdict);
  const auto pair = evaluation.difference(best.name, other.name);
  if (!pair) {
    verdict.sentence =
        (evaluation.filters.size() > 1 ? "No filter is better than " + best.name + ", which is " : best.name + " is ") +
        metres(best.mean_error_m) + " off " + when(best) + "; " + honesty(best) + ".";
  } else {
    verdict.sentence = gain(best, other, *pair) + honesty(best) + ".";
    add_facts(evaluation, other, verdict);
    add_pair(evaluation, *pair, verdict);
    verdict.details.push_back("The 95 % ellipse of " + other.name + " holds the truth in " + share(other.coverage95) +
                              " of outages; NEES is " + with_interval(best.nees, 1.0, "") + " for " + best.name +
                              " and " + with_interval(other.nees, 1.0, "") + " for " + other.name +
                              ", and 2 is right.");
  }
  if (attribution) {
    verdict.details.push_back(where_from(*attribution));
  }
  if (!claims.empty()) {
    const auto supported =
        std::count_if(claims.begin(), claims.end(), [](const Claim& claim) { return claim.supported; });
    verdict.details.push_back("Of the paper's " + std::to_string(claims.size()) + " claims this simulation supports " +
                              std::to_string(supported) + ".");
  }
  return verdict;
}

}  // namespace driftlab
