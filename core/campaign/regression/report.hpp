#pragma once
/// The report of a regression run: compares the recordings of a request and states the verdict in sentences.
#include "core/campaign/regression/arms.hpp"
#include "core/campaign/regression/comparability.hpp"
#include "core/campaign/regression/event_checks.hpp"
#include "core/campaign/regression/release_trend.hpp"
#include "core/campaign/regression/verdict.hpp"
#include "core/signal/progress.hpp"

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace driftlab::regression {

struct ScaleReport {
  Test test;
  Outcome outcome;
  std::string name;  ///< of a level: `white_noise.N`; empty for a scale
  double theta = 0.0;
  bool gated = false;
  std::optional<std::array<ArmMean, 2>> means = {};  ///< of a scale
};

struct UnitReport {
  std::string name;  ///< `gyroscope z`
  std::string condition;
  std::string sensor;
  std::string axis;
  std::vector<double> tau_s;               ///< rows
  bool robust = false;                     ///< both arms by robust variances
  std::array<std::vector<double>, 2> edf;  ///< baseline, candidate: sum over the sessions, per row
  std::array<std::string, 2> structure;    ///< best model of each arm
  std::string model;                       ///< of the pooled curve; empty: none
  StructureTest structure_test;
  std::vector<ScaleReport> tests;
};

struct TrendReport {
  std::string unit;  ///< `gyroscope z`
  std::string name;  ///< of a level: `white_noise.N`; empty for the scales
  ReleaseTrend trend;
  [[nodiscard]] bool warns() const { return trend.p < kTrendWarning; }
};

/// The verdict as the dashboard shows it (dashboard/api-needs.md, A1).
struct Summary {
  std::string verdict;  ///< one sentence
  std::vector<std::string> details;
  std::string level;  ///< fine, look, wrong
};

struct Report {
  std::string device;
  Verdict verdict = Verdict::Inconclusive;
  bool leaning_worse = false;
  Summary summary;
  double scope_s = 0.0;
  Settings settings;
  ArmReport baseline;
  ArmReport candidate;
  std::vector<ArmReport> history;
  std::vector<Exclusion> excluded;
  Comparison comparison;
  std::vector<UnitReport> units;
  std::vector<TrendReport> trends;  ///< empty with fewer than three releases
  std::vector<EventCheck> checks;
  std::vector<Incomparable> comparability;
  std::vector<std::string> notes;
  std::optional<double> needed_length_s;
  std::string needs;  ///< the sentence on what would decide; empty for a verdict

  /// The sessions that the scatter between sessions was learnt from (session_scatter.hpp): those of arms and releases
  /// that have more than one.
  struct InformingSession {
    std::string label;  ///< of the arm or release
    std::string session;
  };
  [[nodiscard]] std::vector<InformingSession> informing_sessions() const;
};

/// Errors: InvalidArgument (an arm without recordings; no channel that both arms can be compared in), each with the
/// field "arm" where it concerns one; Cancelled.
[[nodiscard]] Result<Report> run_regression(const Request& request, const RunControl& control = {});

/// A test with the unit that it belongs to, as long as their report lives; without a test: none is such.
struct ToldTest {
  const UnitReport* unit = nullptr;
  const ScaleReport* test = nullptr;
};

/// Of the tests that found a change beyond what is accepted, the one whose interval of all tests at once lies furthest
/// beyond its margin; of equals the first.
[[nodiscard]] ToldTest furthest_beyond(const Report& report);

/// All tests by how far their own upper end lies beyond their margin in ln deviation, the furthest first; equals in the
/// order of the report. A gated test counts as 1 further than a watched one, a test that found a change beyond what is
/// accepted as 10.
[[nodiscard]] std::vector<ToldTest> by_distance(const Report& report);

/// `+23 % [+14, +33]`: a difference in ln deviation as people read it.
[[nodiscard]] std::string percent_text(double ln_deviation);
[[nodiscard]] std::string interval_text(double theta, double lower, double upper);
/// `0.32 s`, `20 s`, `5 min`.
[[nodiscard]] std::string duration_text(double seconds);

/// Writes verdict sentence, details, level and needs into a report that has everything else.
void tell(Report& report);

}  // namespace driftlab::regression
