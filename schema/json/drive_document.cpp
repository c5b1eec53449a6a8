#include "schema/json/drive_document.hpp"

#include "core/signal/angle.hpp"
#include "schema/json/imu_model.hpp"

#include <array>

namespace driftlab {
namespace {

bool is_numbers(const Json& value, std::size_t count) {
  if (!value.is_array() || value.size() != count) {
    return false;
  }
  for (const Json& one : value) {
    if (!one.is_number()) {
      return false;
    }
  }
  return true;
}

std::optional<Vector3> drive_vector(ObjectReader& reader, std::string_view name, Faults& faults) {
  const Json* const value = reader.member(name);
  if (value == nullptr) {
    return std::nullopt;
  }
  if (!is_numbers(*value, 3)) {
    faults.add(reader.pointer(name), ErrorCode::InvalidArgument, "A list of three numbers belongs here.");
    return std::nullopt;
  }
  return Vector3((*value)[0].get<double>(), (*value)[1].get<double>(), (*value)[2].get<double>());
}

bool drive_flag(ObjectReader& reader, std::string_view name, Faults& faults) {
  const Json* const value = reader.member(name);
  if (value != nullptr && !value->is_boolean()) {
    faults.add(reader.pointer(name), ErrorCode::InvalidArgument, "True or false belongs here.");
  }
  return value != nullptr && value->is_boolean() && value->get<bool>();
}

/// A standard deviation or the like: at least 0.
double not_negative(ObjectReader& reader, std::string_view name, double otherwise, Faults& faults) {
  const double value = reader.real(name).value_or(otherwise);
  if (!(value >= 0.0)) {
    faults.add(reader.pointer(name), ErrorCode::InvalidArgument, "A number of at least 0 belongs here.");
  }
  return value;
}

drive::ColumnMeaning drive_column(const Json& document, const std::string& pointer, Faults& faults) {
  drive::ColumnMeaning meaning;
  ObjectReader reader(document, pointer, faults);
  const std::string quantity = reader.required_text("quantity");
  meaning.axis = reader.text("axis").value_or("");
  const auto unit = reader.text("unit");
  reader.reject_unknown();
  if (quantity.empty()) {
    return meaning;
  }
  const auto parsed = drive::parse_quantity(quantity);
  if (!parsed) {
    faults.add(reader.pointer("quantity"), parsed.error());
    return meaning;
  }
  meaning.quantity = *parsed;
  const bool of_unit = *parsed == drive::Quantity::AngularRate || *parsed == drive::Quantity::SpecificForce;
  const bool points_back = of_unit && meaning.axis.starts_with('-');  // "-x": what a left-handed unit calls x
  meaning.axis.erase(0, points_back ? 1 : 0);
  const auto& axes = drive::axes_of(*parsed);
  const bool known = axes.empty() ? meaning.axis.empty()
                                  : std::find(axes.begin(), axes.end(), std::string_view(meaning.axis)) != axes.end();
  if (!known) {
    std::string list;
    for (const std::string_view axis : axes) {
      list.append(list.empty() ? "" : ", ").append(axis);
    }
    faults.add(reader.pointer("axis"), ErrorCode::InvalidArgument,
               list.empty() ? quantity + " has no axis." : quantity + " has one of the axes " + list + ".");
  }
  if (unit) {
    if (const auto factor = drive::factor_of(*unit, *parsed, meaning.axis)) {
      meaning.factor = *factor;
    } else {
      faults.add(reader.pointer("unit"), factor.error());
    }
  } else if (of_unit || meaning.axis == "lat" || meaning.axis == "lon" || *parsed == drive::Quantity::GnssCourse) {
    faults.add(pointer, ErrorCode::InvalidArgument, "The unit of " + quantity + " is not guessed: give `unit`.");
  }
  meaning.factor *= points_back ? -1.0 : 1.0;
  return meaning;
}

drive::TimeMeaning drive_time(const Json& document, const std::string& pointer, Faults& faults) {
  drive::TimeMeaning time;
  ObjectReader reader(document, pointer, faults);
  time.column = reader.text("column").value_or("");
  if (const auto unit = reader.text("unit")) {
    const auto parsed = parse_unit(*unit);
    if (!parsed || parsed->dimension != Dimension::Time) {
      faults.add(reader.pointer("unit"), ErrorCode::UnitMismatch, "A time is in s, ms, us or ns.");
    } else {
      time.unit_s = parsed->factor;
    }
  }
  const std::string is = reader.text("is").value_or("validity");
  time.arrival = is == "arrival";
  if (is != "validity" && is != "arrival") {
    faults.add(reader.pointer("is"), ErrorCode::InvalidArgument, "A stamp is `validity` or `arrival`.");
  }
  const std::string scale = reader.required_text("scale");
  if (const auto parsed = drive::parse_time_scale(scale)) {
    time.scale = *parsed;
  } else if (!scale.empty()) {
    faults.add(reader.pointer("scale"), ErrorCode::InvalidArgument, "A time scale is gps, utc, unix, boot or row.");
  }
  time.offset_s = reader.real("offset_s").value_or(0.0);
  time.rate_hz = reader.real("rate_hz");
  time.tag = reader.text("tag").value_or("");
  if (const Json* const dates = reader.member("dates")) {
    ObjectReader inner(*dates, pointer + "/dates", faults);
    const auto first = inner.real("first_s");
    const auto last = inner.real("last_s");
    inner.reject_unknown();
    if (!first || !last || !(*last > *first) || !time.tag.empty()) {
      faults.add(
          pointer + "/dates", ErrorCode::InvalidArgument,
          "Dates are what a time tag says, in its place: {\"first_s\", \"last_s\"}, GPS time in seconds since 1970.");
    } else {
      time.dates = drive::TimeTag{*first, *last};
    }
  }
  reader.reject_unknown();
  if (time.column.empty() && time.scale != drive::TimeScale::Row) {
    faults.add(pointer, ErrorCode::InvalidArgument, "Name the `column` of the time, or say that the scale is `row`.");
  }
  return time;
}

/// Members `file`, `columns` and `time` of a source.
drive::Source drive_source(ObjectReader& reader, std::string_view source_member, Faults& faults) {
  drive::Source source;
  source.file = reader.required_text(source_member);
  if (const Json* const columns = reader.member("columns"); columns != nullptr && columns->is_object()) {
    for (const auto& [name, meaning] : columns->items()) {
      source.columns.emplace(name, drive_column(meaning, reader.pointer("columns") + "/" + name, faults));
    }
  } else {
    faults.add(reader.pointer("columns"), ErrorCode::InvalidArgument,
               "A source says what its columns are: {\"columns\": {name: {\"quantity\", \"axis\", \"unit\"}}}.");
  }
  if (const Json* const time = reader.member("time")) {
    source.time = drive_time(*time, reader.pointer("time"), faults);
  } else {
    faults.add(reader.pointer("time"), ErrorCode::InvalidArgument,
               "A source says how its rows lie in time: {\"column\", \"unit\", \"scale\"}.");
  }
  return source;
}

void read_drive_imu(const Json& document, const std::string& pointer, std::string_view member, drive::ImuSource& imu,
                    Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  imu.source = drive_source(reader, member, faults);
  if (const Json* const force = reader.member("accelerometer")) {
    ObjectReader inner(*force, pointer + "/accelerometer", faults);
    imu.force = drive_source(inner, member, faults);
    inner.reject_unknown();
  }
  if (const Json* const mounting = reader.member("mounting_deg")) {
    if (mounting->is_string() && mounting->get<std::string>() == "unknown") {
      imu.mounting_unknown = true;
    } else if (is_numbers(*mounting, 3)) {
      imu.mounting = {(*mounting)[0].get<double>() * kDegree, (*mounting)[1].get<double>() * kDegree,
                      (*mounting)[2].get<double>() * kDegree};
    } else {
      faults.add(pointer + "/mounting_deg", ErrorCode::InvalidArgument,
                 "The mounting is [roll, pitch, yaw] in degrees, or \"unknown\".");
    }
  }
  imu.mounting_sd_rad = not_negative(reader, "mounting_sd_deg", 0.0, faults) * kDegree;
  const std::string clock = reader.text("clock").value_or("sensor");
  imu.clock = clock == "host"      ? drive::SensorClock::Host
              : clock == "arrival" ? drive::SensorClock::Arrival
                                   : drive::SensorClock::Sensor;
  if (clock != "sensor" && clock != "host" && clock != "arrival") {
    faults.add(pointer + "/clock", ErrorCode::InvalidArgument, "The unit's clock is sensor, host or arrival.");
  }
  reader.reject_unknown();
}

void read_drive_gnss(const Json& document, const std::string& pointer, std::string_view member, drive::GnssSource& gnss,
                     Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  gnss.source = drive_source(reader, member, faults);
  if (const Json* const types = reader.member("fix_types")) {
    bool sound = types->is_array();
    for (std::size_t i = 0; sound && i < types->size(); ++i) {
      sound = (*types)[i].is_number_integer();
      if (sound) {
        gnss.fix_types.push_back((*types)[i].get<int>());
      }
    }
    if (!sound) {
      faults.add(pointer + "/fix_types", ErrorCode::InvalidArgument,
                 "The fix types to be used are a list of whole numbers.");
    }
  }
  gnss.lever_arm_m = drive_vector(reader, "lever_arm_m", faults).value_or(Vector3::Zero());
  gnss.lever_arm_sd_m = not_negative(reader, "lever_arm_sd_m", 0.0, faults);
  if (const Json* const latency = reader.member("latency_s")) {
    ObjectReader inner(*latency, pointer + "/latency_s", faults);
    gnss.position_latency_s = inner.real("position").value_or(0.0);
    gnss.velocity_latency_s = inner.real("velocity").value_or(0.0);
    inner.reject_unknown();
    const auto too_late = [](double latency_s) { return latency_s > 10.0 || latency_s < -10.0; };
    if (too_late(gnss.position_latency_s) || too_late(gnss.velocity_latency_s)) {
      faults.add(pointer + "/latency_s", ErrorCode::InvalidArgument, "A latency is at most 10 s.");
    }
  }
  gnss.hold = drive_flag(reader, "hold", faults);
  const std::string above = reader.text("height_above").value_or("ellipsoid");
  gnss.geoid = above == "geoid";
  if (above != "ellipsoid" && above != "geoid") {
    faults.add(pointer + "/height_above", ErrorCode::InvalidArgument, "Heights are above the ellipsoid or the geoid.");
  }
  const auto sd = [&](std::string_view name, Vector3& into) {
    if (const auto value = drive_vector(reader, name, faults)) {
      into = *value;
      if (!(into.array() > 0.0).all()) {
        faults.add(reader.pointer(name), ErrorCode::InvalidArgument, "Standard deviations are above 0.");
      }
    }
  };
  sd("position_sd_m", gnss.position_sd_m);
  sd("velocity_sd_m_s", gnss.velocity_sd_m_s);
  reader.reject_unknown();
}

void read_drive_reference(const Json& document, const std::string& pointer, std::string_view member,
                          drive::ReferenceSource& reference, Faults& faults) {
  if (document.is_string()) {
    reference.smoothed = document.get<std::string>() == "smoothed_fixes";
    if (document.get<std::string>() != "withheld_fixes" && !reference.smoothed) {
      faults.add(pointer, ErrorCode::InvalidArgument,
                 "A reference is a source, \"withheld_fixes\" or \"smoothed_fixes\".");
    }
    return;
  }
  ObjectReader reader(document, pointer, faults);
  reference.source = drive_source(reader, member, faults);
  reference.lever_arm_m = drive_vector(reader, "lever_arm_m", faults).value_or(Vector3::Zero());
  reference.sd_m = not_negative(reader, "sd_m", 0.0, faults);
  reader.reject_unknown();
}

void read_drive_odometer(const Json& document, const std::string& pointer, std::string_view member,
                         drive::OdometerSource& odometer, Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  odometer.source = drive_source(reader, member, faults);
  odometer.metres_per_tick = not_negative(reader, "metres_per_tick", 0.0, faults);
  odometer.lever_arm_m = drive_vector(reader, "lever_arm_m", faults).value_or(Vector3::Zero());
  odometer.sd_m_s = not_negative(reader, "sd_m_s", 0.1, faults);
  if (!(odometer.sd_m_s > 0.0)) {
    faults.add(pointer + "/sd_m_s", ErrorCode::InvalidArgument, "A standard deviation is above 0.");
  }
  reader.reject_unknown();
}

void read_drive_start(const Json& document, const std::string& pointer, drive::StartState& start, Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  if (const Json* const position = reader.member("position")) {
    ObjectReader inner(*position, pointer + "/position", faults);
    Geodetic place;
    place.latitude_rad = inner.real("latitude_deg").value_or(0.0) * kDegree;
    place.longitude_rad = inner.real("longitude_deg").value_or(0.0) * kDegree;
    place.height_m = inner.real("height_m").value_or(0.0);
    inner.reject_unknown();
    start.position = place;
  }
  start.velocity_ned_m_s = drive_vector(reader, "velocity_ned_m_s", faults);
  const auto angle = [&](std::string_view name) -> std::optional<double> {
    const auto value = reader.real(name);
    return value ? std::optional(*value * kDegree) : std::nullopt;
  };
  start.heading_rad = angle("heading_deg");
  start.roll_rad = angle("roll_deg");
  start.pitch_rad = angle("pitch_deg");
  reader.reject_unknown();
}

void read_drive_outages(const Json& document, const std::string& pointer, drive::OutagePlan& plan, Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  const auto numbers = [&](std::string_view name, std::vector<double>& into) {
    const Json* const value = reader.member(name);
    if (value == nullptr) {
      return;
    }
    into.clear();
    bool sound = value->is_array() && value->size() <= 10000;
    for (std::size_t i = 0; sound && i < value->size(); ++i) {
      sound = (*value)[i].is_number();
      if (sound) {
        into.push_back((*value)[i].get<double>());
      }
    }
    if (!sound) {
      faults.add(reader.pointer(name), ErrorCode::InvalidArgument, "A list of numbers belongs here.");
    }
  };
  numbers("duration_s", plan.duration_s);
  numbers("every_s", plan.every_s);
  numbers("at", plan.at_s);
  if (const auto phases = reader.integer("phases")) {
    plan.phases = static_cast<int>(within(*phases, -1, 1000));
  }
  plan.settle_s = reader.real("settle_s").value_or(plan.settle_s);
  reader.reject_unknown();
}

}  // namespace

ImuModel drive_model_from_json(const Json& document, const std::string& pointer, Faults& faults) {
  ImuModel model;
  ObjectReader reader(document, pointer, faults);
  for (const auto& [name, first] :
       {std::pair{"gyroscope", std::size_t{0}}, std::pair{"accelerometer", std::size_t{3}}}) {
    if (const Json* const sensor = reader.member(name)) {
      read_sensor(*sensor, first, pointer + "/" + name, model, faults);
    } else {
      faults.add(pointer + "/" + name, ErrorCode::InvalidArgument,
                 "The model says what the filter believes of the gyroscope and of the accelerometer.");
    }
  }
  reader.reject_unknown();
  return model;
}

drive::Document drive_from_json(const Json& document, Faults& faults, std::string_view source_member,
                                const std::string& pointer) {
  drive::Document made;
  ObjectReader reader(document, pointer, faults);
  made.id = reader.required_text("id");
  const std::string vehicle = reader.required_text("vehicle");
  if (const auto parsed = drive::parse_vehicle(vehicle)) {
    made.vehicle = *parsed;
  } else if (!vehicle.empty()) {
    faults.add(pointer + "/vehicle", ErrorCode::InvalidArgument, "A vehicle is road, rail, rover, air, foot or boat.");
  }
  const auto required = [&](std::string_view name) {
    const Json* const member = reader.member(name);
    if (member == nullptr) {
      faults.add(pointer + "/" + std::string(name), ErrorCode::InvalidArgument,
                 "A drive has the member `" + std::string(name) + "`.");
    }
    return member;
  };
  if (const Json* const imu = required("imu")) {
    read_drive_imu(*imu, pointer + "/imu", source_member, made.imu, faults);
  }
  if (const Json* const gnss = required("gnss")) {
    read_drive_gnss(*gnss, pointer + "/gnss", source_member, made.gnss, faults);
  }
  if (const Json* const reference = reader.member("reference")) {
    read_drive_reference(*reference, pointer + "/reference", source_member, made.reference, faults);
  }
  if (const Json* const odometer = reader.member("odometer")) {
    made.odometer.emplace();
    read_drive_odometer(*odometer, pointer + "/odometer", source_member, *made.odometer, faults);
  }
  if (const Json* const model = required("model")) {
    made.model = drive_model_from_json(*model, pointer + "/model", faults);
  }
  if (const Json* const start = reader.member("start")) {
    read_drive_start(*start, pointer + "/start", made.start, faults);
  }
  if (const Json* const outages = reader.member("outages")) {
    read_drive_outages(*outages, pointer + "/outages", made.outages, faults);
  }
  reader.reject_unknown();
  if (faults.none()) {
    if (const auto status = drive::check(made); !status) {
      faults.add(pointer, status.error());
    }
  }
  return made;
}

}  // namespace driftlab
