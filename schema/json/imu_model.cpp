#include "schema/json/imu_model.hpp"

#include "core/signal/angle.hpp"
#include "schema/json/error_model.hpp"

#include <algorithm>

namespace driftlab {
namespace {

constexpr double kMilliG = 1e-3 * kStandardGravity;
constexpr std::array kAxes{"x", "y", "z"};

Dimension dimension_of(std::size_t first) { return first == 0 ? Dimension::AngularRate : Dimension::SpecificForce; }

/// A list of finite numbers times `factor`.
std::vector<double> numbers_from(const Json* list, const std::string& pointer, double factor, Faults& faults) {
  std::vector<double> values;
  if (list == nullptr || !list->is_array() || list->size() > 4096) {
    faults.add(pointer, ErrorCode::InvalidArgument, "A list of numbers belongs here.");
    return values;
  }
  for (const Json& value : *list) {
    if (!value.is_number()) {
      faults.add(pointer, ErrorCode::InvalidArgument, "A list of numbers belongs here.");
      return {};
    }
    values.push_back(value.get<double>() * factor);
  }
  return values;
}

std::vector<Model> models_from(const Json* list, Dimension dimension, const std::string& pointer, Faults& faults) {
  std::vector<Model> models;
  if (list == nullptr || !list->is_array() || list->size() > 4096) {
    faults.add(pointer, ErrorCode::InvalidArgument, "A list of models belongs here, each a list of processes.");
    return models;
  }
  for (std::size_t i = 0; i < list->size(); ++i) {
    std::string where = pointer;
    where.append("/").append(std::to_string(i));
    models.push_back(model_from_json((*list)[i], dimension, where, faults));
  }
  return models;
}

void set_schedule(Result<ModelSchedule> made, const std::string& pointer, AxisModel& axis, Faults& faults) {
  if (made) {
    axis.processes = std::move(*made);
  } else {
    faults.add(pointer, made.error());
  }
}

void read_by_rate(const Json& document, const std::string& pointer, AxisModel& axis, Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  auto bounds = numbers_from(reader.member("bounds_deg_s"), pointer + "/bounds_deg_s", kDegree, faults);
  auto models = models_from(reader.member("processes"), Dimension::AngularRate, pointer + "/processes", faults);
  const double hysteresis = reader.real("hysteresis_deg_s").value_or(0.0) * kDegree;
  reader.reject_unknown();
  if (faults.none()) {
    set_schedule(ModelSchedule::by_rate(std::move(bounds), std::move(models), hysteresis), pointer, axis, faults);
  }
}

void read_trend(const Json& document, const std::string& pointer, AxisModel& axis, Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  const auto rates = numbers_from(reader.member("rates_deg_s"), pointer + "/rates_deg_s", kDegree, faults);
  const auto models = models_from(reader.member("processes"), Dimension::AngularRate, pointer + "/processes", faults);
  const double step = reader.real("step_deg_s").value_or(0.25) * kDegree;
  reader.reject_unknown();
  if (faults.none()) {
    set_schedule(ModelSchedule::interpolated(rates, models, step), pointer, axis, faults);
  }
}

/// Accelerometers in the words of lab data sheets.
void add_lab_members(ObjectReader& reader, const std::string& pointer, Model& model, Faults& faults) {
  const auto add = [&](std::string_view name, std::vector<double> values) {
    auto process = make_process(name, std::move(values));
    if (process) {
      model.push_back(std::move(*process));
    } else {
      faults.add(pointer, process.error());
    }
  };
  if (const auto white = reader.real("white_noise_mg_per_sqrt_hz")) {
    add("white_noise", {*white * kMilliG});
  }
  if (const Json* const in_run = reader.member("in_run")) {
    ObjectReader inner(*in_run, pointer + "/in_run", faults);
    const std::string process = inner.required_text("process");
    const double sigma = inner.real("sigma_mg").value_or(0.0) * kMilliG;
    const double tau = inner.real("tau_s").value_or(0.0);
    inner.reject_unknown();
    if (process != "gauss_markov" || !(tau > 0.0)) {
      faults.add(pointer + "/in_run", ErrorCode::InvalidArgument,
                 "The in-run error is a gauss_markov with tau_s above 0.");
    } else {
      add("gauss_markov", {sigma, 1.0 / tau});
    }
  }
}

AxisModel read_axis(const Json& document, std::size_t first, const std::string& pointer, Faults& faults) {
  AxisModel axis;
  ObjectReader reader(document, pointer, faults);
  Model model;
  if (const Json* const processes = reader.member("processes")) {
    model = model_from_json(*processes, dimension_of(first), pointer + "/processes", faults);
  }
  if (first == 0) {
    axis.bias_sd = reader.real("constant_bias_sd_deg_s").value_or(0.0) * kDegree;
  } else {
    axis.bias_sd = reader.real("constant_bias_sd_mg").value_or(0.0) * kMilliG;
    add_lab_members(reader, pointer, model, faults);
  }
  axis.processes = ModelSchedule::constant(std::move(model));
  const Json* const by_rate = first == 0 ? reader.member("by_rate") : nullptr;
  const Json* const trend = first == 0 ? reader.member("trend") : nullptr;
  reader.reject_unknown();
  const Json* const schedule = by_rate != nullptr ? by_rate : trend;
  if (schedule != nullptr && (document.contains("processes") || (by_rate != nullptr && trend != nullptr))) {
    faults.add(pointer + (by_rate != nullptr ? "/by_rate" : "/trend"), ErrorCode::InvalidArgument,
               "An axis has one of `processes`, `by_rate` and `trend`.");
  }
  if (by_rate != nullptr) {
    read_by_rate(*by_rate, pointer + "/by_rate", axis, faults);
  } else if (trend != nullptr) {
    read_trend(*trend, pointer + "/trend", axis, faults);
  }
  if (!(axis.bias_sd >= 0.0)) {
    faults.add(pointer, ErrorCode::InvalidArgument, "A standard deviation is not negative.");
  }
  return axis;
}

/// A number for all three axes or a list of three, times `factor`.
void read_three(ObjectReader& reader, std::string_view name, double factor, const std::string& pointer, double* out,
                Faults& faults) {
  const Json* const value = reader.member(name);
  if (value == nullptr) {
    return;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const bool list = value->is_array() && value->size() == 3 && (*value)[k].is_number();
    if (!list && !value->is_number()) {
      faults.add(pointer + "/" + std::string(name), ErrorCode::InvalidArgument,
                 "A number or a list of three belongs here.");
      return;
    }
    out[k] = (list ? (*value)[k].get<double>() : value->get<double>()) * factor;
  }
}

}  // namespace

void read_sensor(const Json& sensor, std::size_t first, const std::string& pointer, ImuModel& model, Faults& faults) {
  const bool per_axis = sensor.is_object() && (sensor.contains("x") || sensor.contains("y") || sensor.contains("z"));
  if (!per_axis) {
    const AxisModel axis = read_axis(sensor, first, pointer, faults);
    std::fill_n(model.axes.begin() + static_cast<std::ptrdiff_t>(first), 3, axis);
    return;
  }
  ObjectReader reader(sensor, pointer, faults);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string where = pointer + "/" + kAxes[k];
    if (const Json* const axis = reader.member(kAxes[k])) {
      model.axes[first + k] = read_axis(*axis, first, where, faults);
    } else {
      faults.add(where, ErrorCode::InvalidArgument, "A sensor that is given by axis has x, y and z.");
    }
  }
  reader.reject_unknown();
}

