#include "schema/json/measured_temperature.hpp"

namespace driftlab {

Json to_json(const MeasuredTemperature& temperature) {
  return Json{{"column", temperature.column},
              {"median_degc", number(temperature.median_degc)},
              {"low_degc", number(temperature.low_degc)},
              {"high_degc", number(temperature.high_degc)}};
}

}  // namespace driftlab
