/// Strong flicker noise was once named jumps between two levels, and noise behind a low-pass or in a narrow band once
/// vibration that comes and goes. Both names are claims that noise is not Gaussian or not stationary: on noise that is
/// both they are silent, whatever its spectrum and however strong it is.
#include "core/investigate/investigate.hpp"
#include "tests/hidden/simulated_study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <tuple>

namespace driftlab::hidden {
namespace {

using namespace investigate;

bool is_claimed(const Evidence& evidence) {
  const auto claims = [](const Evidence& e) {
    return e.cause->name == "random_telegraph_noise" || e.cause->name == "vibration_bursts";
  };
  return claims(evidence) || std::any_of(evidence.rivals.begin(), evidence.rivals.end(), claims);
}

void expect_silence(const Study& study, const std::string& what) {
  const auto report = investigate::investigate(study, {.predict_outages = false});
  ASSERT_TRUE(report);
  for (const Finding& finding : report->findings) {
    EXPECT_FALSE(is_claimed(finding.evidence)) << what << ": " << finding.explanation;
  }
}

class SlowNoiseOfOneKind : public testing::TestWithParam<std::tuple<const char*, bool, double>> {};

TEST_P(SlowNoiseOfOneKind, IsNoJumpAndNoBurst) {
  const auto [cause, given, z] = GetParam();
  for (std::uint64_t seed = 5101; seed <= 5103; ++seed) {
    Case hidden = make_case(cause, z, seed);
    hidden.world.given = given;
    const SimulatedStudy simulated = simulate_study(hidden.world, {hidden.effect});
    expect_silence(simulated.study, std::to_string(seed));
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, SlowNoiseOfOneKind,
                         testing::Combine(testing::Values("flicker_noise", "gauss_markov", "random_walk",
                                                          "band_limited_noise"),
                                          testing::Bool(), testing::Values(30.0, 150.0)),
                         [](const auto& instance) {
                           return std::string(std::get<0>(instance.param)) +
                                  (std::get<1>(instance.param) ? "_given_" : "_automatic_") +
                                  (std::get<2>(instance.param) > 100.0 ? "very_strong" : "strong");
                         });

/// White noise that drives a damped oscillation, written here a second time: a complex autoregression of first order,
/// whose real part rings.
void add_ringing(std::vector<double>& reading, double rms, double frequency_hz, double quality, double rate_hz,
                 Random& random) {
  const double damping = std::exp(-std::numbers::pi * frequency_hz / quality / rate_hz);
  const double turn = 2.0 * std::numbers::pi * frequency_hz / rate_hz;
  const double step = std::sqrt(1.0 - damping * damping);
  std::complex<double> state(random.normal(), random.normal());
  for (double& value : reading) {
    value += rms * state.real();
    state = state * std::polar(damping, turn) + step * std::complex<double>(random.normal(), random.normal());
  }
}

class NarrowNoise : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(NarrowNoise, IsNoBurst) {
  const auto [quality, level] = GetParam();
  constexpr double kRate = 50.0;
  for (std::uint64_t seed = 5201; seed <= 5203; ++seed) {
    Random random(seed, 3);
    const double frequency = 4.0 + 16.0 * random.uniform();
    Study study;
    std::deque<std::vector<double>> memory;
    for (std::size_t r = 0; r < 2; ++r) {
      std::vector<double>& reading = memory.emplace_back(std::size_t{25000});
      for (double& value : reading) {
        value = 0.1 * random.normal();
      }
      add_ringing(reading, 0.1 * level, frequency, quality, kRate, random);
      RecordingSpec spec;
      spec.id = "static-" + std::to_string(r + 1);
      spec.rate_hz = kRate;
      spec.condition.kind = ConditionKind::Static;
      spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
      auto recording = make_study_recording(spec, {"gz"}, reading.size(),
                                            [&](std::size_t) { return std::span<const double>(reading); });
      ASSERT_TRUE(recording);
      study.recordings.push_back(std::move(*recording));
    }
    settle_channels(study);
    expect_silence(study, std::to_string(seed) + " at " + std::to_string(frequency) + " Hz");
  }
}

/// From wide to nearly a line; a third of the noise's deviation, and as much as it.
INSTANTIATE_TEST_SUITE_P(Qualities, NarrowNoise,
                         testing::Combine(testing::Values(5.0, 50.0, 500.0), testing::Values(0.3, 1.0)));

}  // namespace
}  // namespace driftlab::hidden
