#include "schema/json/outage_scenario.hpp"

#include "core/navigate/paper_scenario.hpp"
#include "core/signal/angle.hpp"
#include "schema/json/imu_model.hpp"
#include "schema/json/recorded_trajectory.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace driftlab {
namespace {

constexpr const char* kPublishedCondition = "z by true |rate| through Table 5, x and y at experiment 0";

Vector3 three(ObjectReader& reader, std::string_view name, const Vector3& otherwise, const std::string& pointer,
              Faults& faults) {
  const Json* const list = reader.member(name);
  if (list == nullptr) {
    return otherwise;
  }
  const bool good = list->is_array() && list->size() == 3 &&
                    std::all_of(list->begin(), list->end(), [](const Json& v) { return v.is_number(); });
  if (!good) {
    faults.add(pointer + "/" + std::string(name), ErrorCode::InvalidArgument, "A list of three numbers belongs here.");
    return otherwise;
  }
  return {(*list)[0].get<double>(), (*list)[1].get<double>(), (*list)[2].get<double>()};
}

Json three_json(const Vector3& v) { return Json{number(v.x()), number(v.y()), number(v.z())}; }

Segment read_segment(const Json& document, const std::string& pointer, Faults& faults) {
  Segment segment;
  ObjectReader reader(document, pointer, faults);
  auto kind = parse_segment_kind(reader.required_text("kind"));
  if (kind) {
    segment.kind = *kind;
  } else {
    faults.add(pointer + "/kind", kind.error());
  }
  segment.start_s = reader.real("t_s").value_or(-1.0);
  segment.duration_s = reader.real("duration_s").value_or(0.0);
  segment.rate_rad_s = reader.real("rate_deg_s").value_or(0.0) * kDegree;
  segment.acceleration_m_s2 = reader.real("m_s2").value_or(0.0);
  segment.until_speed_m_s = reader.real("until_speed_m_s").value_or(0.0);
  reader.reject_unknown();
  if (!(segment.duration_s >= 0.0)) {
    faults.add(pointer + "/duration_s", ErrorCode::InvalidArgument, "A duration is not negative.");
  }
  if (!(segment.until_speed_m_s >= 0.0)) {
    faults.add(pointer + "/until_speed_m_s", ErrorCode::InvalidArgument, "A speed is not negative.");
  }
  return segment;
}

void read_trajectory(const Json& document, const std::string& pointer, WrittenScenario& written, Faults& faults) {
  SegmentPlan& plan = written.scenario.drive;
  ObjectReader reader(document, pointer, faults);
  if (const Json* const start = reader.member("start")) {
    ObjectReader inner(*start, pointer + "/start", faults);
    plan.speed_m_s = inner.real("speed_m_s").value_or(0.0);
    plan.heading_rad = inner.real("heading_deg").value_or(0.0) * kDegree;
    plan.start.latitude_rad = inner.real("latitude_deg").value_or(51.08) * kDegree;
    plan.start.longitude_rad = inner.real("longitude_deg").value_or(-114.13) * kDegree;
    plan.start.height_m = inner.real("height_m").value_or(1100.0);
    inner.reject_unknown();
    if (!(plan.speed_m_s >= 0.0)) {
      faults.add(pointer + "/start/speed_m_s", ErrorCode::InvalidArgument, "A speed is not negative.");
    }
    if (!(plan.start.latitude_rad < 1.57 && plan.start.latitude_rad > -1.57)) {
      faults.add(pointer + "/start/latitude_deg", ErrorCode::OutOfRange, "The latitude lies between the poles.");
    }
  }
  plan.ramp_s = reader.real("ramp_s").value_or(0.5);
  if (!(plan.ramp_s > 0.0)) {
    faults.add(pointer + "/ramp_s", ErrorCode::InvalidArgument, "Rates rise and fall over a time above 0.");
  }
  const Json* const segments = reader.member("segments_by_start_time");
  const Json* const recorded = reader.member("recorded");
  if (recorded != nullptr) {
    written.recorded = recorded_from_json(*recorded, pointer + "/recorded", faults);
    if (segments != nullptr) {
      faults.add(pointer + "/recorded", ErrorCode::InvalidArgument, "A trajectory is recorded or made of segments.");
    }
  } else if (segments == nullptr || !segments->is_array() || segments->size() > 10000) {
    faults.add(pointer + "/segments_by_start_time", ErrorCode::InvalidArgument, "The segments are a list.");
  } else {
    for (std::size_t i = 0; i < segments->size(); ++i) {
      plan.segments.push_back(
          read_segment((*segments)[i], pointer + "/segments_by_start_time/" + std::to_string(i), faults));
    }
  }
  reader.reject_unknown();
}

void check_duration(double duration_s, const std::string& pointer, Faults& faults) {
  if (!(duration_s > 0.0)) {
    faults.add(pointer + "/duration_s", ErrorCode::InvalidArgument, "An outage lasts longer than 0 s.");
  }
}

/// A list, or {"start": "turn onset", "duration_s": 10}: one over each turn.
void read_outages(const Json& document, const std::string& pointer, WrittenScenario& written, Faults& faults) {
  if (document.is_array()) {
    if (document.size() > kMostOutages) {
      faults.add(pointer, ErrorCode::InvalidArgument, "A scenario has at most 1000 outages.");
      return;
    }
    for (std::size_t i = 0; i < document.size(); ++i) {
      const std::string where = pointer + "/" + std::to_string(i);
      ObjectReader reader(document[i], where, faults);
      const Outage outage{reader.real("start_s").value_or(-1.0), reader.real("duration_s").value_or(0.0)};
      reader.reject_unknown();
      check_duration(outage.duration_s, where, faults);
      written.scenario.outages.push_back(outage);
    }
    return;
  }
  ObjectReader reader(document, pointer, faults);
  const std::string start = reader.required_text("start");
  const double duration = reader.real("duration_s").value_or(0.0);
  (void)reader.text("error_scored");
  reader.reject_unknown();
  check_duration(duration, pointer, faults);
  if (start != "turn onset") {
    faults.add(pointer + "/start", ErrorCode::InvalidArgument,
               "Outages start at `turn onset`, or are listed one by one.");
  }
  written.at_turns_s = duration;
}

/// A member that documents state and that can only be true.
void require_true(ObjectReader& reader, std::string_view name, const char* why, Faults& faults) {
  const Json* const value = reader.member(name);
  if (value != nullptr && !(value->is_boolean() && value->get<bool>())) {
    faults.add(reader.pointer(name), ErrorCode::InvalidArgument, why);
  }
}

void read_gnss(const Json& document, const std::string& pointer, GnssModel& gnss, Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  gnss.position_sd_m = three(reader, "position_sd_m", gnss.position_sd_m, pointer, faults);
  gnss.velocity_sd_m_s = three(reader, "velocity_sd_m_s", gnss.velocity_sd_m_s, pointer, faults);
  gnss.correlated_sd_m = three(reader, "correlated_sd_m", gnss.correlated_sd_m, pointer, faults);
  gnss.correlation_time_s = reader.real("correlation_time_s").value_or(0.0);
  gnss.latency_s = reader.real("latency_s").value_or(0.0);
  gnss.lever_arm_m = three(reader, "lever_arm_m", gnss.lever_arm_m, pointer, faults);
  require_true(reader, "white", "The white error of fixes is always there; its size is position_sd_m.", faults);
  reader.reject_unknown();
}

struct Initial {
  InitialUncertainty uncertainty;
  double gyro_bias_sd_rad_s = 0.05 * kDegree;
};

Initial read_initial(const Json& document, const std::string& pointer, Faults& faults) {
  Initial initial;
  ObjectReader reader(document, pointer, faults);
  InitialUncertainty& u = initial.uncertainty;
  u.position_sd_m = three(reader, "position_sd_m", u.position_sd_m, pointer, faults);
  u.velocity_sd_m_s = three(reader, "velocity_sd_m_s", u.velocity_sd_m_s, pointer, faults);
  u.tilt_sd_rad = reader.real("tilt_sd_deg").value_or(1.0) * kDegree;
  u.heading_sd_rad = reader.real("heading_sd_deg").value_or(3.0) * kDegree;
  initial.gyro_bias_sd_rad_s = reader.real("gyro_bias_sd_deg_s").value_or(0.05) * kDegree;
  require_true(reader, "filters_without_gm_states_add_slow_gm_to_initial_bias_sd",
               "The published filters without Gauss-Markov states always add them to their first bias.", faults);
  reader.reject_unknown();
  return initial;
}

/// Truth: `gyro` is a sensor, or the paper's table by name.
void read_truth(const Json& document, const std::string& pointer, OutageScenario& scenario, Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  const Json* const gyro = reader.member("gyro");
  const Json* const accelerometer = reader.member("accelerometer");
  if (gyro == nullptr || accelerometer == nullptr) {
    faults.add(pointer, ErrorCode::InvalidArgument, "The truth has a gyro and an accelerometer.");
    return;
  }
  if (gyro->is_object() && gyro->contains("model")) {
    ObjectReader named(*gyro, pointer + "/gyro", faults);
    const std::string model = named.required_text("model");
    const std::string condition = named.text("condition").value_or(kPublishedCondition);
    const double bias = named.real("constant_bias_sd_deg_s").value_or(0.0) * kDegree;
    named.reject_unknown();
    if (model != "Table 4, iPhone 5S, every axis") {
      faults.add(pointer + "/gyro/model", ErrorCode::InvalidArgument,
                 "The one model known by name is `Table 4, iPhone 5S, every axis`; others are given as processes.");
    }
    if (condition != kPublishedCondition) {
      faults.add(pointer + "/gyro/condition", ErrorCode::InvalidArgument,
                 "The published model has one condition: `" + std::string(kPublishedCondition) + "`.");
    }
    const auto axes = paper_true_gyroscope(bias, true);
    std::copy(axes.begin(), axes.end(), scenario.truth.axes.begin());
  } else {
    read_sensor(*gyro, 0, pointer + "/gyro", scenario.truth, faults);
  }
  read_sensor(*accelerometer, 3, pointer + "/accelerometer", scenario.truth, faults);
  if (const Json* const errors = reader.member("gyro_errors")) {
    read_hardware(*errors, 0, pointer + "/gyro_errors", scenario.hardware, faults);
  }
  if (const Json* const errors = reader.member("accelerometer_errors")) {
    read_hardware(*errors, 3, pointer + "/accelerometer_errors", scenario.hardware, faults);
  }
  reader.reject_unknown();
}

FilterCandidate read_filter(const Json& document, const std::string& pointer, const OutageScenario& scenario,
                            double gyro_bias_sd, Faults& faults) {
  FilterCandidate filter;
  ObjectReader reader(document, pointer, faults);
  filter.name = reader.required_text("name");
  filter.about = reader.text("about").value_or("");
  filter.settings.initial = scenario.initial;
  filter.settings.lever_arm_m = scenario.gnss.lever_arm_m;
  filter.settings.imu = scenario.truth;  // accelerometers that are not given are the truth's
  const Json* const gyro = reader.member("gyro");
  if (gyro != nullptr && gyro->is_string()) {
    auto axes = paper_gyroscope(gyro->get<std::string>(), gyro_bias_sd, true);
    if (axes) {
      std::copy(axes->begin(), axes->end(), filter.settings.imu.axes.begin());
      filter.about = gyro->get<std::string>();
    } else {
      faults.add(pointer + "/gyro", axes.error());
    }
  } else if (gyro != nullptr) {
    read_sensor(*gyro, 0, pointer + "/gyro", filter.settings.imu, faults);
  }
  if (const Json* const accelerometer = reader.member("accelerometer")) {
    read_sensor(*accelerometer, 3, pointer + "/accelerometer", filter.settings.imu, faults);
  }
  filter.settings.covariance_samples = static_cast<int>(
      within(reader.integer("covariance_samples").value_or(filter.settings.covariance_samples), 0, 101));
  reader.reject_unknown();
  return filter;
}

/// Members of a scenario that an error of check() names.
constexpr std::array kMembers{"filters", "outages", "imu_rate_hz", "duration_s", "initial"};

/// Where in the document the fault lies that check() found.
std::string place_of(const Error& error, const OutageScenario& scenario) {
  std::string member;
  for (const ErrorField& field : error.fields) {
    if (field.name == "segment") {
      return "/trajectory/segments_by_start_time/" + field.value;
    }
    if (field.name == "filter") {
      const auto filter = std::find_if(scenario.filters.begin(), scenario.filters.end(),
                                       [&](const FilterCandidate& f) { return f.name == field.value; });
      return "/filters/" + std::to_string(filter - scenario.filters.begin());
    }
    if (field.name == "parameter" && std::find(kMembers.begin(), kMembers.end(), field.value) != kMembers.end()) {
      member = "/" + field.value;
    }
  }
  return member;
}

/// The receiver's velocities used or not.
bool read_velocity_use(ObjectReader& reader, Faults& faults) {
  const std::string use = reader.text("gnss_velocity").value_or("used");
  if (use != "used" && use != "not used") {
    faults.add(reader.pointer("gnss_velocity"), ErrorCode::InvalidArgument,
               "GNSS velocity is `used` or `not used` by the filters.");
  }
  return use == "used";
}

std::optional<NonHolonomic> read_constraint(const Json& document, const std::string& pointer, Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  const NonHolonomic constraint{reader.real("rate_hz").value_or(10.0), reader.real("sd_m_s").value_or(0.2)};
  reader.reject_unknown();
  return constraint;
}

Json trajectory_to_json(const OutageScenario& scenario) {
  const SegmentPlan& drive = scenario.drive;
  Json segments = Json::array();
  for (const Segment& segment : drive.segments) {
    Json item{{"t_s", number(segment.start_s)}, {"kind", name_of(segment.kind)}};
    if (segment.kind == SegmentKind::Turn || segment.kind == SegmentKind::SCurve) {
      item["rate_deg_s"] = number_in(segment.rate_rad_s, kDegree);
      item["duration_s"] = number(segment.duration_s);
    } else if (segment.kind != SegmentKind::Straight) {
      item["m_s2"] = number(segment.acceleration_m_s2);
      item["until_speed_m_s"] = number(segment.until_speed_m_s);
    }
    segments.push_back(std::move(item));
  }
  Json trajectory{{"start",
                   {{"speed_m_s", number(drive.speed_m_s)},
                    {"heading_deg", number_in(drive.heading_rad, kDegree)},
                    {"latitude_deg", number_in(drive.start.latitude_rad, kDegree)},
                    {"longitude_deg", number_in(drive.start.longitude_rad, kDegree)},
                    {"height_m", number(drive.start.height_m)}}},
                  {"ramp_s", number(drive.ramp_s)}};
  if (scenario.recorded.empty()) {
    trajectory["segments_by_start_time"] = std::move(segments);
  } else {
    trajectory["recorded"] = recorded_to_json(scenario.recorded);
  }
  return trajectory;
}

}  // namespace

