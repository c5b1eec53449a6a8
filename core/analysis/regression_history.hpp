#pragma once
/// The history of a regression gate, as the next run needs it (spec/regression.md, sections 2 and 8): the order of the
/// earlier releases, and the number of the look that a run takes at its candidate, counted from 1.
///
/// The caller, which keeps the runs in a state file or on a server, adds them in the order in which they were made.
#include "core/signal/result.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace driftlab {

class RegressionHistory {
 public:
  /// Adds the label of an arm. Labels keep the order in which they were first added; an empty label is ignored.
  void name(const std::string& label);

  /// Adds a run over these recordings of a candidate; the order of the recordings does not matter.
  void add_run(const std::string& candidate, std::vector<std::string> recordings);

  /// Labels in the order in which they were first named.
  [[nodiscard]] const std::vector<std::string>& labels() const { return labels_; }

  /// The number of the look, from 1, that a run over these recordings takes. A set of recordings that was run before
  /// keeps its number.
  [[nodiscard]] std::size_t look(const std::string& candidate, std::vector<std::string> recordings) const;

  /// The labels of neither arm, in the order in which they were first added; the last one is the release before the
  /// candidate's.
  [[nodiscard]] std::vector<std::string> releases(const std::string& baseline, const std::string& candidate) const;

  /// How many of `releases` were added before the baseline; all of them if the baseline was never added.
  [[nodiscard]] std::size_t before(const std::vector<std::string>& releases, const std::string& baseline) const;

 private:
  std::vector<std::string> labels_;
  std::map<std::string, std::vector<std::vector<std::string>>> looks_;  ///< by candidate, each set of ids once
};

/// Error: InvalidArgument where both arms have one label, which would compare a release with itself.
[[nodiscard]] Status check_arms_differ(const std::string& baseline, const std::string& candidate);

}  // namespace driftlab
