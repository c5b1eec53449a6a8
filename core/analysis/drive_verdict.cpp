#include "core/analysis/drive_verdict.hpp"

#include "core/analysis/outage_verdict.hpp"

#include <algorithm>

namespace driftlab {
namespace {

bool knows_itself(const std::vector<drive::DurationSummary>& durations) {
  return std::none_of(durations.begin(), durations.end(),
                      [](const drive::DurationSummary& one) { return one.coverage95.value < kHonestShare; });
}

bool is_trusted(const DriveReport& report) { return knows_itself(report.evaluation.durations); }

bool is_trusted(const DriveSimulationReport& report) { return is_trusted(report.measured); }

bool is_trusted(const DriveExplanationReport& report) { return knows_itself(report.explanation.before.durations); }

bool is_trusted(const DriveComparisonReport& report) {
  const auto& filters = report.comparison.filters;
  return std::any_of(filters.begin(), filters.end(),
                     [](const drive::ComparedFilter& filter) { return knows_itself(filter.durations); });
}

}  // namespace

Verdict verdict_of(const DriveAnswer& answer) {
  Verdict verdict;
  const std::string all = std::visit([](const auto& report) { return sentence_of(report); }, answer);
  const std::size_t end = std::min(all.find(". "), all.size());
  verdict.sentence = all.substr(0, std::min(end + 1, all.size()));
  if (end < all.size()) {
    verdict.details.push_back(all.substr(end + 2));
  }
  const bool trusted = std::visit([](const auto& report) { return is_trusted(report); }, answer);
  verdict.level = trusted ? VerdictLevel::Fine : VerdictLevel::Look;
  return verdict;
}

}  // namespace driftlab
