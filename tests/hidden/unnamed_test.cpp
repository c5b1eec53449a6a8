/// Effects that no cause of the registry describes, put into recordings by code of this file: the report has to say
/// that something is left, to carry it in the extended model without a name, and to claim what the profile is worth on
/// recordings that nobody has seen. Where nothing is hidden the model stays as it is.
#include "core/investigate/fullrate/spectrum.hpp"
#include "core/investigate/investigate.hpp"
#include "core/investigate/search/simulate_channel.hpp"
#include "core/process/random.hpp"
#include "schema/json/simulation_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <deque>
#include <functional>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

namespace driftlab::investigate {
namespace {

constexpr double kRate = 50.0;
constexpr std::size_t kSamples = 30'000;
constexpr double kNoise = 0.1;  // [deg/s], of a sample

/// A recording's course of the temperature, other than any other recording's [degC].
double temperature(std::size_t recording, double t) {
  const double phase = 1.7 * static_cast<double>(recording);
  return 30.0 + 8.0 * std::sin(2.0 * std::numbers::pi * t / (310.0 + 40.0 * static_cast<double>(recording)) + phase);
}

/// Readings of one recording [deg/s].
using Sensor = std::function<std::vector<double>(std::size_t recording, std::uint64_t seed)>;

std::vector<double> white(std::uint64_t seed) {
  Random random(seed);
  std::vector<double> noise(kSamples);
  for (double& value : noise) {
    value = kNoise * random.normal();
  }
  return noise;
}

struct Made {
  Study study;
  std::deque<std::vector<double>> memory;
};

Made study_of(const Sensor& sensor, std::uint64_t seed, std::size_t recordings = 3) {
  Made made;
  for (std::size_t r = 0; r < recordings; ++r) {
    const std::vector<double>& reading = made.memory.emplace_back(sensor(r, 100 * seed + r));
    std::vector<double>& warmth = made.memory.emplace_back(kSamples);
    for (std::size_t i = 0; i < kSamples; ++i) {
      warmth[i] = temperature(r, static_cast<double>(i) / kRate);
    }
    RecordingSpec spec;
    spec.id = "rest-" + std::to_string(r + 1);
    spec.rate_hz = kRate;
    spec.condition.kind = ConditionKind::Static;
    spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
    spec.columns["T"] = {Quantity::Temperature, "", *parse_unit("degC")};
    auto recording = make_study_recording(spec, {"gz", "T"}, kSamples, [&](std::size_t column) {
      return std::span<const double>(column == 0 ? reading : warmth);
    });
    EXPECT_TRUE(recording) << recording.error().message;
    made.study.recordings.push_back(std::move(*recording));
  }
  made.study.id = "unnamed";
  settle_channels(made.study);
  return made;
}

Report investigated(const Study& study) {
  auto report = investigate(study, {.predict_outages = false});
  EXPECT_TRUE(report);
  return report ? *std::move(report) : Report{};
}

std::string told(const Report& report) {
  std::string text = report.summary.sentence;
  for (const Unexplained& left : report.unexplained) {
    text += "\n  left: " + left.sentence;
  }
  for (const UnnamedFinding& found : report.unnamed) {
    text += "\n  unnamed, " + std::to_string(found.heldout_gain) + " nat: " + found.sentence;
  }
  return text;
}

/// By how much the noise's power grows with the temperature in a way that no cause has: it swells twice over the range.
double swelling(double degrees) { return 1.0 + 0.5 * std::sin(2.0 * std::numbers::pi * (degrees - 22.0) / 8.0); }

std::vector<double> swells_with_temperature(std::size_t recording, std::uint64_t seed) {
  std::vector<double> noise = white(seed);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    noise[i] *= std::sqrt(swelling(temperature(recording, static_cast<double>(i) / kRate)));
  }
  return noise;
}

/// A bias that goes twice up and down over the range of temperatures [deg/s].
double bias_at(double degrees) { return 0.03 * std::sin(2.0 * std::numbers::pi * (degrees - 22.0) / 8.0); }

std::vector<double> wavers_with_temperature(std::size_t recording, std::uint64_t seed) {
  std::vector<double> noise = white(seed);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    noise[i] += bias_at(temperature(recording, static_cast<double>(i) / kRate));
  }
  return noise;
}

