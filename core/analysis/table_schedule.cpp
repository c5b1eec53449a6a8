#include "core/analysis/table_schedule.hpp"

#include "core/campaign/rate_models.hpp"
#include "core/navigate/trend_schedule.hpp"

namespace driftlab {

Result<ModelSchedule> schedule_from_table(const ParameterTable& table, const TableScheduleOptions& options) {
  const auto known = models_by_rate(table);
  if (!known) {
    return fail(known.error());
  }
  if (options.continuous) {
    std::vector<ParameterTrend> trends;
    for (const RateRelation& one : known->relations) {
      trends.push_back({one.process, one.parameter, one.relation, one.relation.scale});
    }
    return schedule_along(known->models.front(), trends, options.step_rad_s);
  }
  std::vector<double> bounds;
  for (std::size_t k = 1; k < known->rates_rad_s.size(); ++k) {
    bounds.push_back(0.5 * (known->rates_rad_s[k - 1] + known->rates_rad_s[k]));
  }
  return ModelSchedule::by_rate(bounds, known->models, options.hysteresis_rad_s);
}

}  // namespace driftlab
