#include "schema/json/calibration.hpp"

#include <algorithm>

namespace driftlab {
namespace {

Json row_json(const Triple& row) { return Json{number(row[0]), number(row[1]), number(row[2])}; }

Json to_json(const SensorCalibration& calibration) {
  return Json{{"reading_unit", calibration.reading.symbol},
              {"bias", row_json(calibration.bias)},
              {"correction", Json{row_json(calibration.correction[0]), row_json(calibration.correction[1]),
                                  row_json(calibration.correction[2])}}};
}

/// Three numbers of an array; a fault otherwise.
Triple triple_from_json(const Json* document, const std::string& pointer, Faults& faults) {
  Triple triple{};
  const bool three = document != nullptr && document->is_array() && document->size() == 3 &&
                     std::all_of(document->begin(), document->end(), [](const Json& one) { return one.is_number(); });
  if (!three) {
    faults.add(pointer, ErrorCode::ParseError, "Three numbers belong here, for the axes x, y and z.");
    return triple;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    triple[i] = (*document)[i].get<double>();
  }
  return triple;
}

std::optional<SensorCalibration> sensor_from_json(const Json& sensor, const std::string& pointer, Faults& faults) {
  const auto apply = sensor.is_object() ? sensor.find("apply") : sensor.end();
  if (!sensor.is_object() || apply == sensor.end()) {
    faults.add(pointer + "/apply", ErrorCode::ParseError, "The calibration of a sensor has a member 'apply'.");
    return std::nullopt;
  }
  ObjectReader reader(*apply, pointer + "/apply", faults);
  SensorCalibration calibration;
  if (const std::string symbol = reader.required_text("reading_unit"); !symbol.empty()) {
    if (auto unit = parse_unit(symbol)) {
      calibration.reading = *unit;
    } else {
      faults.add(reader.pointer("reading_unit"), unit.error());
    }
  }
  calibration.bias = triple_from_json(reader.member("bias"), reader.pointer("bias"), faults);
  const Json* const rows = reader.member("correction");
  for (std::size_t i = 0; i < 3; ++i) {
    const bool there = rows != nullptr && rows->is_array() && rows->size() == 3;
    calibration.correction[i] =
        triple_from_json(there ? &(*rows)[i] : nullptr, reader.pointer("correction") + "/" + std::to_string(i), faults);
  }
  reader.reject_unknown();
  return calibration;
}

/// By pair of axes, those that were estimated.
void add_misalignment(const AxisAngles& angles, Json& document) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (const auto& angle = angles[i][j]) {
        document["misalignment"][std::string(1, "xyz"[i]) + "xyz"[j]] = quantity(*angle, 1e3, "mrad");
      }
    }
  }
}

}  // namespace

Json to_json(const TriadCalibration& calibration, const Unit& si) {
  const std::string& unit = si.symbol;
  Json document;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    document["bias"][axis] = quantity(calibration.bias[i], 1.0, unit);
    document["scale_factor"][axis] = quantity(calibration.scale_factor[i], 1e6, "ppm");
  }
  add_misalignment(calibration.misalignment, document);
  document["matrix"] = Json{row_json(calibration.law.matrix[0]), row_json(calibration.law.matrix[1]),
                            row_json(calibration.law.matrix[2])};
  document["readings"] = calibration.readings;
  document["chi_square_per_dof"] = number(calibration.chi_square_per_dof);
  document["residual_rms"] = Json{
      {"before", number(calibration.residual_before)}, {"after", number(calibration.residual_after)}, {"unit", unit}};
  document["apply"] = to_json(to_apply(calibration, si));
  return document;
}

Json to_json(const MultiPositionCalibration& calibration, const Unit& reading) {
  Json document;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    document["bias"][axis] = quantity(calibration.bias[i], 1.0, "1");
    for (std::size_t j = i; j < 3; ++j) {
      document["correction"][axis + "xyz"[j]] = quantity(calibration.correction[i][j], 1.0, "m/s^2");
    }
  }
  add_misalignment(calibration.misalignment(), document);
  document["positions"] = calibration.positions;
  document["converged"] = calibration.converged;
  document["condition_number"] = number(calibration.condition);
  document["residual_rms"] = Json{{"before", number(calibration.residual_before)},
                                  {"after", number(calibration.residual_after)},
                                  {"unit", "m/s^2"}};
  document["warnings"] = calibration.warnings;
  document["apply"] = to_json(to_apply(calibration, reading));
  return document;
}

Json to_json(const CalibrationReport& report) {
  Json document = Json::object();
  if (report.rests) {
    document["accelerometer"] = to_json(report.rests->found, report.rests->reading);
  }
  if (report.accelerometer) {
    document["accelerometer"] = to_json(report.accelerometer->found, *parse_unit("m/s^2"));
  }
  if (report.gyroscope) {
    document["gyroscope"] = to_json(report.gyroscope->found, *parse_unit("rad/s"));
  }
  document["notes"] = report.notes;
  return document;
}

Calibration calibration_from_json(const Json& document, const std::string& pointer, Faults& faults) {
  Calibration calibration;
  if (!document.is_object() || !(document.contains("accelerometer") || document.contains("gyroscope"))) {
    faults.add(pointer, ErrorCode::ParseError,
               "A calibration is an object with an accelerometer or a gyroscope, as `driftlab calibrate --json` prints "
               "it.");
    return calibration;
  }
  if (const auto sensor = document.find("accelerometer"); sensor != document.end()) {
    calibration.accelerometer = sensor_from_json(*sensor, pointer + "/accelerometer", faults);
  }
  if (const auto sensor = document.find("gyroscope"); sensor != document.end()) {
    calibration.gyroscope = sensor_from_json(*sensor, pointer + "/gyroscope", faults);
  }
  return calibration;
}

}  // namespace driftlab
