/// An extended model, written down and read again, is a baseline that says all there is to say about its study; and a
/// recording simulated from it shows the effect again.
#include "core/investigate/investigate.hpp"
#include "core/investigate/search/simulate_channel.hpp"
#include "schema/json/simulation_model.hpp"
#include "tests/hidden/simulated_study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace driftlab::hidden {
namespace {

using namespace investigate;

class Revision : public testing::TestWithParam<std::string> {};

/// One cause for each way in which a baseline can hold an effect: taken off the mean, added to the noise, a level, or
/// found again and confirmed.
TEST_P(Revision, ExplainsTheStudyItCameFrom) {
  const Case hidden = make_case(GetParam(), 30.0, 1030);
  SimulatedStudy simulated = simulate_study(hidden.world, {hidden.effect});
  const auto first = investigate::investigate(simulated.study);
  ASSERT_TRUE(first);
  ASSERT_FALSE(first->findings.empty());
  Faults faults;
  Json document = extended_json(*first);
  document["kind"] = "model";
  simulated.study.baseline = baseline_from_json(document, "", faults);
  ASSERT_TRUE(faults.none()) << faults.error().message;
  const auto second = investigate::investigate(simulated.study);
  ASSERT_TRUE(second);
  for (const Finding& finding : second->findings) {
    EXPECT_NE(finding.evidence.cause, first->findings.front().evidence.cause) << finding.explanation;
  }
}

INSTANTIATE_TEST_SUITE_P(Causes, Revision,
                         testing::Values("temperature_bias", "bias_step", "gauss_markov", "white_noise_level",
                                         "periodic_disturbance", "heavy_tailed_noise", "output_resolution",
                                         "rate_dependent_noise"),
                         [](const auto& instance) { return instance.param; });

Baseline model_with(const std::string& cause, std::vector<double> values) {
  Baseline model;
  model.automatic = false;
  model.processes = {*make_process("white_noise", {1e-4}), *make_process("gauss_markov", {1e-4, 0.1})};
  model.bias["gz"] = 0.5;
  model.effects.push_back({cause, {"gz"}, {}, std::move(values)});
  return model;
}

TEST(SimulatedChannel, ShowsBiasAndEffectAndNamesWhatItLeavesOut) {
  World world;
  world.scenario = Scenario::Rates;
  const SimulatedStudy simulated = simulate_study(world, {});
  const StudyRecording& still = simulated.study.recordings.front();
  const ColumnRole role{Quantity::AngularRate, "z", *parse_unit("deg/s")};
  const auto stepped = simulate_channel(model_with("bias_step", {0.25, 300.0}), still, "gz", role, 7);
  EXPECT_TRUE(stepped.left_out.empty());
  ASSERT_EQ(stepped.reading.size(), still.length);
  const auto mean = [&](std::size_t from, std::size_t to) {
    double sum = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      sum += stepped.reading[i];
    }
    return sum / static_cast<double>(to - from);
  };
  // 300 s of white noise and of a process with 20 s of independent memory: 1e-4/sqrt(300) and 1e-4 sqrt(20/300).
  EXPECT_NEAR(mean(0, still.length / 2), 0.5, 2e-4);
  EXPECT_NEAR(mean(still.length / 2, still.length), 0.75, 2e-4);
  const auto again = simulate_channel(model_with("bias_step", {0.25, 300.0}), still, "gz", role, 7);
  EXPECT_EQ(stepped.reading, again.reading);
  const auto cold = simulate_channel(model_with("temperature_bias", {1.0, 0.0}), still, "gz", role, 7);
  ASSERT_EQ(cold.left_out.size(), 1U);
  EXPECT_NE(cold.left_out[0].find("temperature"), std::string::npos);
}

}  // namespace
}  // namespace driftlab::hidden
