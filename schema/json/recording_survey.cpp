#include "schema/json/recording_survey.hpp"

#include "schema/json/measured_temperature.hpp"
#include "schema/json/quality.hpp"

#include <algorithm>

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

SurveyedChannel surveyed_channel_from_json(const Json& quality, const std::string& column) {
  SurveyedChannel found;
  const Json none = Json::array();
  const auto row_of = [](const Json& place) { return place.at("row").get<std::size_t>() - 1; };
  for (const Json& gap : quality.value("longest_gaps", none)) {
    found.longest_gaps.push_back({row_of(gap), gap.at("missing").get<std::size_t>()});
  }
  const Quality read = quality_from_json(quality);
  found.missing = read.missing;
  if (const ChannelQuality* const known = read.of(column); known != nullptr && known->frozen_from > 0) {
    found.frozen = {known->frozen_from - 1, known->frozen};
  }
  const Json channels = quality.value("channels", none);
  const auto own = std::find_if(channels.begin(), channels.end(),
                                [&](const Json& channel) { return channel.value("column", "") == column; });
  if (own == channels.end()) {
    return found;
  }
  for (const Json& wrong : own->value("implausible_at", none)) {
    found.implausible.push_back({row_of(wrong), wrong.at("samples").get<std::size_t>()});
  }
  if (const auto rails = own->find("rails"); rails != own->end() && rails->is_array()) {
    const auto value = [](const Json& rail) {
      return rail.is_number() ? std::optional(rail.get<double>()) : std::nullopt;
    };
    found.rails = {value(rails->at(0)), value(rails->at(1))};
  }
  return found;
}

}  // namespace driftlab
