#include "core/signal/unit.hpp"
#include "schema/json/outage_scenario.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>

namespace driftlab {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// A document with a value of its own in every member that numbers have.
const char* const kEveryMember = R"json({"name": "every member", "about": "each value once",
  "duration_s": 60, "imu_rate_hz": 50, "gnss_rate_hz": 2,
  "trajectory": {"start": {"speed_m_s": 11, "heading_deg": 21, "latitude_deg": 31, "longitude_deg": 41, "height_m": 51},
    "ramp_s": 0.7, "segments_by_start_time": [
      {"t_s": 3, "kind": "turn", "rate_deg_s": 6, "duration_s": 4},
      {"t_s": 9, "kind": "s_curve", "rate_deg_s": -7, "duration_s": 5},
      {"t_s": 20, "kind": "accelerate", "m_s2": 1.5, "until_speed_m_s": 13},
      {"t_s": 40, "kind": "stop", "m_s2": 2.5}]},
  "outages": [{"start_s": 22, "duration_s": 8}, {"start_s": 44, "duration_s": 9}],
  "truth": {
    "gyro": {"x": {"processes": [{"process": "white_noise", "params": {"N": {"value": 1.1, "unit": "deg/sqrt(h)"
}
}
}],
                   "constant_bias_sd_deg_s": 0.01
}
, "y" : {
  "by_rate" : {
    "bounds_deg_s" : [5.5],
    "hysteresis_deg_s" : 0.25,
    "processes" : [
      [ {"process" : "white_noise", "params" : {"N" : {"value" : 1.2, "unit" : "deg/sqrt(h)"}}} ],
      [ {"process" : "white_noise", "params" : {"N" : {"value" : 1.3, "unit" : "deg/sqrt(h)"}}} ]
    ]
  },
  "constant_bias_sd_deg_s" : 0.02
},
        "z" : {
          "processes" : [ {"process" : "random_walk", "params" : {"K" : {"value" : 1.4, "unit" : "deg/h/sqrt(h)"}}} ],
          "constant_bias_sd_deg_s" : 0.03
        }
}
, "accelerometer" : {
  "white_noise_mg_per_sqrt_hz" : 2.1,
  "constant_bias_sd_mg" : 9,
  "in_run" : {"process" : "gauss_markov", "sigma_mg" : 1.7, "tau_s" : 80}
},
                    "gyro_errors" : {
                      "bias" : [ 0.1, 0.2, 0.3 ],
                      "scale_factor" : [ 0.001, 0.002, 0.003 ],
                      "quantization_step" : [ 0.004, 0.005, 0.006 ],
                      "range" : [ 250, 260, 270 ],
                      "bandwidth_hz" : [ 11, 12, 13 ],
                      "misalignment_mrad" : [ [ 0, 1, 2 ], [ 3, 0, 4 ], [ 5, 6, 0 ] ]
                    },
                                    "accelerometer_errors" : {
  "bias" : [ 1.1, 1.2, 1.3 ],
           "scale_factor" : [ 0.011, 0.012, 0.013 ],
                            "quantization_step" : [ 0.014, 0.015, 0.016 ],
                                                  "range" : [ 25, 26, 27 ],
                                                            "bandwidth_hz" : [ 14, 15, 16 ],
                                                                             "misalignment_mrad"
      : [ [ 0, 7, 8 ], [ 9, 0, 10 ], [ 11, 12, 0 ] ]
}
}
, "gnss" : {
  "position_sd_m" : [ 2.1, 2.2, 2.3 ],
  "velocity_sd_m_s" : [ 0.11, 0.12, 0.13 ],
  "correlated_sd_m" : [ 0.7, 0.8, 0.9 ],
  "correlation_time_s" : 33,
  "latency_s" : 0.14,
  "lever_arm_m" : [ 0.5, -0.6, -1.2 ],
  "white" : true
},
           "gnss_velocity" : "not used",
                             "initial" : {
                               "position_sd_m" : [ 3.1, 3.2, 3.3 ],
                               "velocity_sd_m_s" : [ 0.31, 0.32, 0.33 ],
                               "tilt_sd_deg" : 1.6,
                               "heading_sd_deg" : 2.6,
                               "filters_without_gm_states_add_slow_gm_to_initial_bias_sd" : true
                             },
                                         "non_holonomic" : {"rate_hz" : 5, "sd_m_s" : 0.15},
                                                           "filters"
    : [
      {"name" : "a", "about" : "first", "covariance_samples" : 4}, {
        "name" : "b",
        "about" : "second",
        "covariance_samples" : 6,
        "gyro" : {
          "processes" : [ {"process" : "white_noise", "params" : {"N" : {"value" : 1.5, "unit" : "deg/sqrt(h)"}}} ],
          "constant_bias_sd_deg_s" : 0.04
        }
      }
    ]
})json";

