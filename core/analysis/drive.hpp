#pragma once
/// The use case "drive": a recorded drive in, measured GNSS outages out (spec/drives.md).
#include "core/analysis/simulate.hpp"
#include "core/navigate/drive/explain.hpp"
#include "core/read/column_file.hpp"

#include <variant>

namespace driftlab {

/// Where a drive gets its files from: this machine, or what a server has stored.
class DriveSource {
 public:
  DriveSource() = default;
  DriveSource(const DriveSource&) = delete;
  DriveSource& operator=(const DriveSource&) = delete;
  virtual ~DriveSource() = default;

  /// The rows of `source.file`, and what its tag says. Errors: whatever keeps it from being read; Cancelled.
  [[nodiscard]] virtual Result<drive::Table> open(const drive::Source& source, const RunControl& control) = 0;
};

/// What is asked of a drive, and what the filter is told beside the document.
enum class DriveQuestion {
  Run,       ///< what the filter does in its outages
  Simulate,  ///< the same outages simulated beside the measured ones
  Explain,   ///< by how much a simulation is too optimistic, why, and what mending gains
};
[[nodiscard]] std::string_view name_of(DriveQuestion question);
[[nodiscard]] std::optional<DriveQuestion> parse_drive_question(std::string_view name);

struct DriveRequest {
  DriveQuestion question = DriveQuestion::Run;
  bool velocity_constraint = false;
  bool zero_velocity = false;  ///< not where causes are sought
  bool odometer = false;       ///< not where causes are sought
  double gate = 0.0;           ///< of a run
  bool as_stamped = false;     ///< of a run
  std::uint64_t seed = 1;
  int runs = 4;  ///< simulated drives
};
[[nodiscard]] drive::FilterOptions options_of(const DriveRequest& request, const drive::Document& document);

/// The columns of a decoded file as a table.
[[nodiscard]] drive::Table table_of(const ColumnFile& columns);

/// The files of a document, decoded. Errors: those of the source, with the field "file".
[[nodiscard]] Result<drive::Tables> open_tables(const drive::Document& document, DriveSource& source,
                                                const RunControl& control);

/// The drive, with the reference that its document asks for: load_drive leaves the withheld fixes where a smoothed path
/// is wanted. Errors: those of load_drive and with_smoothed_reference.
[[nodiscard]] Result<drive::Drive> load_with_reference(const drive::Document& document, const drive::Tables& tables,
                                                       const drive::LoadOptions& options = {});

/// The path of the unit by all fixes: time on the sources' scale, position, velocity, attitude and what is left unknown
/// of each. Errors: those of PreparedDrive::make.
[[nodiscard]] Result<SampleTable> smoothed_table(const drive::Drive& drive, const drive::FilterOptions& options);

/// A drive and what its files show before any filter.
struct DriveCheck {
  drive::Drive drive;
  std::vector<drive::Rest> rests;
  std::optional<drive::Start> start;  ///< of the first run that can be started
  std::string cannot_start;           ///< why none can
};

[[nodiscard]] DriveCheck check_drive(drive::Drive drive);

struct DriveReport {
  drive::Drive drive;
  drive::FilterOptions options;
  drive::DriveEvaluation evaluation;
};

/// Errors: InvalidArgument, where the options ask for what the vehicle or the document does not allow; those of
/// evaluate_drive.
[[nodiscard]] Result<DriveReport> run_drive(drive::Drive drive, const drive::FilterOptions& options,
                                            const drive::EvaluationOptions& settings = {},
                                            const RunControl& control = {});

/// What the evaluation says, first of all: by how much the model's own promise is exceeded.
[[nodiscard]] std::string sentence_of(const DriveReport& report);

/// Why the simulation of a drive is too optimistic, and what the mended model gains.
struct DriveExplanationReport {
  drive::Drive drive;
  drive::DriveExplanation explanation;
};

/// The files of a drive are loaded twice, with and without repairs. Errors: those of load_drive and explain_drive.
[[nodiscard]] Result<DriveExplanationReport> report_explanation(const drive::Document& document,
                                                                const drive::Tables& tables,
                                                                const drive::ExplainOptions& options = {},
                                                                const RunControl& control = {});

/// By how much the simulation is too optimistic, why, and what the mended model gains on outages it has not seen.
[[nodiscard]] std::string sentence_of(const DriveExplanationReport& report);

/// What the model says of the same trajectory and the same outages, beside what was measured.
struct DriveSimulationReport {
  DriveReport measured;
  std::vector<drive::SimulatedDuration> simulated;
};

/// Errors: those of run_drive and simulate_outages.
[[nodiscard]] Result<DriveSimulationReport> simulate_drive_outages(drive::Drive drive,
                                                                   const drive::FilterOptions& options,
                                                                   const drive::SimulationOptions& settings = {},
                                                                   const RunControl& control = {});

[[nodiscard]] std::string sentence_of(const DriveSimulationReport& simulation);

using DriveAnswer = std::variant<DriveReport, DriveSimulationReport, DriveExplanationReport>;

/// Loads the drive and answers what is asked of it. Errors: those of load_drive and of the question's own function.
[[nodiscard]] Result<DriveAnswer> answer_drive(const DriveRequest& request, const drive::Document& document,
                                               const drive::Tables& tables, const RunControl& control = {});

}  // namespace driftlab
