#include "core/analysis/implied_model.hpp"

#include "core/process/registry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

using investigate::Baseline;
using testing::ElementsAre;

constexpr double kDt = 0.01;

StoredChannel gyro() {
  StoredChannel channel;
  channel.told.channel = "gz";
  channel.told.quantity = "angular_rate";
  channel.told.unit = "rad/s";
  channel.told.dt_s = kDt;
  for (const double half : {1.0, 64.0, 4096.0}) {
    channel.allan.tau_s.push_back(half * kDt);
    channel.allan.deviation.emplace_back(1.0);
    channel.allan.low.emplace_back(0.9);
    channel.allan.high.emplace_back(1.1);
  }
  return channel;
}

Baseline white(double n) {
  Baseline model;
  model.automatic = false;
  model.processes = {*make_process("white_noise", {n})};
  return model;
}

TEST(ImpliedByModel, AddsTheDriftAndTheEffectsThatAreProcesses) {
  // sigma^2(tau) = N^2/tau + K^2 tau/3 + R^2 tau^2/2 (IEEE Std 952, annex C), with the N that the effect states.
  constexpr double kN = 3e-4;
  constexpr double kK = 2e-5;
  constexpr double kR = 1e-6;
  Baseline model = white(1.0);
  model.drift["gz"] = kR;
  model.effects = {{"random_walk", {}, {}, {kK}}, {"white_noise_level", {"gz"}, {}, {kN}}};
  const auto implied = implied_by(model, gyro());
  ASSERT_TRUE(implied) << implied.error().message;
  EXPECT_TRUE(implied->left_out.empty());
  const MeasuredOverModel& at = implied->beside.at_measured;
  for (std::size_t i = 0; i < at.tau_s.size(); ++i) {
    const double tau = at.tau_s[i];
    const double expected = std::sqrt(kN * kN / tau + kK * kK * tau / 3.0 + 0.5 * kR * kR * tau * tau);
    // The random walk of samples differs from that of continuous time by 1/(2 m^2) of its own part.
    EXPECT_NEAR(at.deviation[i], expected, 1e-3 * expected) << tau;
    EXPECT_NEAR(at.ratio[i].value_or(0.0), 1.0 / at.deviation[i], 1e-9) << tau;
  }
}

TEST(ImpliedByModel, NamesWhatHasNoCurve) {
  Baseline model = white(3e-4);
  model.effects = {{"periodic_disturbance", {}, {}, {12.0, 1e-3}},
                   {"periodic_disturbance", {"gz"}, {}, {15.0, 1e-3}},
                   {"random_walk", {}, {"rec_a"}, {2e-5}},
                   {"bias_step", {"gx"}, {}, {1e-3}}};
  for (const char* const column : {"gz", "gx"}) {
    model.unnamed.emplace_back().column = column;
  }
  const auto implied = implied_by(model, gyro());
  ASSERT_TRUE(implied) << implied.error().message;
  EXPECT_THAT(implied->left_out, ElementsAre("periodic_disturbance", "random_walk", "unnamed"));
  EXPECT_EQ(implied->processes.size(), 1U);
}

TEST(ImpliedByModel, TakesTheProcessesOfTheColumnItself) {
  Baseline model = white(3e-4);
  model.by_channel["gz"] = {*make_process("white_noise", {5e-4})};
  model.quantity_by_channel["gz"] = Quantity::AngularRate;
  const auto implied = implied_by(model, gyro());
  ASSERT_TRUE(implied) << implied.error().message;
  EXPECT_NEAR(implied->beside.at_measured.deviation.front(), 5e-4 / std::sqrt(kDt), 1e-12);
}

TEST(ImpliedByModel, SaysNothingOfAnotherColumnOrSensor) {
  Baseline other = white(3e-4);
  other.by_channel["gx"] = other.processes;
  other.quantity_by_channel["gx"] = Quantity::AngularRate;
  Baseline accelerometer = white(3e-4);
  accelerometer.quantity = Quantity::SpecificForce;
  Baseline named_alike = white(3e-4);
  named_alike.by_channel["gz"] = named_alike.processes;
  named_alike.quantity_by_channel["gz"] = Quantity::SpecificForce;
  for (const Baseline& model : {other, accelerometer, named_alike}) {
    const auto implied = implied_by(model, gyro());
    ASSERT_FALSE(implied);
    EXPECT_EQ(implied.error().code, ErrorCode::NotFound);
  }
  StoredChannel without = gyro();
  without.allan = {};
  EXPECT_FALSE(implied_by(white(3e-4), without));
}

}  // namespace
}  // namespace driftlab