/// Noise behind a filter that takes half of the power out of a wide band: a zero near the unit circle at 8 Hz, with a
/// pole behind it.
std::vector<double> lacks_a_band(std::size_t, std::uint64_t seed) {
  std::vector<double> noise = white(seed);
  const double turn = 2.0 * std::numbers::pi * 8.0 / kRate;
  constexpr double kZero = 0.80;
  constexpr double kPole = 0.55;
  double x1 = 0.0;
  double x2 = 0.0;
  double y1 = 0.0;
  double y2 = 0.0;
  for (double& value : noise) {
    const double x = value;
    const double y = x - 2.0 * kZero * std::cos(turn) * x1 + kZero * kZero * x2 + 2.0 * kPole * std::cos(turn) * y1 -
                     kPole * kPole * y2;
    x2 = x1;
    x1 = x;
    y2 = y1;
    y1 = y;
    value = y;
  }
  return noise;
}

struct Kind {
  const char* name;
  Sensor sensor;
  UnnamedKind kind;
  Against against;
};

std::vector<double> ratios_of(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  std::transform(a.begin(), a.end(), b.begin(), std::back_inserter(ratios), std::divides<>());
  return ratios;
}

/// Mean power in octaves of frequency from 0.1 Hz on, then of differences in four bins of temperature.
std::vector<double> power_in_bands(const Sensor& sensor) {
  constexpr std::size_t kOctaves = 8;
  std::vector<double> power(kOctaves + 4, 0.0);
  std::vector<double> count(power.size(), 0.0);
  for (std::size_t r = 0; r < 3; ++r) {
    const std::vector<double> reading = sensor(r, 31 + r);
    const std::vector<std::complex<double>> z = half_spectrum_of(Series::view(reading));
    for (std::size_t k = 1; k < z.size(); ++k) {
      const double octave = std::log2(static_cast<double>(k) * kRate / kSamples / 0.1);
      if (octave >= 0.0) {
        const auto band = std::min(static_cast<std::size_t>(octave), kOctaves - 1);
        power[band] += std::norm(z[k]);
        count[band] += 1.0;
      }
    }
    for (std::size_t i = 1; i < kSamples; ++i) {
      const double share = (temperature(r, static_cast<double>(i) / kRate) - 22.0) / 16.0;
      const std::size_t band = kOctaves + std::min<std::size_t>(static_cast<std::size_t>(4.0 * share), 3);
      power[band] += std::pow(reading[i] - reading[i - 1], 2.0);
      count[band] += 1.0;
    }
  }
  return ratios_of(power, count);
}

class EffectWithoutAName : public ::testing::TestWithParam<Kind> {};

