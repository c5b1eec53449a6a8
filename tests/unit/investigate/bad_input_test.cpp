/// Studies that lack what an investigation needs: nothing is invented, and the report says what is missing.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/investigate.hpp"
#include "core/investigate/report/page.hpp"
#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <string>

namespace driftlab::investigate {
namespace {

using Columns = std::vector<std::vector<double>>;

std::vector<double> noise(std::size_t samples, std::uint64_t seed, double sd = 0.1) {
  Random random(seed);
  std::vector<double> values(samples);
  for (double& v : values) {
    v = sd * random.normal();
  }
  return values;
}

/// A recording of 20 Hz out of `columns`, which outlive it.
Result<StudyRecording> record(const std::string& id, const std::map<std::string, ColumnRole>& roles,
                              const Columns& columns, std::optional<double> rate_hz = 20.0) {
  RecordingSpec spec;
  spec.id = id;
  spec.rate_hz = rate_hz;
  spec.columns = roles;
  ColumnNames names;
  for (const auto& [name, role] : roles) {
    names.push_back(name);
  }
  return make_study_recording(spec, names, columns[0].size(),
                              [&](std::size_t i) { return std::span<const double>(columns[i]); });
}

ColumnRole gyro(const char* axis) { return {Quantity::AngularRate, axis, *parse_unit("deg/s")}; }

Study study_of(std::vector<StudyRecording> recordings) {
  Study study;
  study.id = "bad";
  study.recordings = std::move(recordings);
  settle_channels(study);
  return study;
}

std::string need_of(const Report& report, const std::string& cause) {
  for (const NotExamined& item : report.not_examined) {
    if (item.cause == cause) {
      return item.needs;
    }
  }
  return "";
}

TEST(BadInput, OneStaticRecordingOfOneAxisShowsWhatElseIsNeeded) {
  const Columns columns{noise(6000, 1)};
  const auto report = investigate(study_of({*record("a", {{"gz", gyro("z")}}, columns)}));
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->findings.empty());
  EXPECT_EQ(need_of(*report, "temperature_bias"), "a temperature column");
  EXPECT_EQ(need_of(*report, "missing_samples"), "a time column");
  EXPECT_EQ(need_of(*report, "timestamp_jitter"), "a time column");
  EXPECT_EQ(need_of(*report, "common_mode_noise"), "several axes recorded together");
  EXPECT_EQ(need_of(*report, "turn_on_bias"), "three recordings or more");
  for (const char* const cause :
       {"scale_factor_error", "scale_factor_asymmetry", "scale_factor_nonlinearity", "axis_misalignment",
        "reference_time_offset", "reference_clock_drift", "once_per_revolution", "g_sensitivity",
        "vibration_rectification", "lever_arm", "rate_dependent_noise", "acceleration_dependent_noise", "saturation",
        "white_noise_level", "gauss_markov", "random_walk", "flicker_noise", "quantization_noise"}) {
    EXPECT_NE(need_of(*report, cause), "") << cause;
  }
  // What needs any recording only is examined: it has a check of its own, or none because it was not worth one.
  for (const char* const cause : {"linear_drift", "bias_step", "warm_up_transient", "outliers", "heavy_tailed_noise"}) {
    EXPECT_EQ(need_of(*report, cause), "") << cause;
  }
  EXPECT_NE(markdown(*report).find("for want of a temperature column"), std::string::npos);
}

TEST(BadInput, ConstantChannelsAreSaidSo) {
  const Columns columns{std::vector<double>(6000, 0.25), std::vector<double>(6000, 0.0)};
  const auto report = investigate(study_of({*record("a", {{"gx", gyro("x")}, {"gy", gyro("y")}}, columns)}));
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->findings.empty());
  EXPECT_TRUE(report->models.empty());
  ASSERT_EQ(report->notes.size(), 2U);
  EXPECT_NE(report->notes[0].find("never changes"), std::string::npos);
  EXPECT_EQ(report->not_examined.size(), 2U * cause_registry().size());
}

TEST(BadInput, TooFewSamplesAreSaidSo) {
  const Columns columns{noise(120, 2)};
  const auto report = investigate(study_of({*record("a", {{"gz", gyro("z")}}, columns)}));
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->findings.empty());
  EXPECT_EQ(need_of(*report, "bias_step"), "500 samples or more");
  const Columns fewer{noise(8, 2)};
  EXPECT_EQ(record("b", {{"gz", gyro("z")}}, fewer).error().code, ErrorCode::TooFewSamples);
}