OutageScenario scenario_from_json(const Json& document, const std::string& pointer, Faults& faults) {
  WrittenScenario written;
  OutageScenario& scenario = written.scenario;
  ObjectReader reader(document, pointer, faults);
  scenario.name = reader.text("name").value_or("");
  scenario.about = reader.text("about").value_or("");
  scenario.drive.duration_s = reader.real("duration_s").value_or(0.0);
  scenario.imu_rate_hz = reader.real("imu_rate_hz").value_or(100.0);
  scenario.gnss.rate_hz = reader.real("gnss_rate_hz").value_or(1.0);
  const auto part = [&](const char* name, bool needed, const auto& read) {
    const Json* const member = reader.member(name);
    if (member != nullptr) {
      read(*member, pointer + "/" + name);
    } else if (needed) {
      faults.add(pointer + "/" + name, ErrorCode::InvalidArgument, std::string("The member ") + name + " is missing.");
    }
  };
  part("trajectory", true, [&](const Json& d, const std::string& p) { read_trajectory(d, p, written, faults); });
  part("outages", true, [&](const Json& d, const std::string& p) { read_outages(d, p, written, faults); });
  part("gnss", false, [&](const Json& d, const std::string& p) { read_gnss(d, p, scenario.gnss, faults); });
  Initial initial;
  part("initial", false, [&](const Json& d, const std::string& p) { initial = read_initial(d, p, faults); });
  scenario.initial = initial.uncertainty;
  part("truth", true, [&](const Json& d, const std::string& p) { read_truth(d, p, scenario, faults); });
  const bool use_velocity = read_velocity_use(reader, faults);
  std::optional<NonHolonomic> constraint;
  part("non_holonomic", false,
       [&](const Json& d, const std::string& p) { constraint = read_constraint(d, p, faults); });
  part("filters", true, [&](const Json& list, const std::string& p) {
    if (!list.is_array()) {
      faults.add(p, ErrorCode::InvalidArgument, "The filters are a list.");
    }
    for (std::size_t i = 0; list.is_array() && i < list.size() && i < 33; ++i) {
      FilterCandidate filter =
          read_filter(list[i], p + "/" + std::to_string(i), scenario, initial.gyro_bias_sd_rad_s, faults);
      filter.settings.use_velocity = use_velocity;
      filter.settings.non_holonomic = constraint;
      scenario.filters.push_back(std::move(filter));
    }
  });
  (void)reader.member("variants");
  reader.reject_unknown();
  OutageScenario whole = completed(std::move(written));
  if (faults.none()) {
    if (auto status = check(whole); !status) {
      faults.add(pointer + place_of(status.error(), whole), status.error());
    }
  }
  return whole;
}

