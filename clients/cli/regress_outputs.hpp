#pragma once
/// How a regression run ends on the command line, whoever compared: the files that were asked for, the text or the
/// document, and the exit code.
#include "clients/cli/regress_run.hpp"

#include <functional>
#include <string>

namespace driftlab::cli {

/// The forms of a finished run; each is made, or fetched, when it is wanted. Errors: Io, those of a daemon.
struct RunForms {
  regression::Verdict verdict = regression::Verdict::Inconclusive;
  std::function<Result<std::string>()> document;
  std::function<Result<std::string>()> text;
  std::function<Result<std::string>()> junit;
  std::function<Result<std::string>(const std::string& figure)> markdown;  ///< `figure`: its path; empty: none is shown
  std::function<Result<std::string>()> figure;
  std::function<Result<std::string>()> badge;
};

/// Removes what an earlier run left under the names that a run with these flags writes, so that nothing publishes it as
/// this one's. Error: Io.
[[nodiscard]] Status remove_outputs(const RegressFlags& flags);

/// A run that ended without a verdict: of its files only a summary and a test report, which say why.
void write_no_verdict(const RegressFlags& flags, const std::string& sentence);

/// Writes the files, prints the text or the document, and says how the process ends.
[[nodiscard]] tl::expected<Exit, Failure> finish_run(const RegressFlags& flags, const RunForms& forms,
                                                     Inconclusive inconclusive);

}  // namespace driftlab::cli
