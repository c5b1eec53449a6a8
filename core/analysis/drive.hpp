#pragma once
/// The use case "drive": a recorded drive in, measured GNSS outages out (spec/drives.md).
#include "core/analysis/simulate.hpp"
#include "core/navigate/drive/comparison.hpp"
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
  Compare,   ///< several error models as filters through the same outages
};
[[nodiscard]] std::string_view name_of(DriveQuestion question);
[[nodiscard]] std::optional<DriveQuestion> parse_drive_question(std::string_view name);

/// A model of a comparison: one of the caller's, or without one the name of one that driftlab knows.
struct DriveModel {
  std::string name;
  std::optional<ImuModel> imu;
};

/// The document's model, the same without slow errors, and the filters of the paper's comparison (paper_scenario.hpp),
/// whose gyroscope then stands beside the document's accelerometer.
[[nodiscard]] const std::vector<std::string>& known_drive_models();

struct DriveRequest {
  DriveQuestion question = DriveQuestion::Run;
  bool velocity_constraint = false;
  bool zero_velocity = false;  ///< not where causes are sought
  bool odometer = false;       ///< not where causes are sought
  double gate = 0.0;           ///< of a run
  bool as_stamped = false;     ///< of a run
  std::uint64_t seed = 1;
  int runs = 4;  ///< simulated drives
  /// The antenna's lever arm, and with velocity constraints the mounting, are estimated beside everything else, by the
  /// standard deviations of the document; not where causes are sought.
  bool estimate = false;
  std::vector<DriveModel> models = {};  ///< of a comparison
  bool fit_noise = false;               ///< of a comparison: scale each model's white noise to the innovations first
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

  /// How long the vehicle rests in all [s].
  [[nodiscard]] double resting_s() const;
  /// Rows of the inertial unit that repeat the row before [%]; 0 without rows.
  [[nodiscard]] double repeated_percent() const;
};

[[nodiscard]] DriveCheck check_drive(drive::Drive drive);

/// Error: InvalidArgument, where the options ask for what the vehicle or the document does not allow.
[[nodiscard]] Status check_options(const drive::Drive& drive, const drive::FilterOptions& options);

struct DriveReport {
  drive::Drive drive;
  drive::FilterOptions options;
  drive::DriveEvaluation evaluation;
};

/// Errors: those of check_options and evaluate_drive.
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

/// Several models as filters on the drive, and the verdict that its outages allow.
struct DriveComparisonReport {
  drive::Drive drive;
  drive::FilterOptions options;
  bool fit_noise = false;
  drive::FilterComparison comparison;
};

/// The request's models on a drive. Errors: InvalidArgument (a name that driftlab does not know; fewer than two); those
/// of check_options and compare_filters.
[[nodiscard]] Result<DriveComparisonReport> compare_drive_models(drive::Drive drive, const DriveRequest& request,
                                                                 const RunControl& control = {});

/// The verdicts of all durations.
[[nodiscard]] std::string sentence_of(const DriveComparisonReport& report);

using DriveAnswer = std::variant<DriveReport, DriveSimulationReport, DriveExplanationReport, DriveComparisonReport>;

/// Loads the drive and answers what is asked of it. Errors: those of load_drive and of the question's own function.
[[nodiscard]] Result<DriveAnswer> answer_drive(const DriveRequest& request, const drive::Document& document,
                                               const drive::Tables& tables, const RunControl& control = {});

}  // namespace driftlab
