#pragma once
/// The recordings of one sensor axis that are put together: who takes part, and in which order conditions are shown.
#include "core/campaign/reported_channel.hpp"
#include "core/signal/condition.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// One channel of one recording that takes part.
struct TableSource {
  std::string recording_id;
  std::string condition;  ///< compact text form (core/signal/condition.hpp)
  ReportedChannel channel;
  std::string result_id = {};  ///< of the stored result; empty outside a store
  std::size_t frozen = 0;      ///< samples of the channel left out because the sensor gave one value only

  /// Under which it counts as a member of what is computed together: the result, or else the recording.
  [[nodiscard]] const std::string& member_id() const { return result_id.empty() ? recording_id : result_id; }
};

/// The sources of one sensor axis.
struct SensorSources {
  std::string quantity;
  std::string axis;  ///< or the column name of a channel that nobody named by axis
  std::vector<TableSource> sources;
};

/// Puts a source to those of its sensor axis, which is added where it is not there yet. Channels that nobody named by
/// axis stand each for themselves, under their column name.
void add_source(std::vector<SensorSources>& sensors, TableSource source);

/// Why the channels cannot be put together: a sentence that names two units which do not convert into each other. Empty
/// where all units are of one dimension.
[[nodiscard]] std::string unit_conflict(const std::vector<TableSource>& sources);

/// The worse of two verdicts on contamination: contaminated before undecided before clean before none (empty).
[[nodiscard]] const std::string& worse_verdict(const std::string& a, const std::string& b);

/// Order of conditions in tables: static first, then by kind, axis and value. Complete: of two different conditions
/// exactly one comes before the other.
[[nodiscard]] bool comes_before(const Condition& a, const Condition& b);

}  // namespace driftlab