void expect_vector(const Vector3& v, double x, double y, double z, const char* name) {
  EXPECT_NEAR((v - Vector3(x, y, z)).norm(), 0.0, 1e-12) << name;
}

/// Three channels from `first` on.
void expect_three(const std::array<double, kImuChannels>& values, std::size_t first, const Vector3& want,
                  const char* name) {
  expect_vector({values[first], values[first + 1], values[first + 2]}, want.x(), want.y(), want.z(), name);
}

void expect_every_hardware_member(const ImuHardware& hardware) {
  expect_three(hardware.bias, 0, kDegree * Vector3(0.1, 0.2, 0.3), "gyro bias");
  expect_three(hardware.bias, 3, {1.1, 1.2, 1.3}, "accelerometer bias");
  expect_three(hardware.scale_factor, 0, {0.001, 0.002, 0.003}, "gyro scale factor");
  expect_three(hardware.scale_factor, 3, {0.011, 0.012, 0.013}, "accelerometer scale factor");
  expect_three(hardware.quantization_step, 0, kDegree * Vector3(0.004, 0.005, 0.006), "gyro step");
  expect_three(hardware.quantization_step, 3, {0.014, 0.015, 0.016}, "accelerometer step");
  expect_three(hardware.range, 0, kDegree * Vector3(250, 260, 270), "gyro range");
  expect_three(hardware.range, 3, {25, 26, 27}, "accelerometer range");
  expect_three(hardware.bandwidth_hz, 0, {11, 12, 13}, "gyro bandwidth");
  expect_three(hardware.bandwidth_hz, 3, {14, 15, 16}, "accelerometer bandwidth");
  Matrix3 gyro;
  gyro << 0, 1, 2, 3, 0, 4, 5, 6, 0;
  Matrix3 accelerometer;
  accelerometer << 0, 7, 8, 9, 0, 10, 11, 12, 0;
  EXPECT_NEAR((hardware.gyroscope_misalignment - 1e-3 * gyro).norm(), 0.0, 1e-15);
  EXPECT_NEAR((hardware.accelerometer_misalignment - 1e-3 * accelerometer).norm(), 0.0, 1e-15);
}

void expect_every_filter_member(const OutageScenario& scenario) {
  ASSERT_EQ(scenario.filters.size(), 2U);
  for (const FilterCandidate& filter : scenario.filters) {
    EXPECT_FALSE(filter.settings.use_velocity);
    ASSERT_TRUE(filter.settings.non_holonomic.has_value());
    const NonHolonomic constraint = filter.settings.non_holonomic.value_or(NonHolonomic{});
    EXPECT_EQ(constraint.rate_hz, 5.0);
    EXPECT_EQ(constraint.sd_m_s, 0.15);
    expect_vector(filter.settings.lever_arm_m, 0.5, -0.6, -1.2, "lever arm of a filter");
    expect_vector(filter.settings.initial.position_sd_m, 3.1, 3.2, 3.3, "initial of a filter");
    EXPECT_NEAR(filter.settings.imu.axes[3].bias_sd, 9e-3 * kStandardGravity, 1e-14) << "the truth's";
  }
  EXPECT_EQ(scenario.filters[0].about, "first");
  EXPECT_EQ(scenario.filters[0].settings.covariance_samples, 4);
  EXPECT_EQ(scenario.filters[1].settings.covariance_samples, 6);
  EXPECT_NEAR(scenario.filters[0].settings.imu.axes[1].bias_sd, 0.02 * kDegree, 1e-15) << "the truth's";
  EXPECT_NEAR(scenario.filters[1].settings.imu.axes[2].bias_sd, 0.04 * kDegree, 1e-15);
}

