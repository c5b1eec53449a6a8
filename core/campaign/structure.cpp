#include "core/campaign/structure.hpp"

#include "core/process/distributions.hpp"
#include "core/process/model.hpp"
#include "core/process/registry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

namespace driftlab {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kStrong = 6.0;
constexpr double kSize = 0.05;

std::size_t least_of(const std::vector<double>& values) {
  return static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin());
}

std::string written(const char* format, double value) {
  std::array<char, 64> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), format, value);
  return {buffer.data(), static_cast<std::size_t>(length)};
}

/// Criteria by condition and candidate, infinite where not fitted.
using Criteria = std::vector<std::vector<double>>;

/// Is `inner` a part of `outer`, or a limit of one? A random walk is a Gauss-Markov process whose correlation time is
/// beyond the record.
bool is_part(const ModelStructure& inner, const ModelStructure& outer) {
  if (is_nested(inner, outer)) {
    return true;
  }
  const ProcessKind* const walk = find_process("RW");
  const ProcessKind* const markov = find_process("GM");
  ModelStructure replaced = inner;
  const auto found = std::find(replaced.kinds.begin(), replaced.kinds.end(), walk);
  if (found == replaced.kinds.end()) {
    return false;
  }
  *found = markov;
  std::sort(replaced.kinds.begin(), replaced.kinds.end(),
            [](const ProcessKind* a, const ProcessKind* b) { return registry_index(a) < registry_index(b); });
  return is_nested(replaced, outer);
}

/// The smallest candidate that serves every condition, by itself or by a part of it; of equally small ones the one with
/// the smallest sum of what serves. Nothing where a condition has no fit at all.
std::optional<std::size_t> smallest_common(const std::vector<std::string>& names, const Criteria& criteria) {
  std::vector<ModelStructure> structures;
  for (const std::string& name : names) {
    structures.push_back(parse_model(name).value_or(ModelStructure{}));
  }
  std::optional<std::size_t> common;
  std::pair<std::size_t, double> least{};
  for (std::size_t s = 0; s < names.size(); ++s) {
    double sum = 0.0;
    bool serves = true;
    for (const std::vector<double>& condition : criteria) {
      double inside = kInfinity;
      for (std::size_t part = 0; part < names.size(); ++part) {
        if (part == s || is_part(structures[part], structures[s])) {
          inside = std::min(inside, condition[part]);
        }
      }
      sum += inside;
      serves = serves && std::isfinite(condition[s]) &&
               inside <= *std::min_element(condition.begin(), condition.end()) + kStrong;
    }
    const std::pair key(structures[s].parameter_count(), sum);
    if (serves && (!common || key < least)) {
      common = s;
      least = key;
    }
  }
  return common;
}

std::string statement_of(const StructureChoice& choice, const std::vector<std::string>& names, StructureRows rows) {
  const bool conditions = rows == StructureRows::Conditions;
  const std::string row = conditions ? "condition" : "recording";
  const std::string& common = names[choice.common];
  const std::string p = choice.p < 0.01 ? " (p < 0.01)" : " (p = " + written("%.3g", choice.p) + ")";
  if (choice.by_condition.size() < 2) {
    return "With one " + row + " there is nothing to compare; its best structure is " + names[choice.best] + ".";
  }
  switch (choice.verdict) {
    case StructureVerdict::Changes:
      return (conditions ? "The structure changes with the condition: " : "The structures differ: ") + common +
             " would serve all, but no " + row + " shows its components together (criterion worse by " +
             written("%.1f", choice.excess) + " or more).";
    case StructureVerdict::Undecided:
      return "One structure, " + common + ", serves every " + row + " better than others, but does not fit" + p +
             ": none of the candidates may be right.";
    case StructureVerdict::OneStructure:
      break;
  }
  const bool throughout = std::all_of(choice.by_condition.begin(), choice.by_condition.end(),
                                      [&](std::size_t best) { return best == choice.common; });
  return (conditions ? "One structure, " + common + ", describes every condition while its parameters move"
                     : "They have one structure: " + common + " describes every recording") +
         p + (throughout ? "." : "; not every " + row + " shows all of its components.");
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
                                 const std::vector<std::vector<StructureScore>>& scores, StructureRows rows) {
  StructureChoice choice;
  choice.sum.assign(names.size(), 0.0);
  Criteria criteria;
  for (const std::vector<StructureScore>& condition : scores) {
    std::vector<double> row;
    for (std::size_t s = 0; s < names.size(); ++s) {
      row.push_back(condition[s].fitted ? condition[s].criterion : kInfinity);
      choice.sum[s] += row.back();
    }
    choice.by_condition.push_back(least_of(row));
    criteria.push_back(std::move(row));
  }
  choice.best = least_of(choice.sum);
  const auto common = smallest_common(names, criteria);
  if (!common || !std::isfinite(choice.sum[choice.best])) {
    choice.statement = rows == StructureRows::Conditions ? "No structure was fitted under every condition."
                                                         : "No structure was fitted to every recording.";
    return choice;
  }
  choice.common = *common;
  choice.excess = kInfinity;
  for (std::size_t c = 0; c < scores.size(); ++c) {
    const StructureScore& score = scores[c][choice.common];
    choice.excess = std::min(choice.excess, score.criterion - criteria[c][choice.by_condition[c]]);
    choice.statistic += score.misfit;
    choice.dof += score.dof;
  }
  if (choice.dof >= 1.0) {
    choice.p = chi_squared_tail(choice.statistic, choice.dof);
  }
  if (scores.size() > 1) {
    choice.verdict = choice.excess > kStrong ? StructureVerdict::Changes
                     : choice.p < kSize      ? StructureVerdict::Undecided
                                             : StructureVerdict::OneStructure;
  }
  choice.statement = statement_of(choice, names, rows);
  return choice;
}

}  // namespace driftlab
