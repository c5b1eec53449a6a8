#pragma once
/// Does one structure of the error model describe a sensor under all conditions, or does each condition need its own?
/// The candidates are ranked jointly, and the claim that the structure stays while its parameters move (Radi, Nassar
/// and El-Sheimy 2017, section 5) is tested.
///
/// Ranking. The parameters are free in every condition, so the joint criterion of a structure is the sum of its
/// criteria over the conditions.
///
/// The claim. What one condition shows, another may hide: a component may be too weak there for the record to resolve.
/// That is a change of a parameter, not of the structure. A structure is therefore said to *serve* a condition if it or
/// a part of it has there a criterion within 6 of the best (a posterior ratio of 20, where strong evidence begins; Kass
/// and Raftery 1995). A part is the structure without some of its components; a random walk also counts as a part of a
/// Gauss-Markov process, of which it is the limit for correlation times beyond the record.
///
/// `common` is the smallest candidate that serves every condition. The candidates are nested, and the largest, which
/// has all others as its parts, does so wherever it could be fitted. The claim fails in one way only: no condition
/// shows `common` as a whole, because different conditions ask for components that never occur together. `excess`
/// measures this. It is how much the criterion of `common` exceeds the best one, in the condition where it exceeds it
/// least; above 6 the structure changes with the condition. `p` tests whether `common` fits at all: the sum over the
/// conditions of its least distances L is chi-square, with the sum of their degrees of freedom.
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

/// What the sentence calls the rows: conditions of one sensor, or recordings that somebody put beside each other.
enum class StructureRows { Conditions, Recordings };

/// `scores[condition][candidate]`, all rows as long as `names`, which are names of models; at least one condition. Ties
/// go to the earlier name.
[[nodiscard]] StructureChoice choose_structure(const std::vector<std::string>& names,
                                               const std::vector<std::vector<StructureScore>>& scores,
                                               StructureRows rows = StructureRows::Conditions);

}  // namespace driftlab
