#pragma once
/// A gyroscope's error model by the rate, out of a parameter table (schema/json/parameter_table.hpp).
///
/// Rows: the static one and those at a constant rate; rows of one |rate| are averaged on the log scale. Method gmwm
/// gives the processes of the table's model, method av white noise by N. A row that does not identify every parameter
/// is left out.
///   switched     the model of the nearest measured |rate|, bounds half-way between (Table 5 of the seed paper), with
///                hysteresis;
///   continuous   every parameter along its trend (core/fit/trends.hpp), or constant at its static value where the
///   table
///                has none.
#include "core/navigate/model_schedule.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

struct TableScheduleOptions {
  bool continuous = false;
  double hysteresis_rad_s = 0.0;
  double step_rad_s = 0.0175;  ///< of a continuous schedule
};

/// Faults are added at `pointer`; the result is then unspecified.
[[nodiscard]] ModelSchedule schedule_from_table(const Json& table, const TableScheduleOptions& options,
                                                const std::string& pointer, Faults& faults);

}  // namespace driftlab
