#include "core/investigate/report/order.hpp"

#include "core/signal/sort_keeping_ties.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace driftlab::investigate {

void put_in_order(std::vector<Finding>& findings) {
  std::map<const Cause*, double> best;
  std::map<const Cause*, bool> unsure;
  for (const Finding& finding : findings) {
    const Evidence& evidence = finding.evidence;
    const auto [place, fresh] = best.emplace(evidence.cause, evidence.score);
    place->second = std::max(place->second, evidence.score);
    bool& all = unsure.emplace(evidence.cause, true).first->second;
    all = all && evidence.ambiguous;
  }
  const auto key = [&](const Finding& finding) {
    const Evidence& evidence = finding.evidence;
    const Concern concern = concern_of(*evidence.cause);
    return std::tuple(concern == Concern::Format, unsure.at(evidence.cause), concern, -best.at(evidence.cause),
                      evidence.cause->name, -evidence.score);
  };
  sort_keeping_ties(findings, [&](const Finding& a, const Finding& b) { return key(a) < key(b); });
}

std::vector<FindingGroup> groups_of(const std::vector<Finding>& findings) {
  std::vector<FindingGroup> groups;
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const Evidence& evidence = findings[i].evidence;
    if (groups.empty() || groups.back().cause != evidence.cause) {
      groups.push_back({evidence.cause, {}, {}, true});
    }
    FindingGroup& group = groups.back();
    group.findings.push_back(i);
    group.ambiguous = group.ambiguous && evidence.ambiguous;
    for (const auto& [recording, column] : findings[i].channels) {
      if (std::find(group.columns.begin(), group.columns.end(), column) == group.columns.end()) {
        group.columns.push_back(column);
      }
    }
  }
  return groups;
}

std::string_view name_of(Concern concern) {
  switch (concern) {
    case Concern::Recording:
      return "recording";
    case Concern::Calibration:
      return "calibration";
    case Concern::Noise:
      return "noise";
    case Concern::Format:
      return "format";
  }
  return "noise";
}

}  // namespace driftlab::investigate