Json schedule_to_json(const ModelSchedule& schedule, Dimension dimension) {
  if (schedule.size() == 1) {
    return Json{{"processes", to_json(schedule.model(0), dimension)}};
  }
  Json bounds = Json::array();
  Json models = Json::array();
  for (const double bound : schedule.bounds_rad_s()) {
    bounds.push_back(number_in(bound, kDegree));
  }
  for (std::size_t band = 0; band < schedule.size(); ++band) {
    models.push_back(to_json(schedule.model(band), dimension));
  }
  return Json{{"by_rate",
               {{"bounds_deg_s", std::move(bounds)},
                {"processes", std::move(models)},
                {"hysteresis_deg_s", number_in(schedule.hysteresis_rad_s(), kDegree)}}}};
}

Json sensor_to_json(const ImuModel& model, std::size_t first) {
  Json sensor = Json::object();
  for (std::size_t k = 0; k < 3; ++k) {
    const AxisModel& axis = model.axes[first + k];
    const Dimension dimension = dimension_of(first);
    Json document = schedule_to_json(axis.processes, dimension);
    if (first == 0) {
      document["constant_bias_sd_deg_s"] = number_in(axis.bias_sd, kDegree);
    } else {
      document["constant_bias_sd_mg"] = number_in(axis.bias_sd, kMilliG);
    }
    sensor[kAxes[k]] = std::move(document);
  }
  return sensor;
}

