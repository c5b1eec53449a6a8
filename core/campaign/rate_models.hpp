#pragma once
/// A gyroscope's error model at each measured rate, out of a parameter table.
///
/// The table's static row and those at a constant rate take part; rows of one |rate| are averaged on the log scale.
/// Method gmwm gives the processes of the table's model, method av white noise by N (the other coefficients of the
/// Allan deviation describe a shape, not a process). A row that does not identify every parameter is left out. Beside
/// the models stand the relations of the parameters to the rate (core/campaign/trend_table.hpp), for a model between
/// and beyond the measured rates.
#include "core/campaign/parameter_table.hpp"
#include "core/campaign/trends.hpp"
#include "core/process/model.hpp"

#include <cstddef>
#include <vector>

namespace driftlab {

/// How one parameter of the model moves with the rate.
struct RateRelation {
  std::size_t process = 0;    ///< of the model
  std::size_t parameter = 0;  ///< of the process
  FittedRelation relation;    ///< value in SI against |rate| in rad/s
};

struct RateModels {
  std::vector<double> rates_rad_s;      ///< rising, from 0 where there is a static row
  std::vector<Model> models;            ///< one per rate; parameters in SI
  std::vector<RateRelation> relations;  ///< of those parameters that are known at two rates
};

/// Error: InvalidArgument (a table that is not a gyroscope's; no row that identifies every parameter).
[[nodiscard]] Result<RateModels> models_by_rate(const ParameterTable& table);

}  // namespace driftlab
