#include "schema/json/simulation_model.hpp"

#include "core/investigate/causes/cause.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

investigate::Baseline read(const char* text, bool& sound) {
  Faults faults;
  auto model = simulation_model_from_json(*parse_json(text), "", faults);
  sound = faults.none();
  return model;
}

TEST(SimulationModel, IsReadInSi) {
  bool sound = false;
  const auto model = read(
      R"json({"name": "ignored", "processes": [{"process": "white_noise", "params": {"N": {"value": 60, "unit": "deg/sqrt(h)"}}}],
          "channels": {"gx": {"processes": [{"process": "gauss_markov",
                        "params": {"sigma": {"value": 1, "unit": "deg/s"}, "beta": {"value": 0.5, "unit": "1/s"}}}]}},
          "deterministic": {"gx": {"bias": {"value": 2, "unit": "deg/s"}, "drift": {"value": 3, "unit": "deg/s/s"}}},
          "effects": [{"cause": "scale_factor_error", "channels": ["gx"], "params": {"S": {"value": 250, "unit": "ppm", "ci95": [1, null]}}},
                      {"cause": "temperature_bias", "recordings": ["a"], "params": {"coefficient": {"value": 1, "unit": "deg/s/degC"},
                                                                                    "lag_s": {"value": 7, "unit": "s"}}},
                      {"cause": "scale_factor_nonlinearity", "params": {"S3": {"value": 1e-9, "unit": "s^2/deg^2"}}}]
})json",
      sound);
  ASSERT_TRUE(sound);
  EXPECT_FALSE(model.automatic);
  EXPECT_NEAR(model.processes[0].parameters[0], kDegree, 1e-12);  // 60 deg/sqrt(h) = 1 deg/sqrt(s)
  ASSERT_EQ(model.by_channel.count("gx"), 1U);
  EXPECT_NEAR(model.by_channel.at("gx")[0].parameters[0], kDegree, 1e-12);
  EXPECT_NEAR(model.bias.at("gx"), 2.0 * kDegree, 1e-12);
  EXPECT_NEAR(model.drift.at("gx"), 3.0 * kDegree, 1e-12);
  ASSERT_EQ(model.effects.size(), 3U);
  EXPECT_NEAR(model.effects[0].values[0], 250e-6, 1e-15);
  EXPECT_NEAR(model.effects[1].values[0], kDegree, 1e-12);
  EXPECT_EQ(model.effects[1].values[1], 7.0);
  EXPECT_EQ(model.effects[1].recordings, std::vector<std::string>{"a"});
  EXPECT_EQ(model.effects[2].values[1], 3.0);  // the power of the rate is the template's shape
}

/// The effect of an extended model acted on a channel called "s]", and so on none.
TEST(SimulationModel, AnEffectNamesColumnsThatHoldASlash) {
  investigate::Report report;
  investigate::Finding finding;
  finding.evidence.cause = investigate::find_cause("bias_step");
  finding.channels = {{"night/1", "gz [deg/s]"}};
  finding.everywhere = false;
  report.findings.push_back(std::move(finding));
  const Json effect = extended_json(report).at("effects").at(0);
  EXPECT_EQ(effect.at("channels"), Json::array({"gz [deg/s]"}));
  EXPECT_EQ(effect.at("recordings"), Json::array({"night/1"}));
}

TEST(SimulationModel, EveryParameterOfEveryCauseComesBack) {
  for (const investigate::Cause& cause : investigate::cause_registry()) {
    for (const char* const sensor : {"deg/s", "m/s^2"}) {
      Json document = *parse_json(
          R"json({"processes": [{"process": "white_noise", "params": {"N": {"value": 1, "unit": "deg/sqrt(h)"}}}],
              "effects": [{"cause": "", "params": {}}]
})json");
      document["effects"][0]["cause"] = std::string(cause.name);
      for (const auto& parameter : cause.parameters) {
        Json value = Json::object();
        value["value"] = 3.5;
        value["unit"] = parameter.unit(*parse_unit(sensor)).symbol;
        document["effects"][0]["params"][std::string(parameter.name)] = value;
      }
      Faults faults;
      const auto model = simulation_model_from_json(document, "", faults);
      ASSERT_TRUE(faults.none()) << cause.name;
      ASSERT_EQ(model.effects.size(), 1U) << cause.name;
      if (cause.parameters.empty()) {
        continue;  // a turned sign has no size
      }
      EXPECT_NEAR(model.effects[0].values[0] * cause.parameters[0].unit(*parse_unit(sensor)).per_si, 3.5, 1e-9)
          << cause.name;
    }
  }
}

