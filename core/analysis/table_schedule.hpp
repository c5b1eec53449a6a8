#pragma once
/// A schedule of a gyroscope's error models by the rate, out of a parameter table (core/campaign/rate_models.hpp), as a
/// filter follows it.
///   switched     the model of the nearest measured |rate|, bounds half-way between (Table 5 of the seed paper), with
///                hysteresis;
///   continuous   every parameter along its trend (core/campaign/trends.hpp), or constant at its value at the smallest
///                measured |rate| where the table has none.
#include "core/campaign/parameter_table.hpp"
#include "core/navigate/model_schedule.hpp"

namespace driftlab {

struct TableScheduleOptions {
  bool continuous = false;
  double hysteresis_rad_s = 0.0;
  double step_rad_s = 0.0175;  ///< of a continuous schedule
};

/// Errors: those of models_by_rate, ModelSchedule::by_rate and schedule_along.
[[nodiscard]] Result<ModelSchedule> schedule_from_table(const ParameterTable& table,
                                                        const TableScheduleOptions& options);

}  // namespace driftlab
