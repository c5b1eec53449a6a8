#include "core/fit/structure.hpp"

#include <boost/math/distributions/chi_squared.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace driftlab {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPositiveEvidence = 2.0;
constexpr double kSize = 0.05;

/// ln of the mean of exp(-criterion/2).
double log_mean_weight(const std::vector<double>& criteria) {
  const double least = *std::min_element(criteria.begin(), criteria.end());
  if (!std::isfinite(least)) {
    return -kInfinity;
  }
  double sum = 0.0;
  for (const double criterion : criteria) {
    sum += std::exp(-0.5 * (criterion - least));
  }
  return -0.5 * least + std::log(sum / static_cast<double>(criteria.size()));
}

std::size_t least_of(const std::vector<double>& values) {
  return static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin());
}

std::string written(const char* format, double a, double b) {
  std::array<char, 96> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), format, a, b);
  return {buffer.data(), static_cast<std::size_t>(length)};
}

std::string statement_of(const StructureChoice& choice, const std::vector<std::string>& names) {
  const std::string& best = names[choice.best];
  const std::string figures = written(" (p = %.3g, evidence %.1f)", choice.p, choice.evidence);
  switch (choice.verdict) {
    case StructureVerdict::OneStructure:
      return "One structure, " + best + ", describes every condition while its parameters move" + figures + ".";
    case StructureVerdict::Changes:
      return "The structure changes with the condition: the best common one, " + best +
             ", is worse than a structure for each" + figures + ".";
    case StructureVerdict::Undecided:
      break;
  }
  if (choice.by_condition.size() < 2) {
    return "With one condition there is nothing to compare; its best structure is " + best + ".";
  }
  if (choice.p < kSize && choice.evidence > kPositiveEvidence) {
    return "One structure, " + best + ", is preferred, but it does not fit every condition" + figures +
           ": none of the candidates may be right.";
  }
  return "The data cannot tell one structure, " + best + ", from one that changes" + figures + ".";
}

}  // namespace

std::string_view name_of(StructureVerdict verdict) {
  switch (verdict) {
    case StructureVerdict::OneStructure:
      return "one_structure";
    case StructureVerdict::Changes:
      return "changes";
    case StructureVerdict::Undecided:
      break;
  }
  return "undecided";
}

StructureChoice choose_structure(const std::vector<std::string>& names,
                                 const std::vector<std::vector<StructureScore>>& scores) {
  StructureChoice choice;
  choice.sum.assign(names.size(), 0.0);
  double changing = 0.0;
  for (const std::vector<StructureScore>& condition : scores) {
    std::vector<double> criteria;
    for (std::size_t s = 0; s < names.size(); ++s) {
      criteria.push_back(condition[s].fitted ? condition[s].criterion : kInfinity);
      choice.sum[s] += criteria.back();
    }
    choice.by_condition.push_back(least_of(criteria));
    changing += log_mean_weight(criteria);
  }
  choice.best = least_of(choice.sum);
  if (!std::isfinite(choice.sum[choice.best])) {
    choice.statement = "No structure was fitted under every condition.";
    return choice;
  }
  for (const std::vector<StructureScore>& condition : scores) {
    choice.statistic += condition[choice.best].misfit;
    choice.dof += condition[choice.best].dof;
  }
  if (choice.dof >= 1.0) {
    choice.p = boost::math::cdf(
        boost::math::complement(boost::math::chi_squared(choice.dof), std::max(0.0, choice.statistic)));
  }
  if (scores.size() > 1) {
    choice.evidence = 2.0 * (log_mean_weight(choice.sum) - changing);
    if (choice.evidence < -kPositiveEvidence) {
      choice.verdict = StructureVerdict::Changes;
    } else if (choice.evidence > kPositiveEvidence && choice.p >= kSize) {
      choice.verdict = StructureVerdict::OneStructure;
    }
  }
  choice.statement = statement_of(choice, names);
  return choice;
}

}  // namespace driftlab
