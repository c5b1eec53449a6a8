/// One recording after the other: corrected, its references subtracted, each channel characterised.
#include "core/analysis/characterise.hpp"

#include "core/process/model.hpp"
#include "core/process/random.hpp"
#include "core/signal/angle.hpp"
#include "tests/unit/analysis/file_source.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kDensity = 0.02;  // deg/s/sqrt(Hz)
constexpr std::size_t kRows = 6000;

/// A minute at 100 Hz: the z gyroscope on a table that swings, with the table's rate, and a y gyroscope that rests.
std::string swinging_table() {
  Random random(1409);
  const Model model{*make_process("white_noise", {kDensity})};
  const std::vector<double> z = simulate(model, random, 0.01, kRows);
  const std::vector<double> y = simulate(model, random, 0.01, kRows);
  std::string text = "gz,table,gy\n";
  for (std::size_t i = 0; i < kRows; ++i) {
    const double table = 20.0 * std::sin(2.0 * std::numbers::pi * 0.5 * 0.01 * static_cast<double>(i));
    text += std::to_string(z[i] + table) + "," + std::to_string(table) + "," + std::to_string(y[i]) + "\n";
  }
  return text;
}

RecordingSpec on_the_table(bool referenced) {
  RecordingSpec spec;
  spec.id = "swing";
  spec.rate_hz = 100.0;
  spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
  spec.columns["gy"] = {Quantity::AngularRate, "y", *parse_unit("deg/s")};
  if (referenced) {
    spec.columns["table"] = {Quantity::ReferenceAngularRate, "z", *parse_unit("deg/s")};
  }
  return spec;
}

Result<std::vector<CharacterisedRecording>> characterised(const RecordingSpec& spec, const std::string& bytes) {
  FileSource source;
  source.add(spec, bytes);
  CharacteriseOptions options;
  options.models = {"WN"};
  return characterise(source, options, {});
}

/// Standard deviation at the shortest tau [deg/s]: of white noise N / sqrt(dt).
double first_deviation(const CharacterisedChannel& channel) {
  return std::sqrt(channel.result.allan.variance.front()) / kDegree;
}

TEST(Characterise, WhatIsLeftOfAMotionBelowItsReferenceIsTheNoise) {
  const auto found = characterised(on_the_table(true), swinging_table());
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->size(), 1);
  ASSERT_EQ(found->front().channels.size(), 2);
  for (const CharacterisedChannel& channel : found->front().channels) {
    // 3000 differences of neighbours: their variance is known to 2.2 %, with a third more for overlap.
    EXPECT_NEAR(first_deviation(channel), kDensity / std::sqrt(0.01), 0.05 * kDensity / std::sqrt(0.01))
        << channel.column;
    EXPECT_EQ(channel.reference.has_value(), channel.column == "gz") << channel.column;
  }
}

TEST(Characterise, WithoutItsReferenceTheMotionIsInTheCurve) {
  const auto found = characterised(on_the_table(false), swinging_table());
  ASSERT_TRUE(found) << found.error().message;
  const CharacterisedChannel& z = found->front().channels.front();
  ASSERT_EQ(z.column, "gz");
  EXPECT_FALSE(z.reference);
  EXPECT_GT(first_deviation(z), 1.5 * kDensity / std::sqrt(0.01));
}

TEST(Characterise, SourcesOfATableAreTheChannelsByAxisWithTheirCondition) {
  const auto found = characterised(on_the_table(true), swinging_table());
  ASSERT_TRUE(found) << found.error().message;
  const std::vector<SensorSources> sensors = sensors_of(*found);
  ASSERT_EQ(sensors.size(), 2);
  EXPECT_EQ(sensors[0].axis, "z");
  EXPECT_EQ(sensors[1].axis, "y");
  ASSERT_EQ(sensors[0].sources.size(), 1);
  EXPECT_EQ(sensors[0].sources[0].recording_id, "swing");
  EXPECT_EQ(sensors[0].sources[0].condition, "static");
  EXPECT_TRUE(sensors[0].sources[0].result_id.empty()) << "nobody stores it";
}

TEST(Characterise, AnErrorSaysWhichRecordingAndWhichColumn) {
  const auto found = characterised(on_the_table(false), "gz,table,gy\n1,0,1\n2,0,2\n");
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::TooFewSamples);
  bool located = false;
  for (const ErrorField& field : found.error().fields) {
    located = located || field.name == "file";
  }
  EXPECT_TRUE(located) << "in the words of the source";
}

}  // namespace
}  // namespace driftlab
