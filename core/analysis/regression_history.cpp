#include "core/analysis/regression_history.hpp"

#include <algorithm>
#include <utility>

namespace driftlab {

void RegressionHistory::name(const std::string& label) {
  if (!label.empty() && std::find(labels_.begin(), labels_.end(), label) == labels_.end()) {
    labels_.push_back(label);
  }
}

void RegressionHistory::add_run(const std::string& candidate, std::vector<std::string> recordings) {
  std::sort(recordings.begin(), recordings.end());
  auto& looks = looks_[candidate];
  if (std::find(looks.begin(), looks.end(), recordings) == looks.end()) {
    looks.push_back(std::move(recordings));
  }
}

std::size_t RegressionHistory::look(const std::string& candidate, std::vector<std::string> recordings) const {
  const auto looks = looks_.find(candidate);
  if (looks == looks_.end()) {
    return 1;
  }
  std::sort(recordings.begin(), recordings.end());
  const auto same = std::find(looks->second.begin(), looks->second.end(), recordings);
  return static_cast<std::size_t>(same - looks->second.begin()) + 1;
}

std::vector<std::string> RegressionHistory::releases(const std::string& baseline, const std::string& candidate) const {
  std::vector<std::string> others;
  for (const std::string& label : labels_) {
    if (label != baseline && label != candidate) {
      others.push_back(label);
    }
  }
  return others;
}

std::size_t RegressionHistory::before(const std::vector<std::string>& releases, const std::string& baseline) const {
  const auto place = std::find(labels_.begin(), labels_.end(), baseline);
  return static_cast<std::size_t>(std::count_if(releases.begin(), releases.end(), [&](const std::string& release) {
    return std::find(labels_.begin(), place, release) != place;
  }));
}

Status check_arms_differ(const std::string& baseline, const std::string& candidate) {
  if (!candidate.empty() && candidate == baseline) {
    return fail(ErrorCode::InvalidArgument, "Baseline and candidate have the same label, " + candidate + ".");
  }
  return {};
}

}  // namespace driftlab