TEST_P(EffectWithoutAName, IsCarriedInTheExtendedModel) {
  const Made made = study_of(GetParam().sensor, 7);
  const Report report = investigated(made.study);
  EXPECT_FALSE(report.unexplained.empty()) << told(report);
  ASSERT_FALSE(report.unnamed.empty()) << told(report);
  const UnnamedFinding& first = report.unnamed.front();
  EXPECT_EQ(first.effect.kind, GetParam().kind) << told(report);
  EXPECT_EQ(first.effect.against, GetParam().against) << told(report);
  EXPECT_TRUE(first.effect.recordings.empty()) << told(report);
  EXPECT_GT(first.heldout_gain, 20.0);
  // Read back from its document the model simulates what was measured.
  Faults faults;
  const Baseline model = simulation_model_from_json(extended_json(report), "", faults);
  ASSERT_TRUE(faults.none()) << faults.error().message;
  ASSERT_EQ(model.unnamed.size(), report.unnamed.size());
  for (std::size_t k = 0; k < first.effect.value.size(); ++k) {
    EXPECT_NEAR(model.unnamed.front().value[k], first.effect.value[k], 1e-9 * std::abs(first.effect.value[k]) + 1e-15);
    EXPECT_NEAR(model.unnamed.front().edge[k], first.effect.edge[k], 1e-9 * std::abs(first.effect.edge[k]));
  }
  const Sensor simulated = [&](std::size_t r, std::uint64_t seed) {
    const StudyRecording& own = made.study.recordings[r];
    SimulatedChannel channel = simulate_channel(model, own, "gz", own.channels.front().role, seed);
    for (double& value : channel.reading) {
      value *= 180.0 / std::numbers::pi;
    }
    return channel.reading;
  };
  // Power in bands of frequency and of temperature, simulated over measured.
  for (const double ratio : ratios_of(power_in_bands(simulated), power_in_bands(GetParam().sensor))) {
    EXPECT_NEAR(ratio, 1.0, 0.2) << told(report);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EffectWithoutAName,
                         ::testing::Values(Kind{"NoiseThatSwellsWithTemperature", swells_with_temperature,
                                                UnnamedKind::Variance, Against::Temperature},
                                           Kind{"BiasThatWaversWithTemperature", wavers_with_temperature,
                                                UnnamedKind::Mean, Against::Temperature},
                                           Kind{"NoiseThatLacksABand", lacks_a_band, UnnamedKind::Spectrum,
                                                Against::Frequency}),
                         [](const auto& given) { return std::string(given.param.name); });

TEST(ProfileWithoutAName, IsAMeanAsItIs) {
  const Report report = investigated(study_of(wavers_with_temperature, 9).study);
  ASSERT_FALSE(report.unnamed.empty()) << told(report);
  const UnnamedFinding& found = report.unnamed.front();
  ASSERT_EQ(found.effect.kind, UnnamedKind::Mean) << told(report);
  double along = 0.0;
  double square = 0.0;
  double own = 0.0;
  for (std::size_t k = 0; k < found.effect.value.size(); ++k) {
    const double truth = bias_at(found.middle[k] - 273.15);
    const double value = found.effect.value[k] * 180.0 / std::numbers::pi;
    along += truth * value;
    square += truth * truth;
    own += value * value;
  }
  EXPECT_GT(along / std::sqrt(square * own), 0.9) << "the shape";
  EXPECT_GT(along / square, 0.6) << "the size";
  EXPECT_LT(along / square, 1.1) << "the size";
  // What had followed the temperature is no noise of the extended model any more.
  const ChannelModel& model = report.models.front();
  const double tenth = slow_density(model.beside.noise, 0, 0.005, 1.0 / kRate, kSamples);
  EXPECT_LT(tenth, 0.2 * slow_density(model.alone.noise, 0, 0.005, 1.0 / kRate, kSamples));
}

TEST(ProfileWithoutAName, IsMeasuredAsItIs) {
  const Report report = investigated(study_of(swells_with_temperature, 9).study);
  ASSERT_FALSE(report.unnamed.empty()) << told(report);
  const UnnamedEffect& effect = report.unnamed.front().effect;
  double mean = 0.0;
  for (std::size_t k = 0; k < effect.value.size(); ++k) {
    mean += effect.value[k] / static_cast<double>(effect.value.size());
  }
  for (std::size_t k = 0; k < effect.value.size(); ++k) {
    // The mean over the temperatures of the bin, which is not even over them.
    double low = 10.0;
    double high = 0.0;
    for (double share = 0.0; share <= 1.0; share += 0.05) {
      const double there = swelling(effect.edge[k] + share * (effect.edge[k + 1] - effect.edge[k]) - 273.15);
      low = std::min(low, there);
      high = std::max(high, there);
    }
    EXPECT_GT(effect.value[k] / mean, low - 0.08) << k;
    EXPECT_LT(effect.value[k] / mean, high + 0.08) << k;
  }
  // What an oracle gains who knows the law, over the best constant level.
  double power = 0.0;
  double logs = 0.0;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t i = 0; i < kSamples; ++i) {
      const double ratio = swelling(temperature(r, static_cast<double>(i) / kRate));
      power += ratio;
      logs += std::log(ratio);
    }
  }
  const double samples = 3.0 * kSamples;
  const double oracle = 0.5 * (samples * std::log(power / samples) - logs);
  EXPECT_GT(report.unnamed.front().heldout_gain, 0.6 * oracle);  // a bin has the width of half a swelling
  EXPECT_LT(report.unnamed.front().heldout_gain, 1.05 * oracle);
}

constexpr double kPulsesEvery = 7.3;  // [s]
constexpr double kPulse = 0.14;       // [deg/s], 1.4 of the noise's deviations

/// Short pulses of which no line of the spectrum stands out.
std::vector<double> has_pulses(std::size_t, std::uint64_t seed) {
  std::vector<double> noise = white(seed);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    noise[i] += std::fmod(static_cast<double>(i) / kRate, kPulsesEvery) < 0.1 ? kPulse : 0.0;
  }
  return noise;
}

/// Noise that is half as large again for a fifth of every period.
std::vector<double> is_louder_at_times(std::size_t, std::uint64_t seed) {
  std::vector<double> noise = white(seed);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    noise[i] *= std::fmod(static_cast<double>(i) / kRate, 3.1) < 0.62 ? 1.5 : 1.0;
  }
  return noise;
}

