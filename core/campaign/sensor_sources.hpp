#pragma once
/// The recordings that tables and joint fits combine, grouped by sensor axis, and the order in which their conditions
/// are shown.
#include "core/campaign/reported_channel.hpp"
#include "core/signal/condition.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// One channel of one recording, with its stored result.
struct TableSource {
  std::string recording_id;
  std::string condition;  ///< compact text form (core/signal/condition.hpp)
  ReportedChannel channel;
  std::string result_id = {};  ///< of the stored result; empty outside a store
  std::size_t frozen = 0;      ///< samples of the channel left out because the sensor gave one value only

  /// The id by which a joint result names this member: that of the stored result if there is one, else that of the
  /// recording.
  [[nodiscard]] const std::string& member_id() const { return result_id.empty() ? recording_id : result_id; }
};

/// The sources of one sensor axis.
struct SensorSources {
  std::string quantity;
  std::string axis;  ///< the column name if the channel has no stated axis
  std::vector<TableSource> sources;
};

/// Adds a source to the list of its sensor axis, and the axis if it is new. A channel without a stated axis is an axis
/// of its own, under its column name.
void add_source(std::vector<SensorSources>& sensors, TableSource source);

/// Why the channels cannot be combined: a sentence that names two units which do not convert into each other. Empty if
/// all units have one dimension.
[[nodiscard]] std::string unit_conflict(const std::vector<TableSource>& sources);

/// The worse of two verdicts on contamination: contaminated before undecided before clean before none (empty).
[[nodiscard]] const std::string& worse_verdict(const std::string& a, const std::string& b);

/// Order of conditions in tables: static first, then by kind, axis and value. The order is total: of two different
/// conditions exactly one comes before the other.
[[nodiscard]] bool comes_before(const Condition& a, const Condition& b);

}  // namespace driftlab
