/// `driftlab calibrate` printed "x reads +0.000 +- inf mrad of y" for angles that nobody had estimated.
#include "schema/text/calibration.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kG = kStandardGravity;

std::vector<KnownPosition> six_positions(double sigma) {
  std::vector<KnownPosition> positions;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      KnownPosition position;
      position.truth[axis] = sign * kG;
      position.reading.mean = position.truth;
      position.reading.mean[(axis + 1) % 3] += 0.002 * sign * kG;
      position.reading.sigma = {sigma, sigma, sigma};
      positions.push_back(position);
    }
  }
  return positions;
}

std::string text_of_six(double sigma, bool misalignment) {
  CalibrationReport report;
  report.accelerometer = PositionCalibration{*calibrate_six_positions(six_positions(sigma), {misalignment}), 6};
  return calibration_to_text(report);
}

MultiPositionCalibration turned(bool about_one_axis) {
  std::vector<Triple> readings;
  for (int k = 0; k < 24; ++k) {
    const double turn = 2.0 * std::numbers::pi * k / 24.0;
    const double tilt = about_one_axis ? std::numbers::pi / 4.0 : 2.4 * k;
    readings.push_back(
        {kG * std::sin(turn) * std::cos(tilt), kG * std::sin(turn) * std::sin(tilt), kG * std::cos(turn)});
    for (double& value : readings.back()) {
      value *= 1.0 + 1e-4 * std::sin(7.0 * k);  // something to scatter by
    }
  }
  return *calibrate_multi_position(readings, kG);
}

std::string text_of_rests(bool about_one_axis) {
  CalibrationReport report;
  report.rests = RestCalibration{turned(about_one_axis), {}};
  return calibration_to_text(report);
}

const auto kNoSymbols = AllOf(Not(HasSubstr("inf")), Not(HasSubstr("nan")));

TEST(CalibrationText, SaysThatAnglesWereNotEstimated) {
  EXPECT_THAT(text_of_six(0.001, false),
              AllOf(kNoSymbols, Not(HasSubstr("mrad")), HasSubstr("taken as right, not estimated; --misalignment")));
}

TEST(CalibrationText, GivesEstimatedAnglesWithTheirIntervals) {
  EXPECT_THAT(text_of_six(0.001, true), AllOf(kNoSymbols, HasSubstr("  y reads +2.000 +- "), HasSubstr(" mrad of x\n"),
                                              Not(HasSubstr("not estimated"))));
}

TEST(CalibrationText, SaysWhyTwoExactReadingsHaveNoInterval) {
  // A converter so coarse that a resting axis always gives the same count leaves no scatter.
  EXPECT_THAT(text_of_six(0.0, false),
              AllOf(kNoSymbols, HasSubstr("bias +0 (no interval) m/s^2"), HasSubstr("0.0 (no interval) ppm"),
                    HasSubstr("record each position twice")));
}

TEST(CalibrationText, SaysWhichAnglesTheFrameFixesAndWhy) {
  EXPECT_THAT(text_of_rests(false),
              AllOf(kNoSymbols, HasSubstr("  x reads "), HasSubstr(" mrad of z\n"), Not(HasSubstr("y reads +0.000")),
                    HasSubstr("y reads nothing of x, and z nothing of x and y, by definition")));
}

TEST(CalibrationText, SaysWhichAnglesThePositionsDoNotShow) {
  EXPECT_THAT(text_of_rests(true),
              AllOf(kNoSymbols, HasSubstr("What x reads of y cannot be told from these positions"),
                    HasSubstr("What has no interval cannot be told from these positions; turn the sensor")));
}

}  // namespace
}  // namespace driftlab