void read_hardware(const Json& hardware, std::size_t first, const std::string& pointer, ImuHardware& out,
                   Faults& faults) {
  const double unit = first == 0 ? kDegree : 1.0;
  ObjectReader reader(hardware, pointer, faults);
  read_three(reader, "bias", unit, pointer, out.bias.data() + first, faults);
  read_three(reader, "scale_factor", 1.0, pointer, out.scale_factor.data() + first, faults);
  read_three(reader, "quantization_step", unit, pointer, out.quantization_step.data() + first, faults);
  read_three(reader, "range", unit, pointer, out.range.data() + first, faults);
  read_three(reader, "bandwidth_hz", 1.0, pointer, out.bandwidth_hz.data() + first, faults);
  if (const Json* const rows = reader.member("misalignment_mrad")) {
    Matrix3& matrix = first == 0 ? out.gyroscope_misalignment : out.accelerometer_misalignment;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto row = rows->is_array() && rows->size() == 3
                           ? numbers_from(&(*rows)[i], pointer + "/misalignment_mrad", 1e-3, faults)
                           : std::vector<double>{};
      if (row.size() != 3) {
        faults.add(pointer + "/misalignment_mrad", ErrorCode::InvalidArgument,
                   "Three rows of three numbers belong here.");
        break;
      }
      for (std::size_t j = 0; j < 3; ++j) {
        matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = row[j];
      }
    }
  }
  reader.reject_unknown();
}

Json hardware_to_json(const ImuHardware& hardware, std::size_t first) {
  const double unit = first == 0 ? kDegree : 1.0;
  Json document = Json::object();
  const auto add = [&](const char* name, const std::array<double, kImuChannels>& values, double per) {
    const auto* const begin = values.data() + first;
    if (std::any_of(begin, begin + 3, [](double v) { return v != 0.0; })) {
      document[name] = Json{number_in(begin[0], per), number_in(begin[1], per), number_in(begin[2], per)};
    }
  };
  add("bias", hardware.bias, unit);
  add("scale_factor", hardware.scale_factor, 1.0);
  add("quantization_step", hardware.quantization_step, unit);
  add("range", hardware.range, unit);
  add("bandwidth_hz", hardware.bandwidth_hz, 1.0);
  const Matrix3& matrix = first == 0 ? hardware.gyroscope_misalignment : hardware.accelerometer_misalignment;
  if (!matrix.isZero(0.0)) {
    Json rows = Json::array();
    for (Eigen::Index i = 0; i < 3; ++i) {
      rows.push_back(Json{number_in(matrix(i, 0), 1e-3), number_in(matrix(i, 1), 1e-3), number_in(matrix(i, 2), 1e-3)});
    }
    document["misalignment_mrad"] = std::move(rows);
  }
  return document;
}

}  // namespace driftlab
