#pragma once
/// One structure for all conditions, or another one for each? The nine candidates ranked jointly, and the claim that
/// the structure stays while its parameters move (Radi, Nassar and El-Sheimy 2017, section 5) put to the test.
///
/// Parameters are free in every condition, so the joint criterion of a structure is the sum of its criteria over the
/// conditions, and its joint misfit the sum of its least L, chi-square with the sum of their degrees of freedom where
/// the structure is right everywhere: `p` is the probability of a larger one. A criterion of BIC type is twice the
/// negative logarithm of a posterior weight (Schwarz 1978; for moments Andrews and Lu 2001), so with structures equally
/// likely beforehand
///   one     = ln 1/M sum_S exp(-1/2 sum_c crit_c(S)),   changing = sum_c ln 1/M sum_S exp(-1/2 crit_c(S)),
/// and `evidence` = 2 (one - changing) weighs "one structure" against "each condition its own": positive speaks for
/// one, 2 to 6 is positive evidence, above 6 strong (Kass and Raftery 1995). A record too short to tell two structures
/// apart favours neither. Measured: tests/ACCURACY.md.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// One candidate in one condition.
struct StructureScore {
  bool fitted = false;
  double criterion = 0.0;
  double misfit = 0.0;  ///< least L
  double dof = 0.0;     ///< of L
};

enum class StructureVerdict {
  OneStructure,  ///< evidence above 2, and the best common structure is not rejected at 5 %
  Changes,       ///< evidence below -2
  Undecided,     ///< between, or preferred and yet rejected: no candidate fits every condition
};

/// `one_structure`, `changes`, `undecided`.
[[nodiscard]] std::string_view name_of(StructureVerdict verdict);

struct StructureChoice {
  std::size_t best = 0;                   ///< the candidate with the smallest sum
  std::vector<double> sum;                ///< joint criterion per candidate; infinite where a condition lacks it
  std::vector<std::size_t> by_condition;  ///< the best of each condition
  double statistic = 0.0;                 ///< sum of the misfits of `best`
  double dof = 0.0;
  double p = 1.0;
  double evidence = 0.0;
  StructureVerdict verdict = StructureVerdict::Undecided;
  std::string statement;  ///< the verdict as a sentence
};

/// `scores[condition][candidate]`, all rows as long as `names`; at least one condition. Ties go to the earlier name.
/// One condition gives no verdict: Undecided with evidence 0.
[[nodiscard]] StructureChoice choose_structure(const std::vector<std::string>& names,
                                               const std::vector<std::vector<StructureScore>>& scores);

}  // namespace driftlab
