#include "schema/json/recording_spec.hpp"

#include "core/signal/column_unit.hpp"
#include "core/signal/text.hpp"
#include "schema/json/recording_tags.hpp"

namespace driftlab {
namespace {

Json to_json(const ColumnRole& role) {
  Json document{{"quantity", name_of(role.quantity)}};
  if (!role.axis.empty()) {
    document["axis"] = role.axis;
  }
  if (role.unit) {
    document["unit"] = role.unit->symbol;
  }
  return document;
}

ColumnRole role_from_json(const std::string& column, const Json& document, const std::string& pointer, Faults& faults) {
  ColumnRole role;
  ObjectReader reader(document, pointer, faults);
  const std::string quantity = reader.required_text("quantity");
  bool sound = document.is_object() && !quantity.empty();
  if (sound) {
    if (auto parsed = parse_quantity(quantity)) {
      role.quantity = *parsed;
    } else {
      faults.add(reader.pointer("quantity"), parsed.error());
      sound = false;
    }
  }
  role.axis = reader.text("axis").value_or("");
  if (const auto unit = reader.text("unit")) {
    if (auto parsed = parse_unit(*unit, role.quantity)) {
      role.unit = *parsed;
    } else {
      faults.add(reader.pointer("unit"), parsed.error());
      sound = false;
    }
  }
  for (const char* const member : {"scale", "offset"}) {
    if (reader.member(member) != nullptr) {
      faults.add(
          reader.pointer(member), ErrorCode::InvalidArgument,
          "A scale and an offset stand with the unit: {\"unit\": \"deg/s/131\"}, {\"unit\": \"degC/340+36.53\"}.");
    }
  }
  reader.reject_unknown();
  if (sound) {
    if (auto checked = check_role(column, role); !checked) {
      faults.add(pointer, checked.error());
    }
  }
  return role;
}

}  // namespace

Json to_json(const Condition& condition) {
  Json document{{"kind", name_of(condition.kind)}};
  if (!condition.axis.empty()) {
    document["axis"] = condition.axis;
  }
  if (const auto value = written_value(condition)) {
    document["value"] = *value;
    document["unit"] = condition.unit;
  }
  if (condition.up) {
    document["direction"] = *condition.up ? "up" : "down";
  }
  if (condition.heading_deg) {
    document["heading_deg"] = *condition.heading_deg;
  }
  return document;
}

Condition condition_from_json(const Json& document, const std::string& pointer, Faults& faults) {
  if (document.is_string()) {
    faults.add(pointer, ErrorCode::InvalidArgument,
               "In a document a condition is an object, for example {\"kind\": \"static\"}.");
    return {};
  }
  ObjectReader reader(document, pointer, faults);
  WrittenCondition written;
  written.kind = reader.required_text("kind");
  written.axis = reader.text("axis");
  written.value = reader.real("value");
  written.unit = reader.text("unit");
  written.direction = reader.text("direction");
  written.heading_deg = reader.real("heading_deg");
  reader.reject_unknown();
  if (written.kind.empty()) {
    return {};
  }
  auto condition = make_condition(written);
  if (!condition) {
    std::string where = pointer;
    for (const ErrorField& field : condition.error().fields) {
      if (field.name == "parameter") {
        where = reader.pointer(field.value);
      } else if (field.name == "condition") {
        where = reader.pointer("kind");
      } else if (field.name == "unit") {
        where = reader.pointer("unit");
      }
    }
    faults.add(where, condition.error());
    return {};
  }
  return *condition;
}

Json to_json(const RecordingSpec& spec) {
  Json document = Json::object();
  if (!spec.id.empty()) {
    document["id"] = spec.id;
  }
  if (spec.rate_hz) {
    document["rate_hz"] = *spec.rate_hz;
  }
  if (!spec.columns.empty()) {
    Json columns = Json::object();
    for (const auto& [name, role] : spec.columns) {
      columns[name] = to_json(role);
    }
    document["columns"] = std::move(columns);
  }
  if (!spec.stream.empty()) {
    document["stream"] = spec.stream;
  }
  document["condition"] = to_json(spec.condition);
  if (spec.trim.start_s != 0.0 || spec.trim.end_s != 0.0) {
    document["trim"] = Json{{"start_s", spec.trim.start_s}, {"end_s", spec.trim.end_s}};
  }
  if (!spec.calibration.empty()) {
    document["calibration"] = spec.calibration;
  }
  return document;
}

RecordingSpec recording_spec_from_json(const Json& document, const std::string& pointer, Faults& faults,
                                       FileMember file) {
  RecordingSpec spec;
  ObjectReader reader(document, pointer, faults);
  spec.id = reader.text("id").value_or("");
  if (file == FileMember::Ignored) {
    (void)reader.member("file");
  }
  spec.rate_hz = reader.real("rate_hz");
  if (spec.rate_hz && !is_sampling_rate(*spec.rate_hz)) {
    faults.add(reader.pointer("rate_hz"), ErrorCode::InvalidArgument, "The rate_hz must be from 1e-6 to 1e9.");
  }
  if (const Json* const columns = reader.member("columns")) {
    if (!columns->is_object()) {
      faults.add(reader.pointer("columns"), ErrorCode::ParseError,
                 "The columns must be an object keyed by column name.");
    } else {
      for (const auto& [name, role] : columns->items()) {
        const ObjectReader at(*columns, reader.pointer("columns"), faults);
        spec.columns[name] = role_from_json(name, role, at.pointer(name), faults);
      }
    }
  }
  spec.stream = reader.text("stream").value_or("");
  if (const Json* const condition = reader.member("condition")) {
    spec.condition = condition_from_json(*condition, reader.pointer("condition"), faults);
  } else if (document.is_object()) {
    faults.add(reader.pointer("condition"), ErrorCode::InvalidArgument,
               "The dynamic condition of the recording is missing, for example {\"kind\": \"static\"}.");
  }
  if (const Json* const trim = reader.member("trim")) {
    ObjectReader ends(*trim, reader.pointer("trim"), faults);
    spec.trim.start_s = ends.real("start_s").value_or(0.0);
    spec.trim.end_s = ends.real("end_s").value_or(0.0);
    ends.reject_unknown();
    if (!(spec.trim.start_s >= 0.0) || !(spec.trim.end_s >= 0.0)) {
      faults.add(reader.pointer("trim"), ErrorCode::InvalidArgument, "A trim must not be negative.");
    }
  }
  spec.calibration = reader.text("calibration").value_or("");
  for (const char* const tag : {"labels", "session", "recorded_at"}) {
    (void)reader.member(tag);
  }
  (void)recording_tags_from_json(document, pointer, faults);
  reader.reject_unknown();
  return spec;
}

Result<std::map<std::string, ColumnRole>> parse_columns(std::string_view text) {
  std::map<std::string, ColumnRole> columns;
  for (const std::string_view entry : split(text, ',')) {
    const std::size_t equals = entry.find('=');
    if (entry.empty() || equals == std::string_view::npos || equals == 0) {
      return fail(ErrorCode::InvalidArgument,
                  "Columns are written NAME=QUANTITY[:AXIS[:UNIT]] with commas between them, for example "
                  "gz=angular_rate:z:deg/s; '" +
                      std::string(entry) + "' is not.",
                  {{"parameter", "columns"}});
    }
    const std::string name(entry.substr(0, equals));
    const std::vector<std::string_view> parts = split(entry.substr(equals + 1), ':');
    ColumnRole role;
    auto named = [&](Error error) { return fail(std::move(error).with("column", name)); };
    if (parts.size() > 3) {
      return named({ErrorCode::InvalidArgument, "The column '" + name + "' has too many parts.", {}});
    }
    auto quantity = parse_quantity(parts[0]);
    if (!quantity) {
      return named(quantity.error());
    }
    role.quantity = *quantity;
    role.axis = parts.size() > 1 ? parts[1] : std::string_view{};
    // What has no axis may have its unit at once: time:s as well as time::s.
    const bool unit_at_once = parts.size() == 2 && !role.axis.empty() && !check_role(name, role) &&
                              check_role(name, ColumnRole{role.quantity, "", {}}).has_value();
    if (unit_at_once) {
      role.axis.clear();
    }
    if (parts.size() > 2 || unit_at_once) {
      auto unit = parse_unit(parts.back(), role.quantity);
      if (!unit) {
        return named(unit.error());
      }
      role.unit = *unit;
    }
    if (auto checked = check_role(name, role); !checked) {
      return fail(checked.error());
    }
    if (!columns.emplace(name, role).second) {
      return fail(ErrorCode::DuplicateColumn, "The column '" + name + "' is given twice.", {{"column", name}});
    }
  }
  return columns;
}

Json role_json(const std::string& name, const std::optional<ColumnRole>& role) {
  Json document{{"name", name}, {"quantity", nullptr}, {"axis", nullptr}, {"unit", nullptr}};
  if (role) {
    document["quantity"] = name_of(role->quantity);
    document["axis"] = role->axis.empty() ? Json(nullptr) : Json(role->axis);
    document["unit"] = role->unit ? Json(role->unit->symbol) : Json(nullptr);
  }
  return document;
}

}  // namespace driftlab