OutageScenario scenario_or_name(const Json& value, const std::string& pointer, Faults& faults) {
  if (!value.is_string()) {
    return scenario_from_json(value, pointer, faults);
  }
  auto named = paper_scenario(value.get<std::string>());
  if (!named) {
    faults.add(pointer, named.error());
    return {};
  }
  return std::move(*named);
}

Json to_json(const OutageScenario& scenario) {
  const SegmentPlan& drive = scenario.drive;
  Json outages = Json::array();
  for (const Outage& outage : scenario.outages) {
    outages.push_back(Json{{"start_s", number(outage.start_s)}, {"duration_s", number(outage.duration_s)}});
  }
  Json truth{{"gyro", sensor_to_json(scenario.truth, 0)}, {"accelerometer", sensor_to_json(scenario.truth, 3)}};
  if (Json errors = hardware_to_json(scenario.hardware, 0); !errors.empty()) {
    truth["gyro_errors"] = std::move(errors);
  }
  if (Json errors = hardware_to_json(scenario.hardware, 3); !errors.empty()) {
    truth["accelerometer_errors"] = std::move(errors);
  }
  Json filters = Json::array();
  for (const FilterCandidate& filter : scenario.filters) {
    filters.push_back(Json{{"name", filter.name},
                           {"about", filter.about},
                           {"gyro", sensor_to_json(filter.settings.imu, 0)},
                           {"accelerometer", sensor_to_json(filter.settings.imu, 3)},
                           {"covariance_samples", filter.settings.covariance_samples}});
  }
  Json document{{"name", scenario.name},
                {"about", scenario.about},
                {"duration_s", number(drive.duration_s)},
                {"imu_rate_hz", number(scenario.imu_rate_hz)},
                {"gnss_rate_hz", number(scenario.gnss.rate_hz)},
                {"trajectory", trajectory_to_json(scenario)},
                {"outages", std::move(outages)},
                {"truth", std::move(truth)},
                {"gnss",
                 {{"position_sd_m", three_json(scenario.gnss.position_sd_m)},
                  {"velocity_sd_m_s", three_json(scenario.gnss.velocity_sd_m_s)},
                  {"correlated_sd_m", three_json(scenario.gnss.correlated_sd_m)},
                  {"correlation_time_s", number(scenario.gnss.correlation_time_s)},
                  {"latency_s", number(scenario.gnss.latency_s)},
                  {"lever_arm_m", three_json(scenario.gnss.lever_arm_m)}}},
                {"initial",
                 {{"position_sd_m", three_json(scenario.initial.position_sd_m)},
                  {"velocity_sd_m_s", three_json(scenario.initial.velocity_sd_m_s)},
                  {"tilt_sd_deg", number_in(scenario.initial.tilt_sd_rad, kDegree)},
                  {"heading_sd_deg", number_in(scenario.initial.heading_sd_rad, kDegree)}}},
                {"filters", std::move(filters)}};
  const FilterSettings& shared = scenario.filters.front().settings;
  document["gnss_velocity"] = shared.use_velocity ? "used" : "not used";
  if (shared.non_holonomic) {
    document["non_holonomic"] =
        Json{{"rate_hz", number(shared.non_holonomic->rate_hz)}, {"sd_m_s", number(shared.non_holonomic->sd_m_s)}};
  }
  return document;
}

}  // namespace driftlab