/// A `bias_step` that lost its `step` was read as a step of `t0_s` at time zero.
TEST(SimulationModel, AMissingParameterIsAFaultAndShiftsNothing) {
  for (const investigate::Cause& cause : investigate::cause_registry()) {
    const auto* const mean = cause.as<investigate::MeanEffect>();
    const bool alternatives = mean != nullptr && !mean->shape_of_parameter.empty();
    for (std::size_t lost = 0; lost < cause.parameters.size() && !alternatives; ++lost) {
      Json params = Json::object();
      for (std::size_t k = 0; k < cause.parameters.size(); ++k) {
        const auto& parameter = cause.parameters[k];
        if (k != lost) {
          params[std::string(parameter.name)] =
              Json{{"value", 2.0}, {"unit", parameter.unit(*parse_unit("deg/s")).symbol}};
        }
      }
      Json document = *parse_json(
          R"json({"processes": [{"process": "white_noise", "params": {"N": {"value": 1, "unit": "deg/sqrt(h)"}}}]})json");
      document["effects"] = Json{{{"cause", std::string(cause.name)}, {"params", std::move(params)}}};
      Faults faults;
      const auto model = simulation_model_from_json(document, "/model", faults);
      const std::string name(cause.parameters[lost].name);
      ASSERT_FALSE(faults.none()) << cause.name << " " << name;
      EXPECT_EQ(faults.error().message, "The parameter " + name + " of " + std::string(cause.name) + " is missing.");
      EXPECT_EQ(faults.error().fields.front().name, "/model/effects/0/params/" + name);
      EXPECT_TRUE(model.effects.empty());
    }
  }
}

TEST(SimulationModel, FaultsAreRefused) {
  for (
      const char* const text :
      {R"json({})json", R"json({"processes": []})json",
       R"json({"processes": [{"process": "magic", "params": {}}]})json",
       R"json({"processes": [{"process": "white_noise", "params": {}}]})json",
       R"json({"processes": [{"process": "white_noise", "params": {"N": {"value": 1, "unit": "deg"}}}]})json",
       R"json({"processes": [{"process": "white_noise", "params": {"N": {"value": -1, "unit": "deg/sqrt(h)"}
}
}]
})json",
       R"json({"processes": [{"process": "white_noise", "params": {"N": {"value": 1, "unit": "deg/sqrt(h)"}}}], "effects": [{"cause": "x", "params": {}}]
})json",
       R"json({"processes": [{"process": "white_noise", "params": {"N": {"value": 1, "unit": "deg/sqrt(h)"}}}], "effects": [{"cause": "bias_step", "params": {}}]
})json"}) {
    bool sound = true;
    (void)read(text, sound);
    EXPECT_FALSE(sound) << text;
  }
}

TEST(Baseline, WhatIsStoredNeedsTheDaemon) {
  for (const char* const text :
       {R"json({"kind": "fit", "id": "fit_1"})json", R"json({"kind": "model", "id": "mod_1"})json"}) {
    Faults faults;
    (void)baseline_from_json(*parse_json(text), "/baseline", faults);
    ASSERT_FALSE(faults.none());
    EXPECT_NE(faults.error().message.find("daemon"), std::string::npos);
  }
  Faults faults;
  EXPECT_TRUE(baseline_from_json(*parse_json(R"json({"kind": "auto"})json"), "", faults).automatic);
  EXPECT_TRUE(faults.none());
}

}  // namespace
}  // namespace driftlab