void expect_every_truth_member(const ImuModel& truth) {
  constexpr double kPerRootHour = kDegree / 60.0;
  EXPECT_NEAR(truth.axes[0].processes.model(0)[0].parameters[0], 1.1 * kPerRootHour, 1e-15);
  const ModelSchedule& by_rate = truth.axes[1].processes;
  ASSERT_EQ(by_rate.size(), 2U);
  EXPECT_NEAR(by_rate.bounds_rad_s()[0], 5.5 * kDegree, 1e-14);
  EXPECT_NEAR(by_rate.hysteresis_rad_s(), 0.25 * kDegree, 1e-15);
  EXPECT_NEAR(by_rate.model(0)[0].parameters[0], 1.2 * kPerRootHour, 1e-15);
  EXPECT_NEAR(by_rate.model(1)[0].parameters[0], 1.3 * kPerRootHour, 1e-15);
  EXPECT_EQ(truth.axes[2].processes.model(0)[0].kind->name, "random_walk");
  EXPECT_NEAR(truth.axes[2].processes.model(0)[0].parameters[0], 1.4 * kDegree / 216000.0, 1e-18);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(truth.axes[k].bias_sd, 0.01 * static_cast<double>(k + 1) * kDegree, 1e-15);
    const Model& model = truth.axes[3 + k].processes.model(0);
    ASSERT_EQ(model.size(), 2U);
    EXPECT_NEAR(model[0].parameters[0], 2.1e-3 * kStandardGravity, 1e-14);
    EXPECT_NEAR(model[1].parameters[0], 1.7e-3 * kStandardGravity, 1e-14);
    EXPECT_NEAR(model[1].parameters[1], 1.0 / 80.0, 1e-15);
  }
}

TEST(ScenarioDocument, EveryMemberSurvivesTheWayThroughJson) {
  Faults faults;
  const OutageScenario read = scenario_from_json(*parse_json(kEveryMember), "", faults);
  ASSERT_TRUE(faults.none()) << faults.error().message << " " << faults.error().fields.front().name;
  const OutageScenario again = scenario_from_json(to_json(read), "", faults);
  ASSERT_TRUE(faults.none()) << faults.error().message;
  for (const OutageScenario& s : {read, again}) {
    EXPECT_EQ(s.name, "every member");
    EXPECT_EQ(s.about, "each value once");
    EXPECT_EQ(s.drive.duration_s, 60.0);
    EXPECT_EQ(s.imu_rate_hz, 50.0);
    EXPECT_EQ(s.drive.speed_m_s, 11.0);
    EXPECT_NEAR(s.drive.heading_rad, 21.0 * kDegree, 1e-14);
    EXPECT_NEAR(s.drive.start.latitude_rad, 31.0 * kDegree, 1e-14);
    EXPECT_NEAR(s.drive.start.longitude_rad, 41.0 * kDegree, 1e-14);
    EXPECT_EQ(s.drive.start.height_m, 51.0);
    EXPECT_EQ(s.drive.ramp_s, 0.7);
    ASSERT_EQ(s.drive.segments.size(), 4U);
    EXPECT_NEAR(s.drive.segments[1].rate_rad_s, -7.0 * kDegree, 1e-14);
    EXPECT_EQ(s.drive.segments[1].duration_s, 5.0);
    EXPECT_EQ(s.drive.segments[2].until_speed_m_s, 13.0);
    EXPECT_EQ(s.drive.segments[2].acceleration_m_s2, 1.5);
    EXPECT_EQ(s.drive.segments[3].kind, SegmentKind::Stop);
    EXPECT_EQ(s.drive.segments[3].acceleration_m_s2, 2.5);
    ASSERT_EQ(s.outages.size(), 2U);
    EXPECT_EQ(s.outages[1].start_s, 44.0);
    EXPECT_EQ(s.outages[1].duration_s, 9.0);
    EXPECT_EQ(s.gnss.rate_hz, 2.0);
    expect_vector(s.gnss.position_sd_m, 2.1, 2.2, 2.3, "fix position");
    expect_vector(s.gnss.velocity_sd_m_s, 0.11, 0.12, 0.13, "fix velocity");
    expect_vector(s.gnss.correlated_sd_m, 0.7, 0.8, 0.9, "correlated error");
    EXPECT_EQ(s.gnss.correlation_time_s, 33.0);
    EXPECT_EQ(s.gnss.latency_s, 0.14);
    expect_vector(s.gnss.lever_arm_m, 0.5, -0.6, -1.2, "lever arm");
    expect_vector(s.initial.position_sd_m, 3.1, 3.2, 3.3, "initial position");
    expect_vector(s.initial.velocity_sd_m_s, 0.31, 0.32, 0.33, "initial velocity");
    EXPECT_NEAR(s.initial.tilt_sd_rad, 1.6 * kDegree, 1e-15);
    EXPECT_NEAR(s.initial.heading_sd_rad, 2.6 * kDegree, 1e-15);
    expect_every_truth_member(s.truth);
    expect_every_hardware_member(s.hardware);
    expect_every_filter_member(s);
  }
}

