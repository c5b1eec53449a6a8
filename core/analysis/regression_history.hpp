#pragma once
/// What earlier runs of a regression gate mean for the next one (spec/regression.md, sections 2 and 8): which releases
/// came before, and the how-manieth look at a candidate a run is.
///
/// Whoever keeps runs, a file or a server, tells them in the order in which they were made.
#include "core/signal/result.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace driftlab {

class RegressionHistory {
 public:
  /// A label that an arm had. Labels keep the order in which they were first named; an empty one is none.
  void name(const std::string& label);

  /// A run over these recordings of a candidate, in any order of them.
  void add_run(const std::string& candidate, std::vector<std::string> recordings);

  /// Labels in the order in which they were first named.
  [[nodiscard]] const std::vector<std::string>& labels() const { return labels_; }

  /// The number of the look, from 1, that a run over these recordings is: the same recordings are the same look.
  [[nodiscard]] std::size_t look(const std::string& candidate, std::vector<std::string> recordings) const;

  /// The labels that are in neither arm, oldest first; the last is the release before the candidate's.
  [[nodiscard]] std::vector<std::string> releases(const std::string& baseline, const std::string& candidate) const;

  /// How many of `releases` were named before the baseline; all, where nobody named that.
  [[nodiscard]] std::size_t before(const std::vector<std::string>& releases, const std::string& baseline) const;

 private:
  std::vector<std::string> labels_;
  std::map<std::string, std::vector<std::vector<std::string>>> looks_;  ///< by candidate, each set of ids once
};

/// Error: InvalidArgument where both arms have one label, which would compare a release with itself.
[[nodiscard]] Status check_arms_differ(const std::string& baseline, const std::string& candidate);

}  // namespace driftlab
