#include "schema/json/outage_scenario.hpp"

#include "core/navigate/paper_scenario.hpp"
#include "schema/json/error_model.hpp"
#include "schema/json/outage_evaluation.hpp"
#include "tests/shared_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

namespace driftlab {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

TEST(ErrorModel, ReadsWhatIsWritten) {
  for (const Dimension dimension : {Dimension::AngularRate, Dimension::SpecificForce}) {
    const Model model{*make_process("quantization_noise", {1e-5}), *make_process("white_noise", {1e-4}),
                      *make_process("flicker_noise", {1e-4}),      *make_process("gauss_markov", {1e-3, 0.5}),
                      *make_process("random_walk", {1e-6}),        *make_process("linear_drift", {-1e-7}),
                      *make_process("sinusoid", {1e-3, 2.0})};
    Faults faults;
    const Model back = model_from_json(to_json(model, dimension), dimension, "", faults);
    ASSERT_TRUE(faults.none()) << faults.error().message;
    for (std::size_t i = 0; i < model.size(); ++i) {
      for (std::size_t p = 0; p < model[i].parameters.size(); ++p) {
        EXPECT_NEAR(back[i].parameters[p], model[i].parameters[p], 1e-14 * std::fabs(model[i].parameters[p]));
      }
    }
  }
}

/// Two scenarios that give the same figures to rounding.
void expect_same(const OutageScenario& a, const OutageScenario& b) {
  ASSERT_EQ(a.filters.size(), b.filters.size());
  ASSERT_EQ(a.outages.size(), b.outages.size());
  ASSERT_EQ(a.drive.segments.size(), b.drive.segments.size());
  for (std::size_t f = 0; f < a.filters.size(); ++f) {
    EXPECT_EQ(a.filters[f].name, b.filters[f].name);
    for (std::size_t c = 0; c < kImuChannels; ++c) {
      const AxisModel& x = a.filters[f].settings.imu.axes[c];
      const AxisModel& y = b.filters[f].settings.imu.axes[c];
      EXPECT_NEAR(x.bias_sd, y.bias_sd, 1e-12) << a.filters[f].name << " axis " << c;
      ASSERT_EQ(x.processes.size(), y.processes.size()) << a.filters[f].name << " axis " << c;
      for (std::size_t band = 0; band < x.processes.size(); ++band) {
        ASSERT_EQ(x.processes.model(band).size(), y.processes.model(band).size());
        for (std::size_t k = 0; k < x.processes.model(band).size(); ++k) {
          EXPECT_NEAR(x.processes.model(band)[k].parameters[0], y.processes.model(band)[k].parameters[0],
                      1e-12 * x.processes.model(band)[k].parameters[0]);
        }
      }
    }
  }
  EXPECT_EQ(a.filters[0].settings.use_velocity, b.filters[0].settings.use_velocity);
  EXPECT_EQ(a.filters[0].settings.non_holonomic.has_value(), b.filters[0].settings.non_holonomic.has_value());
}

TEST(ScenarioDocument, SurvivesTheWayThroughJson) {
  for (const std::string& name : scenario_names()) {
    const OutageScenario scenario = *paper_scenario(name);
    Faults faults;
    const OutageScenario back = scenario_from_json(to_json(scenario), "", faults);
    ASSERT_TRUE(faults.none()) << faults.error().message;
    expect_same(scenario, back);
  }
}

TEST(ScenarioDocument, TheSharedPaperScenarioIsTheOneByName) {
  const auto folder = shared_folder("spec");
  if (!folder) {
    GTEST_SKIP() << "SKIPPED: no scenario; set DRIFTLAB_SHARED to the directory that holds spec/";
  }
  const std::ifstream file(*folder / "spec" / "scenario-paper.json");
  std::ostringstream text;
  text << file.rdbuf();
  Faults faults;
  const OutageScenario scenario = scenario_from_json(*parse_json(text.str()), "", faults);
  ASSERT_TRUE(faults.none()) << faults.error().message;
  expect_same(*paper_scenario("paper"), scenario);
  EXPECT_NEAR(scenario.initial.heading_sd_rad, 3.0 * kDegree, 1e-15);
}

TEST(ScenarioDocument, NamesEveryFaultByItsPlace) {
  Faults faults;
  (void)scenario_from_json(
      *parse_json(R"({"duration_s": 60, "trajectory": {"segments_by_start_time": [{"t_s": 1, "kind": "loop"}]},
    "outages": {"start": "noon", "duration_s": 5}, "truth": {"gyro": {"model": "Table 9"}, "accelerometer": {}}, "filters": []})"),
      "/scenario", faults);
  const Error error = faults.error();
  std::string named;
  for (const ErrorField& field : error.fields) {
    named.append(field.name).append(" ");
  }
  EXPECT_NE(named.find("/scenario/trajectory/segments_by_start_time/0/kind"), std::string::npos) << named;
  EXPECT_NE(named.find("/scenario/outages/start"), std::string::npos) << named;
  EXPECT_NE(named.find("/scenario/truth/gyro/model"), std::string::npos) << named;
}