TEST(BadInput, ShortRecordingsInventNothing) {
  // 500 to 700 samples: the least that is examined. 40 studies at a false-alarm rate of 5 % give 2; 7 has p = 0.003.
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Columns columns{noise(500 + 5 * seed, 100 + seed)};
    const auto report = investigate(study_of({*record("a", {{"gz", gyro("z")}}, columns)}));
    ASSERT_TRUE(report);
    alarms += report->findings.empty() ? 0 : 1;
  }
  EXPECT_LT(alarms, 7);
}

TEST(BadInput, UnitsThatContradictTheQuantityAreRefused) {
  const Columns columns{noise(600, 3)};
  ColumnRole role = gyro("z");
  role.unit = *parse_unit("m/s^2");
  const auto recording = record("a", {{"gz", role}}, columns);
  ASSERT_FALSE(recording);
  EXPECT_EQ(recording.error().code, ErrorCode::UnitMismatch);
}

TEST(BadInput, AMissingUnitIsNotedAndNeverTakenForARate) {
  const Columns columns{noise(6000, 4)};
  ColumnRole role = gyro("z");
  role.unit.reset();
  auto recording = record("a", {{"gz", role}}, columns);
  ASSERT_TRUE(recording);
  EXPECT_FALSE(recording->notes.empty());
  const auto report = investigate(study_of({std::move(*recording)}));
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->findings.empty());
}

TEST(BadInput, RecordingsThatContradictEachOtherInRateAreSaidSo) {
  const Columns columns{noise(6000, 5)};
  const auto report = investigate(
      study_of({*record("a", {{"gz", gyro("z")}}, columns, 20.0), *record("b", {{"gz", gyro("z")}}, columns, 50.0)}));
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->findings.empty());
  EXPECT_EQ(need_of(*report, "bias_step"), "recordings at one sampling rate");
}

TEST(BadInput, FreeMotionWithoutAReferenceIsNotExamined) {
  const Columns columns{noise(6000, 6)};
  RecordingSpec spec;
  spec.id = "drive";
  spec.rate_hz = 20.0;
  spec.condition.kind = ConditionKind::Drive;
  spec.columns["gz"] = gyro("z");
  auto recording = make_study_recording(spec, {"gz"}, columns[0].size(),
                                        [&](std::size_t i) { return std::span<const double>(columns[i]); });
  ASSERT_TRUE(recording);
  const auto report = investigate(study_of({std::move(*recording)}));
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->findings.empty());
  ASSERT_FALSE(report->notes.empty());
  EXPECT_NE(report->notes[0].find("no reference"), std::string::npos);
  EXPECT_NE(need_of(*report, "scale_factor_error").find("a reference column"), std::string::npos);
}

TEST(BadInput, ACalibrationThatIsNotAppliedIsSaid) {
  const std::vector<double> values(600, 0.5);
  RecordingSpec spec;
  spec.id = "r";
  spec.rate_hz = 20.0;
  spec.calibration = "table-2026";
  spec.columns["gz"] = gyro("z");
  const auto recording =
      make_study_recording(spec, {"gz"}, values.size(), [&](std::size_t) { return std::span<const double>(values); });
  ASSERT_TRUE(recording);
  ASSERT_EQ(recording->notes.size(), 1U);
  EXPECT_NE(recording->notes[0].find("'table-2026' is not applied"), std::string::npos) << recording->notes[0];
}

/// A recorded IMU froze at 196.9 s for the rest of the file; one run was too few to be called stuck, and the frozen
/// part was taken for noise.
TEST(BadInput, AFreezeIsOneStuckRunAndSpoilsNothingElse) {
  Columns columns{noise(6000, 8)};
  for (std::size_t i = 2000; i < 6000; ++i) {
    columns[0][i] = columns[0][1999];
  }
  const auto report = investigate(study_of({*record("a", {{"gz", gyro("z")}}, columns)}));
  ASSERT_TRUE(report);
  ASSERT_EQ(report->findings.size(), 1U);
  const Finding& finding = report->findings[0];
  EXPECT_EQ(finding.evidence.cause->name, "stuck_samples");
  EXPECT_NEAR(finding.evidence.parameters[0].estimate.value, 4000.0 / 6000.0, 1e-3);
  EXPECT_NE(finding.explanation.find("begins 100.0 s after the first sample"), std::string::npos)
      << finding.explanation;
}

TEST(BadInput, AStudyWithoutRecordingsIsAnError) {
  EXPECT_EQ(investigate(Study{}).error().code, ErrorCode::TooFewSamples);
}

}  // namespace
}  // namespace driftlab::investigate
