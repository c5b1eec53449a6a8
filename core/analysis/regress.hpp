#pragma once
/// The use case "regress": is the noise of this firmware no worse than before?
///
/// Stored results of two sets of recordings in, one verdict out (core/campaign/regression/report.hpp). Several runs on
/// one candidate label share the level of the claims: the k-th look takes 0.6, 0.25, 0.15 of alpha, so that
/// re-recording until it passes is not a way to pass (spec/regression.md, section 8).
#include "core/campaign/regression/kept_settings.hpp"
#include "core/campaign/regression/report.hpp"
#include "core/signal/progress.hpp"

#include <cstddef>
#include <optional>
#include <set>
#include <string>

namespace driftlab {

/// Changes when a change of the code changes verdicts.
inline constexpr int kRegressionVersion = 2;

/// Which run on the candidate's label this is.
struct Look {
  std::size_t number = 1;
  std::size_t of = 3;    ///< 3, or 1: the first run spends all of alpha
  bool counted = false;  ///< the earlier runs are known, so that looks are counted
};

struct RegressRequest {
  regression::Request comparison;
  Look look;
  /// The label before the candidate's, where it is not the baseline: compared as information.
  std::optional<regression::Recordings> previous;
  std::set<std::string> stated = {};              ///< names of the settings that the request states
  std::optional<regression::Settings> kept = {};  ///< those that the baseline's anchor keeps
};

struct PreviousVerdict {
  std::string label;
  regression::Verdict verdict = regression::Verdict::Inconclusive;
  std::string sentence;
};

struct RegressReport {
  regression::Report report;
  Look look;
  std::optional<PreviousVerdict> versus_previous;
  std::set<std::string> stated = {};              ///< of the request
  std::optional<regression::Settings> kept = {};  ///< of the request
};

/// The share of alpha that a look takes. Error: Conflict, for a look after the last ("start a new label").
[[nodiscard]] Result<double> look_share(const Look& look);

/// Errors: InvalidArgument (a setting outside its range, field "parameter"); Conflict (too many looks); those of
/// run_regression, Cancelled among them.
[[nodiscard]] Result<RegressReport> regress(const RegressRequest& request, const RunControl& control = {});

}  // namespace driftlab