TEST(ScenarioDocument, ARecordedDriveLooksWhereItGoesAndKeepsItsLength) {
  const Json document = *parse_json(R"({"name": "recorded", "imu_rate_hz": 20,
    "trajectory": {"recorded": {"time_s": [100, 110, 120, 130, 140],
      "velocity_ned_m_s": [[0, 0, 0], [10, 0, 0], [7, 7, 0], [0, 10, -0.5], [0, 10, 0]]}},
    "outages": [{"start_s": 20, "duration_s": 10}],
    "truth": {"gyro": {"processes": [{"process": "white_noise", "params": {"N": 1e-4}}]},
              "accelerometer": {"white_noise_mg_per_sqrt_hz": 2}},
    "filters": [{"name": "matched"}]})");
  Faults faults;
  const OutageScenario scenario = scenario_from_json(document, "", faults);
  ASSERT_TRUE(faults.none()) << faults.error().message;
  EXPECT_EQ(scenario.drive.duration_s, 40.0);
  ASSERT_EQ(scenario.recorded.size(), 5U);
  EXPECT_EQ(scenario.recorded[0].attitude.heading_rad, 0.0);
  EXPECT_NEAR(scenario.recorded[2].attitude.heading_rad, 45.0 * kDegree, 1e-12);
  EXPECT_NEAR(scenario.recorded[3].attitude.pitch_rad, std::atan(0.05), 1e-12);
  OutageOptions options;
  options.runs = 2;
  const auto evaluation = evaluate_outages(scenario, options);
  ASSERT_TRUE(evaluation) << evaluation.error().message;
  // The path is the integral of the velocities: 5 + 8.5 + 3.5 s north times 10 m/s, give or take what the spline bends.
  EXPECT_NEAR(evaluation->truth.north_m.back(), 170.0, 15.0);
  EXPECT_EQ(evaluation->truth.time_s.back(), 40.0);
  Faults again;
  const OutageScenario back = scenario_from_json(to_json(scenario), "", again);
  ASSERT_TRUE(again.none()) << again.error().message;
  EXPECT_EQ(back.recorded.size(), 5U);
  EXPECT_NEAR(back.recorded[3].attitude.pitch_rad, scenario.recorded[3].attitude.pitch_rad, 1e-12);

  Json bad = document;
  bad["trajectory"]["recorded"]["heading_deg"] = {1, 2};
  bad["duration_s"] = 50;
  Faults named;
  (void)scenario_from_json(bad, "", named);
  ASSERT_FALSE(named.none());
  EXPECT_EQ(named.error().fields.front().name, "/trajectory/recorded/heading_deg");
}

TEST(EvaluationDocument, HoldsEllipsesAndClaims) {
  OutageScenario scenario = *paper_scenario("paper");
  scenario.drive.duration_s = 102.0;
  std::erase_if(scenario.drive.segments, [](const Segment& s) { return s.start_s > 100.0; });
  scenario.outages.resize(1);
  scenario.imu_rate_hz = 20.0;
  OutageOptions options;
  options.runs = 3;
  const OutageReport report = *report_outages(scenario, options);
  const Json document = to_json(report);
  const Json& outage = document["filters"][0]["outages"][0];
  EXPECT_EQ(outage["errors"]["north_m"].size(), 3U);
  EXPECT_GT(outage["predicted"]["ellipses"][1]["semi_major_m"], outage["predicted"]["ellipses"][0]["semi_major_m"]);
  EXPECT_EQ(document["claims"].size(), 6U);
}

}  // namespace
}  // namespace driftlab
