#include "core/navigate/trend_schedule.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {

Result<ModelSchedule> schedule_along(const Model& base, const std::vector<ParameterTrend>& trends, double step_rad_s) {
  double span = 0.0;
  for (const ParameterTrend& trend : trends) {
    if (trend.process >= base.size() || trend.parameter >= base[trend.process].parameters.size()) {
      return fail(ErrorCode::InvalidArgument, "A trend belongs to no parameter of the model.",
                  {{"parameter", "trends"}});
    }
    span = std::max(span, trend.last_rad_s);
  }
  if (!(step_rad_s > 0.0) || !(span / step_rad_s < 4000.0)) {
    return fail(ErrorCode::InvalidArgument, "A trend is tabulated in at most 4000 steps.", {{"parameter", "step"}});
  }
  std::vector<double> rates;
  std::vector<Model> models;
  const auto bands = static_cast<std::size_t>(std::ceil(span / step_rad_s)) + 1;
  for (std::size_t band = 0; band < bands; ++band) {
    const double rate = std::min(static_cast<double>(band) * step_rad_s, span);
    Model model = base;
    for (const ParameterTrend& trend : trends) {
      Process& process = model[trend.process];
      const ParameterSpec& spec = process.kind->parameters[trend.parameter];
      const double value = trend.value(std::min(rate, trend.last_rad_s));
      process.parameters[trend.parameter] = std::clamp(value, spec.lower, spec.upper);
    }
    rates.push_back(rate);
    models.push_back(std::move(model));
  }
  return ModelSchedule::interpolated(rates, models, step_rad_s);
}

}  // namespace driftlab
