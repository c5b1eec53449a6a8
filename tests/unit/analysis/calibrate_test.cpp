#include "core/analysis/calibrate.hpp"

#include "core/process/random.hpp"
#include "tests/unit/analysis/file_source.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace driftlab {
namespace {

RecordingSpec position(const std::string& id, const char* condition) {
  RecordingSpec spec;
  spec.id = id;
  spec.rate_hz = 100.0;
  spec.condition = *parse_condition(condition);
  for (const char* const axis : {"x", "y", "z"}) {
    spec.columns[std::string("f") + axis] = {Quantity::SpecificForce, axis, *parse_unit("m/s^2")};
  }
  return spec;
}

/// An accelerometer with a bias of 0.1 m/s^2 on x, a scale-factor error of 1000 ppm on z and noise of 0.01 m/s^2.
std::string at_rest(double x, double y, double z, std::uint64_t seed) {
  Random random(seed);
  std::string text = "fx,fy,fz\n";
  for (int i = 0; i < 400; ++i) {
    char line[100];
    std::snprintf(line, sizeof line, "%.6f,%.6f,%.6f\n", x + 0.1 + 0.01 * random.normal(), y + 0.01 * random.normal(),
                  1.001 * z + 0.01 * random.normal());
    text += line;
  }
  return text;
}

void add_six_positions(FileSource& files) {
  constexpr double kG = kStandardGravity;
  files.add(position("x up", "six_position:x:up"), at_rest(kG, 0, 0, 1));
  files.add(position("x down", "six_position:x:down"), at_rest(-kG, 0, 0, 2));
  files.add(position("y up", "six_position:y:up"), at_rest(0, kG, 0, 3));
  files.add(position("y down", "six_position:y:down"), at_rest(0, -kG, 0, 4));
  files.add(position("z up", "six_position:z:up"), at_rest(0, 0, kG, 5));
  files.add(position("z down", "six_position:z:down"), at_rest(0, 0, -kG, 6));
}

TEST(Calibrate, FindsTheErrorsOfSixPositions) {
  FileSource files;
  add_six_positions(files);
  const auto report = calibrate(files);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_TRUE(report->accelerometer);
  EXPECT_FALSE(report->rests || report->gyroscope);
  EXPECT_EQ(report->accelerometer->positions, 6U);
  // Means of 400 samples have 0.0005 m/s^2; a bias is that of six of them, a scale factor of two over 2 g.
  EXPECT_NEAR(report->accelerometer->found.bias[0].value, 0.1, 5 * 0.0005);
  EXPECT_NEAR(report->accelerometer->found.scale_factor[2].value, 1e-3, 5 * 0.0005 / kStandardGravity);
}

TEST(Calibrate, NotesARecordingThatGivesNoPosition) {
  FileSource files;
  add_six_positions(files);
  files.add(position("a drive", "drive"), at_rest(0, 0, kStandardGravity, 7));
  const auto report = calibrate(files);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report->notes.size(), 1U);
  EXPECT_NE(report->notes[0].find("'a drive' gives no position"), std::string::npos);
}

TEST(Calibrate, LocatesTheRecordingOfAnError) {
  FileSource files;
  add_six_positions(files);
  files.add(position("broken", "six_position:z:up"), "fx,fy,fz\n");
  const auto report = calibrate(files);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().fields.back().value, "6");
}

TEST(Calibrate, OneRecordingWithoutAnAccelerometerSaysWhatItNeeds) {
  FileSource files;
  RecordingSpec spec = position("gyro", "static");
  spec.columns.clear();
  spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
  files.add(spec, "gz\n1\n2\n3\n4\n5\n6\n7\n8\n9\n");
  const auto report = calibrate(files);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::UnknownColumn);
}

}  // namespace
}  // namespace driftlab