/// The pointer of the only fault of the document after `change`.
std::string fault_after(const std::function<void(Json&)>& change) {
  Json document = *parse_json(kEveryMember);
  change(document);
  Faults faults;
  (void)scenario_from_json(document, "", faults);
  if (faults.none()) {
    return "none";
  }
  const Error error = faults.error();
  return error.fields.size() == 1 ? error.fields.front().name : error.message;
}

TEST(ScenarioDocument, RefusesWhatItWouldOtherwiseRunAsSomethingElse) {
  EXPECT_EQ(fault_after([](Json& /*d*/) {}), "none");
  EXPECT_EQ(fault_after([](Json& d) { d["gnss_velocity"] = "unused"; }), "/gnss_velocity");
  EXPECT_EQ(fault_after([](Json& d) { d["gnss"]["white"] = false; }), "/gnss/white");
  const char* const add = "filters_without_gm_states_add_slow_gm_to_initial_bias_sd";
  EXPECT_EQ(fault_after([&](Json& d) { d["initial"][add] = false; }), std::string("/initial/") + add);
  EXPECT_EQ(fault_after([](Json& d) {
              d["truth"]["gyro"] = Json{{"model", "Table 4, iPhone 5S, every axis"}, {"condition", "static"}};
            }),
            "/truth/gyro/condition");
  EXPECT_EQ(fault_after([](Json& d) { d["truth"]["gyro"]["y"]["processes"] = d["truth"]["gyro"]["x"]["processes"]; }),
            "/truth/gyro/y/by_rate");
  EXPECT_EQ(fault_after([](Json& d) {
              const Json outage = d["outages"][0];
              d["outages"] = Json::array();
              for (int i = 0; i < 1001; ++i) {
                d["outages"].push_back(outage);
              }
            }),
            "/outages");
  EXPECT_EQ(fault_after([](Json& d) { d["outages"][1]["duration_s"] = -9; }), "/outages/1/duration_s");
  EXPECT_EQ(fault_after([](Json& d) { d["outages"] = Json{{"start", "turn onset"}, {"duration_s", -1}}; }),
            "/outages/duration_s");
  EXPECT_EQ(fault_after([](Json& d) { d["outages"][1]["start_s"] = 25; }), "/outages") << "they overlap";
  const std::string segments = "/trajectory/segments_by_start_time/";
  const auto segment = [](Json& d, int i) -> Json& {
    return d["trajectory"]["segments_by_start_time"][static_cast<std::size_t>(i)];
  };
  EXPECT_EQ(fault_after([&](Json& d) { segment(d, 2)["duration_s"] = -1; }), segments + "2/duration_s");
  EXPECT_EQ(fault_after([&](Json& d) { segment(d, 2)["until_speed_m_s"] = -1; }), segments + "2/until_speed_m_s");
  EXPECT_EQ(fault_after([&](Json& d) { segment(d, 3)["t_s"] = 21; }), segments + "3") << "still accelerating";
  EXPECT_EQ(fault_after([&](Json& d) { segment(d, 0)["duration_s"] = 0; }), segments + "0");
  EXPECT_EQ(fault_after([](Json& d) { d["filters"] = "all"; }), "/filters");
}

TEST(ScenarioDocument, RefusesFiltersThatCannotBeMade) {
  // Found before the job, not by it.
  EXPECT_EQ(fault_after([](Json& d) {
              const Json flicker{{"process", "flicker_noise"}, {"params", {{"B", 1e-4}}}};
              d["filters"][1]["gyro"]["processes"] = Json::array({flicker, flicker});  // 32 states on one axis
            }),
            "/filters/1");
  EXPECT_EQ(fault_after([](Json& d) { d["filters"][0]["covariance_samples"] = 0; }), "/filters/0");
  EXPECT_EQ(fault_after([](Json& d) { d["filters"][0]["covariance_samples"] = 101; }), "/filters/0");
  EXPECT_EQ(fault_after([](Json& d) { d["initial"]["tilt_sd_deg"] = 0; }), "/filters/0");
}

}  // namespace
}  // namespace driftlab
