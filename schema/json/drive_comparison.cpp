#include "schema/json/drive_comparison.hpp"

#include "schema/json/drive.hpp"

namespace driftlab {

Json to_json(const DriveComparisonReport& report) {
  Json filters = Json::array();
  for (const drive::ComparedFilter& filter : report.comparison.filters) {
    Json durations = Json::array();
    for (const drive::DurationSummary& d : filter.durations) {
      durations.push_back(to_json(d, report.drive));
    }
    filters.push_back(Json{
        {"name", filter.name},
        {"about", filter.about},
        {"noise_factor", {{"gyroscope", number(filter.gyro_noise)}, {"accelerometer", number(filter.force_noise)}}},
        {"durations", std::move(durations)}});
  }
  Json differences = Json::array();
  for (const drive::FilterDifference& pair : report.comparison.differences) {
    differences.push_back(Json{{"duration_s", number(pair.duration_s)},
                               {"n", pair.count},
                               {"filter", pair.filter},
                               {"against", pair.against},
                               {"difference_m", estimate_to_json(pair.difference_m)},
                               {"relative", estimate_to_json(pair.relative)},
                               {"shown", pair.shown()}});
  }
  Json options = options_to_json(report.options);
  options["fit_noise"] = report.fit_noise;
  return Json{{"id", report.drive.document.id},
              {"vehicle", name_of(report.drive.document.vehicle)},
              {"summary", sentence_of(report)},
              {"algorithm_version", drive::kDriveAlgorithmVersion},
              {"options", std::move(options)},
              {"facts", facts_to_json(report.drive)},
              {"verdicts", drive::verdicts_of(report.comparison)},
              {"filters", std::move(filters)},
              {"differences", std::move(differences)},
              {"notes", report.comparison.notes}};
}

}  // namespace driftlab
