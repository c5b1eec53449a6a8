#include "schema/json/recording_preview.hpp"

#include "schema/json/recording_spec.hpp"
#include "schema/json/stored_member.hpp"

namespace driftlab {
namespace {

Json column_json(const PreviewColumn& column) {
  Json document = role_json(column.name, column.role);
  document["from"] = name_of(column.from);
  document["first"] = numbers(column.first);
  document["course"] = numbers(column.course);
  return document;
}

Json problem_json(const Error& error) {
  Json fields = Json::object();
  for (const ErrorField& field : error.fields) {
    fields[field.name] = field.value;
  }
  return Json{{"code", name_of(error.code)}, {"detail", error.message}, {"fields", std::move(fields)}};
}

}  // namespace

Json to_json(const RecordingPreview& preview) {
  Json columns = Json::array();
  for (const PreviewColumn& column : preview.columns) {
    columns.push_back(column_json(column));
  }
  Json problems = Json::array();
  for (const Error& error : preview.problems) {
    problems.push_back(problem_json(error));
  }
  Json document{{"format", text_or_null(preview.head.format)},
                {"compression", name_of(preview.head.compression)},
                {"whole_file", preview.extent == HeadExtent::WholeFile},
                {"rows_seen", preview.head.rows()},
                {"columns", std::move(columns)},
                {"rate_hz", nullptr},
                {"time_guess", nullptr},
                {"condition_guess", nullptr},
                {"hints", preview.hints},
                {"problems", std::move(problems)},
                {"notes", preview.notes}};
  if (preview.rate_hz) {
    document["rate_hz"] =
        Json{{"value", number(*preview.rate_hz)}, {"from", preview.rate_is_stated ? "stated" : "time_column"}};
  }
  if (const auto& time = preview.time) {
    document["time_guess"] =
        Json{{"column", time->column}, {"unit", time->unit.symbol}, {"rate_hz", number(time->rate_hz)}};
  }
  if (const auto& guess = preview.condition) {
    document["condition_guess"] = Json{
        {"condition", to_json(guess->condition)}, {"text", to_text(guess->condition)}, {"because", guess->because}};
  }
  return document;
}

}  // namespace driftlab