TEST(ProfileWithoutAName, OfPulsesHasTheirPeriodAndTheirShape) {
  const Made made = study_of(has_pulses, 11);
  const Report report = investigated(made.study);
  EXPECT_FALSE(report.unexplained.empty()) << told(report);
  ASSERT_EQ(report.unnamed.size(), 3U) << told(report);  // each recording has a phase of its own
  for (const UnnamedFinding& found : report.unnamed) {
    ASSERT_EQ(found.effect.against, Against::Phase) << told(report);
    EXPECT_EQ(found.effect.kind, UnnamedKind::Mean) << told(report);
    EXPECT_NEAR(found.effect.period_s, kPulsesEvery, 1e-3 * kPulsesEvery);
    // What the pulse is worth in all: 5 samples of 1.4 deviations, 82 times.
    EXPECT_GT(found.heldout_gain, 0.4 * 0.5 * 5.0 * 1.96 * 82.0);
    EXPECT_LT(found.heldout_gain, 1.1 * 0.5 * 5.0 * 1.96 * 82.0);
  }
  // Simulated, the pulses are there again.
  Faults faults;
  const Baseline model = simulation_model_from_json(extended_json(report), "", faults);
  ASSERT_TRUE(faults.none()) << faults.error().message;
  const StudyRecording& own = made.study.recordings.front();
  const SimulatedChannel channel = simulate_channel(model, own, "gz", own.channels.front().role, 5);
  double on = 0.0;
  double off = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const bool in_pulse = std::fmod(static_cast<double>(i) / kRate, kPulsesEvery) < 0.1;
    (in_pulse ? on : off) += channel.reading[i] * 180.0 / std::numbers::pi;
    count += in_pulse ? 1.0 : 0.0;
  }
  EXPECT_NEAR(on / count - off / (kSamples - count), kPulse, 0.4 * kPulse);
}

TEST(ProfileWithoutAName, OfNoiseThatComesAgainIsOneOfItsPower) {
  const Report report = investigated(study_of(is_louder_at_times, 12, 1).study);
  ASSERT_FALSE(report.unnamed.empty()) << told(report);
  const UnnamedEffect& effect = report.unnamed.front().effect;
  EXPECT_EQ(effect.kind, UnnamedKind::Variance) << told(report);
  ASSERT_EQ(effect.against, Against::Phase) << told(report);
  EXPECT_NEAR(effect.period_s, 3.1, 3e-3);
  const auto ends = std::minmax_element(effect.value.begin(), effect.value.end());
  EXPECT_NEAR(*ends.second / *ends.first, 2.25, 0.5);
}

TEST(ProfileWithoutAName, IsNoneWhereNothingIsHidden) {
  for (std::uint64_t seed = 20; seed < 30; ++seed) {
    const Report report = investigated(study_of([](std::size_t, std::uint64_t own) { return white(own); }, seed).study);
    EXPECT_TRUE(report.unnamed.empty()) << seed << ": " << told(report);
  }
}

TEST(SpectrogramOfInnovations, IsAPictureOfWhatChanges) {
  const Made made = study_of(swells_with_temperature, 7);
  const Report report = investigated(made.study);
  ASSERT_EQ(report.figures.size(), 1U);
  ASSERT_TRUE(report.figures.front().spectrogram);
  const InnovationSpectrogram& picture = *report.figures.front().spectrogram;
  const std::size_t bands = picture.f_hz.size();
  EXPECT_EQ(picture.time_s.size(), 64U);
  ASSERT_EQ(picture.log10_ratio.size(), picture.time_s.size() * bands);
  std::size_t r = 0;
  while (made.study.recordings.at(r).id != picture.recording) {
    ++r;
  }
  // Cells in which the noise is loud against those in which it is not.
  std::array<double, 2> sum{};
  std::array<double, 2> count{};
  for (std::size_t i = 0; i < picture.time_s.size(); ++i) {
    const std::size_t loud = swelling(temperature(r, picture.time_s[i])) > 1.0 ? 1 : 0;
    for (std::size_t k = 0; k < bands; ++k) {
      sum.at(loud) += picture.log10_ratio[i * bands + k];
      count.at(loud) += 1.0;
    }
  }
  EXPECT_GT(sum[1] / count[1], sum[0] / count[0] + 0.05) << told(report);
}

TEST(SpectrogramOfInnovations, IsNoneWhereNothingIsLeft) {
  const Report report = investigated(study_of([](std::size_t, std::uint64_t own) { return white(own); }, 20).study);
  ASSERT_EQ(report.figures.size(), 1U);
  EXPECT_FALSE(report.figures.front().spectrogram);
}

}  // namespace
}  // namespace driftlab::investigate
