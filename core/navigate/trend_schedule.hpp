#pragma once
/// A schedule that follows fitted relations: every parameter of a model as a continuous function of |rate|.
///
/// The relations are those of a parameter table's trends: constant, linear or power, over |rate| in rad/s. Beyond the
/// largest measured rate the value of that rate holds. Values are kept within the declared bounds of their parameter,
/// so that a falling line never becomes a negative level.
#include "core/navigate/model_schedule.hpp"

#include <cstddef>
#include <functional>

namespace driftlab {

/// A parameter of the model: process, parameter within it, and how it moves.
struct ParameterTrend {
  std::size_t process = 0;
  std::size_t parameter = 0;
  std::function<double(double rate_rad_s)> value;  ///< in SI, at a |rate| from 0 to `last_rad_s`
  double last_rad_s = 0.0;                         ///< the largest measured |rate|
};

/// `base` where no trend is given for a parameter. Tabulated in bands of `step_rad_s` up to the largest rate of the
/// trends. Errors: InvalidArgument (a trend of a parameter that the model does not have, and as
/// ModelSchedule::interpolated).
[[nodiscard]] Result<ModelSchedule> schedule_along(const Model& base, const std::vector<ParameterTrend>& trends,
                                                   double step_rad_s);

}  // namespace driftlab
