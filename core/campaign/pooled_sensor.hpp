#pragma once
/// One sensor axis of one device over all its recordings: replicates fitted jointly, their agreement, and whether one
/// structure serves every condition (core/campaign/replicates.hpp, core/campaign/structure.hpp).
///
/// Made from reported channels alone: their wavelet variances, sample counts and intervals are all that a joint fit
/// needs. Recordings of one condition are replicates. A recording whose gross errors move the variances takes part with
/// its robust variances, and the condition is marked `robust`. Where a condition has one clean recording its own fits
/// are taken over.
///
/// What cannot be put together is data, not an error: the result then says why in `reason`, for the whole axis where
/// its channels are in units that do not convert into each other, for one condition where a recording has too few
/// variances for a joint fit.
#include "core/campaign/sensor_sources.hpp"
#include "core/signal/progress.hpp"
#include "core/signal/result.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace driftlab {

/// Do the recordings of a condition share their parameters? A test's statistic, chi-square of `dof` under agreement.
struct RecordingAgreement {
  std::string model;  ///< of the joint fit; empty for a test over averaged parameters
  double statistic = 0.0;
  double dof = 0.0;
  double p = 1.0;

  /// At 5 %.
  [[nodiscard]] bool agree() const { return p >= 0.05; }
};

struct PooledCondition {
  Condition condition;
  std::string key;                      ///< the condition in one word
  std::vector<std::string> recordings;  ///< in the order in which they came
  std::vector<std::string> members;     ///< of what it was made (TableSource::member_id), sorted
  std::string contamination;            ///< worst verdict of the recordings; empty where none has one
  bool robust = false;
  std::optional<RecordingAgreement> agreement;  ///< of the common best model; empty where there are none to compare
  /// Ordered by criterion. `intervals` of each: `profile` for the condition's best model and the common one,
  /// `sandwich` for the others.
  std::vector<ReportedFit> fits;
  std::string reason;  ///< why there is no joint fit; empty: there is one
};

struct RankedStructure {
  std::string model;
  double criterion = 0.0;  ///< summed over the conditions; not finite where one lacks it
};

struct ConditionStructure {
  std::string label;  ///< of the condition
  std::string model;  ///< the best in it
};

/// Whether one structure serves every condition: a StructureChoice (core/campaign/structure.hpp) by names.
struct PooledStructure {
  std::string verdict;  ///< `one_structure`, `changes`, `undecided`
  std::string statement;
  double p = 1.0;
  double statistic = 0.0;
  double dof = 0.0;
  std::string common;
  double excess = 0.0;
  std::vector<RankedStructure> ranking;  ///< best first
  std::vector<ConditionStructure> by_condition;
};

struct PooledSensor {
  std::string quantity;
  std::string axis;                          ///< empty where the channels have none
  std::string channel;                       ///< column name in the first recording
  std::string sensor_axis;                   ///< within a campaign of several axes: SensorSources::axis; else empty
  std::string model;                         ///< the common best; empty where there is none
  std::optional<PooledStructure> structure;  ///< empty where no model was fitted to every recording
  std::vector<PooledCondition> conditions;   ///< in table order
  std::string reason;                        ///< why nothing could be put together; empty: it could
};

/// `previous`: other results of the same axis; conditions with the same members are taken from them. Progress: a stage
/// per condition. Cost: a joint fit grows in proportion to its recordings (core/process/block_diagonal.hpp), and two
/// sets of profile intervals are computed per condition. Errors: Cancelled, polled between models; InvalidArgument (no
/// sources; a channel whose variances do not have the shape they state).
[[nodiscard]] Result<PooledSensor> pool_sensor(const std::vector<TableSource>& sources,
                                               std::span<const PooledSensor> previous, const RunControl& control);

/// The condition's entry if it was made of exactly these members, given in any order; else nullptr. `pooled` may be
/// nullptr.
[[nodiscard]] const PooledCondition* find_pooled(const PooledSensor* pooled, const std::string& condition,
                                                 std::vector<std::string> members);

}  // namespace driftlab
