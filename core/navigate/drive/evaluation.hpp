#pragma once
/// Measured outages of a drive: where they lie, and what the filter's errors are in them (spec/drives.md, 4 and 5).
///
/// One filter run per duration and phase; phase p is shifted by p/phases of the period, so that outages of one run
/// never overlap and leave at least 20 s of fixes between them. Outages of different phases do overlap: intervals come
/// from a bootstrap over blocks of one period, in which all phases stay together.
///
/// Runs are tasks of the executor; results stand in the order of duration, phase and time for any number of threads.
#include "core/navigate/drive/error_growth.hpp"
#include "core/navigate/drive/filter_run.hpp"
#include "core/signal/estimate.hpp"
#include "core/signal/progress.hpp"

#include <cstdint>

namespace driftlab::drive {

/// Raised whenever the same drive and seed may give other numbers.
inline constexpr int kDriveAlgorithmVersion = 2;

/// Outages of one run of the filter.
struct PlannedRun {
  std::size_t duration = 0;  ///< index among the plan's durations
  std::size_t phase = 0;
  std::vector<Outage> outages;
};

/// The runs of a plan on one run of readings; those without an outage are left out. An outage counts if reference
/// points lie within 1.6 s on both sides of its start and its end and it lies within the readings.
[[nodiscard]] std::vector<PlannedRun> plan_outages(const Drive& drive, const Start& start);

/// Outages of one duration, over all phases and runs of readings.
struct DurationSummary {
  double duration_s = 0.0;
  double period_s = 0.0;
  std::vector<DriveOutage> outages;  ///< by phase, then time
  Estimate rms_m, median_m;
  double mean_m = 0.0, p95_m = 0.0, worst_m = 0.0;
  double along_rms_m = 0.0, across_rms_m = 0.0;
  Estimate nees;
  Estimate coverage50, coverage95;
  double start_error_rms_m = 0.0;
  double straight_line_rms_m = 0.0;
  double promised_rms_m = 0.0;  ///< by the filter's own covariance: what it believes of these outages
  struct Class {
    OutageClass outage_class = OutageClass::Straight;
    std::size_t count = 0;
    double rms_m = 0.0, nees = 0.0;
  };
  std::vector<Class> classes;
  ErrorGrowth growth;
};

/// A part of the drive in which the receiver itself gave no fix for longer than three of its intervals.
struct NaturalOutage {
  double start_s = 0.0, duration_s = 0.0;
};

/// Innovations of one kind over a run without outages.
struct InnovationSummary {
  MeasurementKind kind = MeasurementKind::Position;
  std::size_t count = 0;  ///< scalars
  double rms = 0.0;       ///< [m or m/s]
  double stated_rms = 0.0;
  double normalised = 0.0;  ///< mean normalised square: 1 where the model is right
  double correlation_next = 0.0, correlation_1s = 0.0, correlation_4s = 0.0;  ///< of normalised ones
};

struct DriveEvaluation {
  std::vector<Start> starts;  ///< one per run of readings that could be started
  std::vector<DurationSummary> durations;
  std::vector<NaturalOutage> natural;
  std::vector<InnovationSummary> innovations;
  std::size_t rejected = 0;
  std::optional<double> heading_known_s;
  std::vector<std::string> notes;
};

/// A model under test: everything that a filter needs for one drive, made once.
class PreparedDrive {
 public:
  /// Errors: those of find_start for a drive on which no run can be started, and of make_design.
  [[nodiscard]] static Result<PreparedDrive> make(const Drive& drive, const FilterOptions& options);

  [[nodiscard]] const Drive& drive() const { return *drive_; }
  [[nodiscard]] const FilterOptions& options() const { return options_; }
  [[nodiscard]] std::size_t parts() const { return parts_.size(); }
  [[nodiscard]] const Start& start(std::size_t part) const { return parts_[part].start; }
  [[nodiscard]] std::span<const ImuSample> readings(std::size_t part) const { return parts_[part].readings; }
  [[nodiscard]] const Vibration& vibration(std::size_t part) const { return parts_[part].vibration; }
  [[nodiscard]] FilterRun run(std::size_t part, const FilterTask& task) const;
  /// Runs of readings that cannot be started, each with the reason: no fix behind a gap shows the heading, say.
  struct NotStarted {
    std::size_t run = 0;
    std::string reason;
  };
  [[nodiscard]] const std::vector<NotStarted>& not_started() const { return not_started_; }

 private:
  struct Part {
    Start start;
    std::vector<ImuSample> readings;
    FilterDesign design;
    Vibration vibration;  ///< where the options know that noise follows it
  };
  const Drive* drive_ = nullptr;
  FilterOptions options_;
  std::vector<Part> parts_;
  std::vector<NotStarted> not_started_;
};

struct EvaluationOptions {
  std::uint64_t seed = 1;
  int resamples = 500;  ///< of the bootstrap
  bool innovations = true;
};

/// Errors: those of PreparedDrive::make; TooFewSamples where no outage of the plan fits the drive; Cancelled.
[[nodiscard]] Result<DriveEvaluation> evaluate_drive(const Drive& drive, const FilterOptions& options,
                                                     const EvaluationOptions& settings = {},
                                                     const RunControl& control = {});

/// Every outage of the plan under the prepared filter, in the order of duration, phase and time.
[[nodiscard]] std::vector<std::vector<DriveOutage>> scored_outages(const PreparedDrive& prepared,
                                                                   const RunControl& control);

/// Figures of one duration's outages. Not empty.
[[nodiscard]] DurationSummary summarise(std::vector<DriveOutage> outages, double duration_s, double period_s,
                                        const EvaluationOptions& settings);

/// Blocks of one period for a bootstrap: each holds the indices of the outages that start in it.
[[nodiscard]] std::vector<std::vector<std::size_t>> blocks_of(const std::vector<DriveOutage>& outages, double period_s);

/// With fewer blocks no interval is given.
inline constexpr std::size_t kLeastBlocks = 3;

/// From the 2.5 % to the 97.5 % quantile of resampled values. Not empty.
[[nodiscard]] Interval percentile_interval(std::vector<double> values);

/// Share of the outages whose error lies within the ellipse that the filter says holds `fraction` of them, with the
/// interval of resampled blocks.
[[nodiscard]] Estimate share_inside(const std::vector<DriveOutage>& outages,
                                    const std::vector<std::vector<std::size_t>>& blocks, double fraction,
                                    const EvaluationOptions& settings, std::uint64_t stream);

/// The 95 % percentile interval of a statistic of outages under resampled blocks.
[[nodiscard]] Interval bootstrap_interval(const std::vector<std::vector<std::size_t>>& blocks,
                                          const std::function<double(std::span<const std::size_t>)>& statistic,
                                          const EvaluationOptions& settings, std::uint64_t stream);

}  // namespace driftlab::drive
