#pragma once
/// What a regression run is given on the command line: a run.json or files, read and where needed characterised.
#include "clients/cli/regress_run.hpp"
#include "clients/cli/regress_state.hpp"

#include <string>
#include <vector>

namespace driftlab::cli {

/// The run that the flags ask for. Errors are the user's.
[[nodiscard]] Result<WrittenRegression> written_run(const RegressFlags& flags);

/// Reads `--settings` into a run. Errors are the user's.
[[nodiscard]] Status read_settings(const RegressFlags& flags, WrittenRegression& into);

/// Characterises the files of an arm, one after the other, and reads the results that files hold already.
class ResultReader {
 public:
  /// `models`: candidates of the fits; empty: the usual ones. `lines`: which lines of a text are left out. `kept`: a
  /// state keeps what is read, which needs the documents of what is characterised here.
  ResultReader(std::vector<std::string> models, FileFlags lines, std::string device, bool kept);

  /// Errors: those of reading and characterising a file; Cancelled.
  [[nodiscard]] Result<std::vector<StoredRecording>> read(const WrittenArm& arm);

 private:
  [[nodiscard]] Result<std::vector<StoredRecording>> characterised(const WrittenRecording& written);

  std::vector<std::string> models_;
  FileFlags lines_;
  std::string device_;
  bool kept_;
};

}  // namespace driftlab::cli
