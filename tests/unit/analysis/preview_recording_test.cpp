/// The beginning of a file, and what a recording of it would be.
#include "core/analysis/preview_recording.hpp"

#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace driftlab {
namespace {

/// Four seconds at 100 Hz of a gyroscope that turns about z at `rate` deg/s, under this header.
std::string turning(double rate, const std::string& header = "time (s),gx (deg/s),gz (deg/s)") {
  Random random(811);
  std::string text = header + "\n";
  for (int i = 0; i < 400; ++i) {
    text += std::to_string(0.01 * i) + "," + std::to_string(0.05 * random.normal()) + "," +
            std::to_string(rate + 0.05 * random.normal()) + "\n";
  }
  return text;
}

RecordingPreview preview(const std::string& bytes, const RecordingSpec& spec = {}) {
  return preview_recording({bytes, HeadExtent::WholeFile, spec});
}

bool has_field(const Error& error, const std::string& value) {
  return std::any_of(error.fields.begin(), error.fields.end(),
                     [&](const ErrorField& field) { return field.value == value; });
}

TEST(PreviewRecording, TellsWhatItsHeaderSaysAndTheRateOfItsTimes) {
  const RecordingPreview found = preview(turning(0.0));
  EXPECT_TRUE(found.problems.empty()) << found.problems.front().message;
  ASSERT_EQ(found.columns.size(), 3);
  EXPECT_EQ(found.columns[2].from, RoleOrigin::Header);
  ASSERT_TRUE(found.columns[2].role);
  EXPECT_EQ(found.columns[2].role->quantity, Quantity::AngularRate);
  EXPECT_EQ(found.columns[2].role->axis, "z");
  EXPECT_EQ(found.columns[2].first.size(), 5);
  ASSERT_TRUE(found.rate_hz);
  EXPECT_NEAR(*found.rate_hz, 100.0, 0.01);
  EXPECT_FALSE(found.rate_is_stated);
}

TEST(PreviewRecording, ProposesTheConditionThatTheReadingsShow) {
  const RecordingPreview moving = preview(turning(9.0));
  ASSERT_TRUE(moving.condition);
  EXPECT_EQ(moving.condition->condition.kind, ConditionKind::ConstantRate);
  EXPECT_EQ(moving.condition->condition.axis, "z");
  const RecordingPreview resting = preview(turning(0.0));
  ASSERT_TRUE(resting.condition);
  EXPECT_EQ(resting.condition->condition.kind, ConditionKind::Static);
}

TEST(PreviewRecording, HintsAtAUnitThatARestingAccelerometerContradicts) {
  // At rest it feels gravity, 9.8 m/s^2; it reads 1.0.
  Random random(812);
  const auto resting = [&](const std::string& unit, double gravity) {
    std::string text = "time (s),ax (" + unit + "),ay (" + unit + "),az (" + unit + ")\n";
    for (int i = 0; i < 400; ++i) {
      text += std::to_string(0.01 * i);
      for (const double mean : {0.0, 0.0, gravity}) {
        text += "," + std::to_string(mean + 1e-3 * random.normal());
      }
      text += "\n";
    }
    return text;
  };
  const std::string wrong = resting("m/s^2", 1.0);
  const std::string right = resting("g", 1.0);
  EXPECT_FALSE(preview_recording({wrong, HeadExtent::WholeFile, {}, true}).hints.empty());
  EXPECT_TRUE(preview_recording({right, HeadExtent::WholeFile, {}, true}).hints.empty());
}

TEST(PreviewRecording, ProposesATimeForAColumnThatRisesAsOne) {
  const RecordingPreview found = preview(turning(0.0, "k,gx (deg/s),gz (deg/s)"));
  ASSERT_TRUE(found.time);
  EXPECT_EQ(found.time->column, "k");
  EXPECT_EQ(found.time->unit.symbol, "s");
  EXPECT_NEAR(found.time->rate_hz, 100.0, 0.01);
}

TEST(PreviewRecording, WhatWouldRefuseTheUploadIsAProblemAndNotAFailure) {
  const RecordingPreview unreadable = preview("");
  ASSERT_EQ(unreadable.problems.size(), 1);
  EXPECT_TRUE(unreadable.columns.empty());
  RecordingSpec spec;
  spec.columns["gyro"] = {Quantity::AngularRate, "x", *parse_unit("deg/s")};
  const RecordingPreview unknown = preview(turning(0.0), spec);
  ASSERT_FALSE(unknown.problems.empty());
  EXPECT_EQ(unknown.problems.front().code, ErrorCode::UnknownColumn);
  EXPECT_TRUE(has_field(unknown.problems.front(), "gyro"));
}

}  // namespace
}  // namespace driftlab
