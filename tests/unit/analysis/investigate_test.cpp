#include "core/analysis/investigate.hpp"

#include "core/process/random.hpp"
#include "core/signal/turns.hpp"
#include "tests/unit/analysis/file_source.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace driftlab {
namespace {

constexpr std::size_t kRows = 6000;
constexpr double kRateHz = 50.0;

/// A gyroscope with white noise of 0.05 deg/s on a table that swings between 20 and 60 deg/s, beside the table's
/// encoder. `turn_deg`: where the encoder starts again; infinite: it counts its turns.
std::string table_file(double turn_deg) {
  Random random(7);
  std::string text = "gz,angle\n";
  for (std::size_t i = 0; i < kRows; ++i) {
    const double t = static_cast<double>(i) / kRateHz;
    const double angle = 40.0 * t + 20.0 / 0.8 * (1.0 - std::cos(0.8 * t));
    const double rate = 40.0 + 20.0 * std::sin(0.8 * t);
    char line[80];
    std::snprintf(line, sizeof line, "%.6f,%.6f\n", rate + 0.05 * random.normal(), std::fmod(angle, turn_deg));
    text += line;
  }
  return text;
}

RecordingSpec table_spec() {
  RecordingSpec spec;
  spec.id = "swing";
  spec.rate_hz = kRateHz;
  spec.condition.kind = ConditionKind::Profile;
  spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
  spec.columns["angle"] = {Quantity::ReferenceAngle, "z", *parse_unit("deg")};
  return spec;
}

investigate::Report report_of(const std::string& file) {
  FileSource files;
  files.add(table_spec(), file);
  InvestigationRequest request;
  request.study = "encoder";
  request.options.predict_outages = false;
  auto report = investigate_study(request, files);
  EXPECT_TRUE(report) << report.error().message;
  return report ? *report : investigate::Report{};
}

TEST(InvestigateStudy, AnEncoderThatStartsAgainAfterATurnIsNoFinding) {
  // Story: a rate table's encoder went from 360 to 0 deg once a turn; its derivative was a reference of -9000 deg/s for
  // two samples, and investigate said that the gyroscope does not follow its reference. characterise had always
  // unwrapped it.
  const investigate::Report wrapped = report_of(table_file(360.0));
  const investigate::Report counted = report_of(table_file(1e9));
  ASSERT_EQ(wrapped.models.size(), 1U);
  EXPECT_EQ(wrapped.findings.size(), counted.findings.size());
  EXPECT_EQ(wrapped.failed_before, counted.failed_before);
  ASSERT_EQ(wrapped.checks.size(), counted.checks.size());
  for (std::size_t i = 0; i < wrapped.checks.size(); ++i) {
    // The two references differ by the rounding of angles.
    EXPECT_NEAR(wrapped.checks[i].observed, counted.checks[i].observed,
                1e-6 * (1.0 + std::fabs(counted.checks[i].observed)))
        << wrapped.checks[i].id;
  }
}

TEST(InvestigateStudy, NamesTheRecordingOfAnError) {
  FileSource files;
  files.add(table_spec(), "gz,angle\n1,2\n");
  const auto report = investigate_study({}, files);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::TooFewSamples);
  EXPECT_EQ(report.error().fields.back().name, "file");
}

TEST(InvestigateStudy, StopsBeforeItOpensARecording) {
  FileSource files;
  files.add(table_spec(), "this is never read");
  std::stop_source stop;
  stop.request_stop();
  const auto report = investigate_study({}, files, {stop.get_token(), {}});
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::Cancelled);
}

}  // namespace
}  // namespace driftlab
