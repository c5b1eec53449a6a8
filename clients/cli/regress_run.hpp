#pragma once
/// A regression run from the command line: its flags, and the run itself, for `driftlab regress` and `driftlab ci`.
#include "clients/cli/cli.hpp"
#include "clients/cli/input.hpp"
#include "clients/cli/remote_job.hpp"
#include "core/analysis/regress.hpp"
#include "schema/json/regression.hpp"

#include <string>
#include <utility>
#include <vector>

namespace driftlab::cli {

struct RegressFlags {
  std::string run;  ///< run.json; empty: the files below
  std::vector<std::string> baseline;
  std::vector<std::string> candidate;
  std::vector<std::string> history;
  std::string baseline_label;
  std::string candidate_label;
  FileFlags file;
  std::vector<std::string> models;
  std::string settings;  ///< a file with the settings
  std::string state;     ///< a file with looks, anchor and earlier labels
  std::string accept;    ///< the label that becomes the anchor
  std::string reason;
  std::string inconclusive;
  std::string junit, markdown, figure, badge;  ///< files to write
  std::string out;                             ///< a folder for all of them and the document
  bool json = false;
  std::string server;  ///< the daemon that runs it; empty: here
};

/// Adds the flags that both commands have.
void add_regress_flags(CLI::App& command, RegressFlags& flags);

/// A run that ends without a verdict, for bad input unless `exit` says otherwise.
[[nodiscard]] inline tl::unexpected<Failure> unable(Error error, Exit exit = Exit::BadInput) {
  return tl::unexpected(Failure{std::move(error), exit});
}

/// A run through a daemon: files are uploaded with their labels and sessions, characterised and compared there.
[[nodiscard]] tl::expected<Exit, Failure> regress_there(const RegressFlags& flags);

/// Runs, writes the files, prints the text or the document, and says how the process ends: 0 pass, 1 fail, 3
/// inconclusive. A run that ends otherwise leaves no verdict of an earlier one, and says why in summary and test
/// report.
[[nodiscard]] Exit run_regress(const RegressFlags& flags);

}  // namespace driftlab::cli
