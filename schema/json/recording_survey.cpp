#include "schema/json/recording_survey.hpp"

#include "schema/json/measured_temperature.hpp"
#include "schema/json/recording_spec.hpp"

namespace driftlab {

Json to_json(const RecordingSurvey& survey) {
  Json document = to_json(survey.quality);
  if (survey.temperature) {
    document["temperature"] = to_json(*survey.temperature);
  }
  for (const Gap& gap : survey.longest_gaps) {
    document["longest_gaps"].push_back(Json{{"row", gap.row + 1}, {"missing", gap.missing}});
  }
  const auto or_null = [](const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); };
  for (std::size_t i = 0; i < survey.marks.size(); ++i) {
    const ChannelMarks& marks = survey.marks[i];
    Json& channel = document["channels"][i];
    if (marks.rails) {
      channel["rails"] = Json::array({or_null(marks.rails->low), or_null(marks.rails->high)});
    }
    for (const SampleStretch& stretch : marks.implausible) {
      channel["implausible_at"].push_back(Json{{"row", stretch.row + 1}, {"samples", stretch.samples}});
    }
  }
  return document;
}

}  // namespace driftlab
