#include "core/signal/angle.hpp"
#include "schema/json/regression.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

TEST(RecordedAt, IsReadAsRfc3339WritesIt) {
  // Seconds from `date -u -d TIME +%s`.
  EXPECT_DOUBLE_EQ(seconds_of("1970-01-01T00:00:00Z").value(), 0.0);
  EXPECT_DOUBLE_EQ(seconds_of("2026-11-22T10:00:00Z").value(), 1795341600.0);
  EXPECT_DOUBLE_EQ(seconds_of("2026-11-22t10:00:00.25z").value(), 1795341600.25);
  EXPECT_DOUBLE_EQ(seconds_of("2026-11-22 11:30:00+01:30").value(), 1795341600.0);
  EXPECT_DOUBLE_EQ(seconds_of("2026-11-21T22:00:00-12:00").value(), 1795341600.0);
  EXPECT_DOUBLE_EQ(seconds_of("2024-02-29T00:00:00Z").value(), 1709164800.0);
}

TEST(RecordedAt, RefusesWhatIsNoTimeOrHasNoZone) {
  for (const char* text :
       {"", "yesterday", "2026-11-22", "2026-11-22T10:00:00", "2026-02-30T10:00:00Z", "2025-02-29T10:00:00Z",
        "2026-11-22T24:00:00Z", "2026-11-22T10:60:00Z", "2026-11-22T10:00:00+0100", "2026-11-22T10:00:00Zulu",
        "2026-11-22T10:00:00+25:00", "2026-13-01T10:00:00Z", "Z", "+01:00"}) {
    const auto seconds = seconds_of(text);
    ASSERT_FALSE(seconds) << text;
    EXPECT_EQ(seconds.error().code, ErrorCode::InvalidArgument);
  }
}

Json parsed(const char* text) { return *parse_json(text); }

TEST(RegressionRequest, ReadsFullScalesAndMarginsOfTheScaleFactor) {
  Faults faults;
  const WrittenRegression run = regression_from_json(
      parsed(R"({"candidate": {"recordings": [{"file": "a.csv", "temperature_degc": 25, "causes": ["aliasing"],
                                                "full_scale": {"gyroscope": 250, "accelerometer": 2}}]},
                  "settings": {"margin": {"scale_factor": {"gyroscope": 500}}}})"),
      faults);
  ASSERT_TRUE(faults.none()) << faults.error().message;
  EXPECT_DOUBLE_EQ(run.settings.scale_factor.gyroscope, 5e-4);
  EXPECT_EQ(run.settings.scale_factor.accelerometer, 0.0);
  const StatedFacts& stated = run.candidate.recordings.at(0).stated;
  EXPECT_DOUBLE_EQ(stated.full_scale.gyroscope.value_or(0.0), 250.0 * kDegree);
  Json kept = Json::object();  // as a state file or a job holds it
  add_stated_facts(stated, kept);
  regression::ComparedRecording recording;
  stated_facts_of(kept).tell(recording);
  EXPECT_DOUBLE_EQ(recording.full_scale.accelerometer.value_or(0.0), 2.0 * 9.80665);
  EXPECT_EQ(recording.temperature_degc, 25.0);
  EXPECT_TRUE(recording.investigated);
  EXPECT_EQ(recording.causes, std::vector<std::string>{"aliasing"});
  EXPECT_TRUE(StatedFacts{}.empty());
  EXPECT_FALSE(stated.empty());
  StatedFacts searched;
  searched.add_causes({});
  searched.tell(recording);
  EXPECT_TRUE(recording.investigated) << "an investigation that found nothing is one";
  EXPECT_TRUE(recording.causes.empty());
}

TEST(RegressionRequest, RefusesFullScalesAndMarginsThatAreNone) {
  for (
      const char* const text :
      {R"({"candidate": {"recordings": [{"file": "a.csv", "full_scale": {"gyroscope": 0}}]}})",
       R"({"candidate": {"recordings": [{"file": "a.csv", "full_scale": {"gyro": 250}}]}})",
       R"({"candidate": {"recordings": [{"file": "a.csv"}]}, "settings": {"margin": {"scale_factor": {"gyroscope": -1}}}})",
       R"({"candidate": {"recordings": [{"file": "a.csv"}]}, "settings": {"margin": {"scale_factor": 500}}})"}) {
    Faults faults;
    (void)regression_from_json(parsed(text), faults);
    EXPECT_FALSE(faults.none()) << text;
  }
}

}  // namespace
}  // namespace driftlab
