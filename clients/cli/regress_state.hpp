#pragma once
/// What a regression gate remembers without a server, in one JSON file: the anchor with its settings, the stored
/// results of every label, and the runs made of them, from which looks are counted.
#include "core/analysis/regression_history.hpp"
#include "schema/json/regression.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace driftlab::cli {

/// A recording as the state holds it: a member of a characterisation with what was said of it beside.
struct StoredRecording {
  std::string id;
  /// What a run reads of it, where it was characterised in this process; else it is read of `document`.
  std::optional<regression::ComparedRecording> compared;
  Json document;  ///< of the characterisation; null where it was characterised here and no state keeps it
  std::string session;
  std::string recorded_at;
  StatedFacts stated;
};

class RegressState {
 public:
  /// The state in a file; empty where there is none yet, and where `path` is empty. Errors: ParseError, Io.
  [[nodiscard]] static Result<RegressState> open(const std::string& path);

  [[nodiscard]] bool kept() const { return !path_.empty(); }
  [[nodiscard]] std::string anchor() const;
  void set_anchor(const std::string& label, const std::string& reason, const regression::Settings& settings);
  /// What the anchor keeps of the settings; nothing in a state of before it did.
  [[nodiscard]] std::optional<regression::Settings> kept_settings() const;
  [[nodiscard]] bool has(const std::string& label) const;
  /// Labels in the order in which they came, and the runs made of them.
  [[nodiscard]] RegressionHistory history() const;
  [[nodiscard]] std::vector<StoredRecording> recordings(const std::string& label) const;
  /// Adds recordings, with their documents, to a label; those whose id it has already stay as they are.
  void add(const std::string& label, const std::vector<StoredRecording>& recordings);
  /// The last label with a run that passed; empty: none.
  [[nodiscard]] std::string last_pass() const;

  /// The number of the look that a run over the recordings of these ids is (core/analysis/regression_history.hpp).
  [[nodiscard]] std::size_t look(const std::string& label, std::vector<std::string> recordings) const;
  /// Remembers a run over the recordings of these ids.
  void add_run(const std::string& label, std::vector<std::string> recordings, const RegressReport& report);

  /// Writes the file: whole or not at all. Error: Io.
  [[nodiscard]] Status save() const;

 private:
  std::string path_;
  Json document_;
  /// Of those added that were characterised in this process, by label and id.
  std::map<std::pair<std::string, std::string>, regression::ComparedRecording> compared_;
};

}  // namespace driftlab::cli
