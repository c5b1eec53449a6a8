#include "core/analysis/survey_recording.hpp"

#include "core/process/random.hpp"
#include "core/read/format.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>

namespace driftlab {
namespace {

class SurveyRecording : public testing::Test {
 protected:
  SurveyRecording() {
    std::string pattern = (std::filesystem::temp_directory_path() / "driftlab-test-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// What the survey says of a file of these bytes.
  Result<RecordingSurvey> survey(const std::string& bytes, const RecordingSpec& spec,
                                 const Calibration& calibration = {}) {
    std::ofstream(folder_ / "file", std::ios::binary) << bytes;
    const auto decoded = decode_file(folder_ / "file", folder_ / "columns");
    if (!decoded) {
      return fail(decoded.error());
    }
    return survey_recording({folder_ / "columns", spec, calibration, {}});
  }

 private:
  std::filesystem::path folder_;
};

RecordingSpec gyroscope_z() {
  RecordingSpec spec;
  spec.id = "r";
  spec.rate_hz = 100.0;
  spec.condition = *parse_condition("static");
  spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
  return spec;
}

/// 2000 readings of noise of 0.01 deg/s, each as `reading` turns it.
std::string readings(const std::function<double(int, double)>& reading) {
  Random random(31);
  std::string text = "gz\n";
  for (int i = 0; i < 2000; ++i) {
    char line[40];
    std::snprintf(line, sizeof line, "%.6f\n", reading(i, 0.01 * random.normal()));
    text += line;
  }
  return text;
}

TEST_F(SurveyRecording, MarksNothingInAGoodOne) {
  const auto found = survey(readings([](int, double noise) { return noise; }), gyroscope_z());
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->quality.samples, 2000);
  EXPECT_TRUE(found->longest_gaps.empty());
  EXPECT_FALSE(found->temperature);
  ASSERT_EQ(found->marks.size(), 1);
  EXPECT_FALSE(found->marks[0].rails);
  EXPECT_TRUE(found->marks[0].implausible.empty());
}

TEST_F(SurveyRecording, TellsStretchesThatAreNoMeasurementsInTheOrderOfTheirRows) {
  const auto found =
      survey(readings([](int i, double noise) { return (i >= 700 && i < 703) || i == 1500 ? -9999.0 : noise; }),
             gyroscope_z());
  ASSERT_TRUE(found) << found.error().message;
  const auto& marked = found->marks.at(0).implausible;
  ASSERT_EQ(marked.size(), 2);
  EXPECT_EQ(marked[0].row, 700);
  EXPECT_EQ(marked[0].samples, 3);
  EXPECT_EQ(marked[1].row, 1500);
  EXPECT_EQ(marked[1].samples, 1);
}

TEST_F(SurveyRecording, GivesTheEndsOfARangeWhereSamplesPileUp) {
  const auto found = survey(readings([](int, double noise) { return std::clamp(noise, -1.0, 0.012); }), gyroscope_z());
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_TRUE(found->marks.at(0).rails);
  EXPECT_FALSE(found->marks[0].rails->low);
  EXPECT_EQ(found->marks[0].rails->high, 0.012);
}

TEST_F(SurveyRecording, TellsOfTheLongestGapsOnlyAsManyAsAScreenShows) {
  RecordingSpec spec = gyroscope_z();
  spec.columns["t"] = {Quantity::Time, "", *parse_unit("s")};
  Random random(32);
  std::string text = "t,gz\n";
  double t = 0.0;
  int gaps = 0;
  for (int i = 0; i < 20000; ++i) {
    // 100 gaps, one after each 200 rows; every second one lacks 5 samples, the others 2
    const bool gap = i % 200 == 199;
    t += gap ? (gaps++ % 2 == 0 ? 0.06 : 0.03) : 0.01;
    char line[60];
    std::snprintf(line, sizeof line, "%.4f,%.6f\n", t, 0.01 * random.normal());
    text += line;
  }
  const auto found = survey(text, spec);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->quality.gaps, 100);
  ASSERT_EQ(found->longest_gaps.size(), kMarksTold);
  const auto longer = std::count_if(found->longest_gaps.begin(), found->longest_gaps.end(),
                                    [](const Gap& gap) { return gap.missing == 5; });
  EXPECT_EQ(longer, 50);
  EXPECT_TRUE(std::is_sorted(found->longest_gaps.begin(), found->longest_gaps.end(),
                             [](const Gap& a, const Gap& b) { return a.row < b.row; }));
}

TEST_F(SurveyRecording, ReadsTheColumnsOfADriveWithoutASensorAndSaysSo) {
  RecordingSpec spec = gyroscope_z();
  spec.condition = *parse_condition("drive");
  spec.columns = {{"t", {Quantity::Time, "", *parse_unit("s")}},
                  {"gz", {Quantity::GnssVelocity, "north", *parse_unit("m/s")}}};
  const auto found = survey("t,gz\n0,1\n1,2\n2,3\n", spec);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->quality.samples, 3);
  EXPECT_TRUE(found->marks.empty());
  ASSERT_EQ(found->quality.notes.size(), 1);
  EXPECT_TRUE(found->quality.notes[0].starts_with("No column is a sensor"));
}

TEST_F(SurveyRecording, RefusesMetadataThatItsCalibrationCannotCorrect) {
  RecordingSpec spec = gyroscope_z();
  spec.calibration = "cal";
  Calibration calibration;
  calibration.gyroscope.emplace();
  const auto found = survey(readings([](int, double noise) { return noise; }), spec, calibration);
  EXPECT_FALSE(found) << "one axis of three cannot be corrected for misalignment";
}

}  // namespace
}  // namespace driftlab
