/// References that are angles, on the grid of a study.
#include "core/investigate/study/study.hpp"
#include "core/signal/turns.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab::investigate {
namespace {

constexpr double kDt = 0.02;
constexpr double kRate = 1.5;  // [rad/s], an exact gyroscope reads the same

/// A table at an even rate: time, rate, and an encoder that starts again after a turn; without the rows [from, to).
Result<StudyRecording> record(std::size_t from, std::size_t to, std::vector<std::vector<double>>& columns) {
  columns.assign(3, {});
  for (std::size_t i = 0; i < 2000; ++i) {
    if (i < from || i >= to) {
      const double t = kDt * static_cast<double>(i);
      columns[0].push_back(t);
      columns[1].push_back(kRate);
      columns[2].push_back(std::fmod(kRate * t, kTurn));
    }
  }
  RecordingSpec spec;
  spec.id = "table";
  spec.rate_hz = 1.0 / kDt;
  spec.condition.kind = ConditionKind::Profile;
  spec.columns["t"] = {Quantity::Time, "", *parse_unit("s")};
  spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("rad/s")};
  spec.columns["angle"] = {Quantity::ReferenceAngle, "z", *parse_unit("rad")};
  return make_study_recording(spec, {"t", "gz", "angle"}, columns[0].size(),
                              [&](std::size_t i) { return std::span<const double>(columns[i]); });
}

void expect_no_error(const StudyRecording& recording) {
  // Angles of up to 60 rad, each rounded to 2^-48, divided by dt.
  const double rounding = 4.0 * std::ldexp(60.0, -53) / kDt;
  for (std::size_t i = 0; i < recording.length; ++i) {
    ASSERT_NEAR(recording.channels[0].error[i], 0.0, rounding) << i;
    // A slope of rates: twice the rounding over dt.
    ASSERT_NEAR(recording.acceleration[2][i], 0.0, 2.0 * rounding / kDt) << i;
  }
}

TEST(ReferenceAngle, AnEncoderThatStartsAgainIsNoSpike) {
  // Story: at 360 deg the encoder starts again, and the reference rate was -2 pi / (2 dt) for two samples each turn.
  std::vector<std::vector<double>> columns;
  const auto recording = record(0, 0, columns);
  ASSERT_TRUE(recording) << recording.error().message;
  expect_no_error(*recording);
}

TEST(ReferenceAngle, GoesOnTurningWhereSamplesAreMissing) {
  // 12 s without a sample, in which the table turned nearly three times.
  std::vector<std::vector<double>> columns;
  const auto recording = record(500, 1100, columns);
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->stamps.missing, 600U);
  expect_no_error(*recording);
}

}  // namespace
}  // namespace driftlab::investigate
