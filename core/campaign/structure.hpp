#pragma once
/// One structure for all conditions, or another one for each? The candidates ranked jointly, and the claim that the
/// structure stays while its parameters move (Radi, Nassar and El-Sheimy 2017, section 5) put to the test.
///
/// Ranking. Parameters are free in every condition, so the joint criterion of a structure is the sum of its criteria
/// over the conditions.
///
/// The claim. Candidates are nested: a component that one condition shows and another does not may have, in the latter,
/// a level too low for the record to resolve, which is a change of a parameter and not of the structure; a random walk
/// is the limit of a Gauss-Markov process whose correlation time is beyond the record, and counts as a part of it. A
/// structure therefore *serves* a condition if it or a part of it has a criterion within 6 of the best (a posterior
/// ratio of 20; Kass and Raftery 1995: strong evidence begins there). `common` is the smallest candidate that serves
/// every condition. The largest candidate always does, so the claim can fail only in this way: no condition shows
/// `common` as a whole, that is, conditions want components that never occur together. `excess` is by how much the
/// criterion of `common` exceeds the best in the condition that shows it best; above 6 the structure changes. `p` tests
/// that `common` fits every condition: the sum of the least L, chi-square with the sum of their degrees of freedom.
/// Measured: tests/ACCURACY.md.
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
  OneStructure,  ///< `excess` is 6 at most, and `common` is not rejected at 5 %
  Changes,       ///< `excess` is above 6
  Undecided,     ///< one condition only, or `common` is rejected: no candidate may be right
};

/// `one_structure`, `changes`, `undecided`.
[[nodiscard]] std::string_view name_of(StructureVerdict verdict);

struct StructureChoice {
  std::size_t best = 0;                   ///< the candidate with the smallest sum
  std::vector<double> sum;                ///< joint criterion per candidate; infinite where a condition lacks it
  std::vector<std::size_t> by_condition;  ///< the best of each condition
  std::size_t common = 0;
  double excess = 0.0;
  double statistic = 0.0;  ///< sum of the misfits of `common`
  double dof = 0.0;
  double p = 1.0;
  StructureVerdict verdict = StructureVerdict::Undecided;
  std::string statement;  ///< the verdict as a sentence
};

/// `scores[condition][candidate]`, all rows as long as `names`, which are names of models; at least one condition. Ties
/// go to the earlier name.
[[nodiscard]] StructureChoice choose_structure(const std::vector<std::string>& names,
                                               const std::vector<std::vector<StructureScore>>& scores);

}  // namespace driftlab
