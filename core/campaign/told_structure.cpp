#include "core/campaign/told_structure.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
std::vector<std::string> shared_models(const std::vector<const std::vector<ReportedFit>*>& rows) {
  std::vector<std::string> names;
  for (const ReportedFit& fit : *rows.front()) {
    const bool everywhere = std::all_of(rows.begin(), rows.end(), [&](const std::vector<ReportedFit>* row) {
      return find_fit(*row, fit.model) != nullptr;
    });
    if (everywhere && parse_model(fit.model)) {
      names.push_back(fit.model);
    }
  }
  std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
    const auto key = [](const std::string& name) { return std::pair(parse_model(name)->parameter_count(), name); };
    return key(a) < key(b);
  });
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

StructureScore score_of(const ReportedFit& fit) {
  StructureScore score;
  if (!std::isfinite(fit.wic)) {
    return score;
  }
  score.fitted = true;
  score.criterion = fit.wic;
  if (const auto& test = fit.j_test) {
    score.misfit = std::isfinite(test->statistic) ? test->statistic : 0.0;
    score.dof = std::isfinite(test->dof) ? test->dof : 0.0;
  }
  return score;
}

PooledStructure told_structure(const StructureChoice& choice, const std::vector<std::string>& models,
                               const std::vector<std::string>& labels) {
  PooledStructure structure;
  structure.verdict = name_of(choice.verdict);
  structure.statement = choice.statement;
  structure.p = choice.p;
  structure.statistic = choice.statistic;
  structure.dof = choice.dof;
  structure.common = models[choice.common];
  structure.excess = choice.excess;
  std::vector<std::size_t> order(models.size());
  for (std::size_t s = 0; s < order.size(); ++s) {
    order[s] = s;
  }
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::pair(choice.sum[a], a) < std::pair(choice.sum[b], b); });
  for (const std::size_t s : order) {
    structure.ranking.push_back({models[s], choice.sum[s]});
  }
  for (std::size_t r = 0; r < labels.size(); ++r) {
    structure.by_condition.push_back({labels[r], models[choice.by_condition[r]]});
  }
  return structure;
}

}  // namespace driftlab
