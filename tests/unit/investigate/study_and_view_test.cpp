/// A study and a view read one file alike: which columns are sensors, which rows are samples, what drove them.
#include "core/investigate/investigate.hpp"
#include "core/investigate/study/study.hpp"
#include "core/process/random.hpp"
#include "core/signal/recording_view.hpp"
#include "core/signal/turns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace driftlab::investigate {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDt = 0.02;
constexpr std::size_t kRows = 4000;

ColumnRole role(Quantity quantity, const char* axis, const char* unit) { return {quantity, axis, *parse_unit(unit)}; }

std::vector<double> noise(std::uint64_t seed) {
  Random random(seed);
  std::vector<double> values(kRows);
  std::generate(values.begin(), values.end(), [&] { return 0.1 * random.normal(); });
  return values;
}

/// A file, read both ways.
struct File {
  RecordingSpec spec;
  ColumnNames names;
  std::vector<std::vector<double>> columns;

  File() {
    spec.id = "file";
    spec.rate_hz = 1.0 / kDt;
  }
  void add(const std::string& name, std::vector<double> values, const std::optional<ColumnRole>& stated) {
    names.push_back(name);
    columns.push_back(std::move(values));
    if (stated) {
      spec.columns[name] = *stated;
    }
  }
  [[nodiscard]] std::span<const double> column(std::size_t i) const { return columns[i]; }
  [[nodiscard]] Result<StudyRecording> study() const {
    return make_study_recording(spec, names, kRows, [this](std::size_t i) { return column(i); });
  }
  [[nodiscard]] Result<RecordingView> view() const {
    return view_recording(spec, names, kRows, [this](std::size_t i) { return column(i); });
  }
};

/// The error series of one channel in SI, where the file has samples of it.
std::vector<double> errors_of(const Channel& channel) {
  std::vector<double> values;
  for (std::size_t i = 0; i < channel.valid.size(); ++i) {
    if (channel.valid[i] != 0) {
      values.push_back(channel.error[i]);
    }
  }
  return values;
}

void expect_the_same_errors(const File& file, double rounding) {
  const auto study = file.study();
  const auto view = file.view();
  ASSERT_TRUE(study) << study.error().message;
  ASSERT_TRUE(view) << view.error().message;
  ASSERT_EQ(study->channels.size(), view->channels.size());
  for (std::size_t c = 0; c < view->channels.size(); ++c) {
    const ChannelView& seen = view->channels[c];
    const std::vector<double> errors = errors_of(study->channels[c]);
    ASSERT_EQ(study->channels[c].column, seen.column);
    ASSERT_EQ(errors.size(), seen.values.size());
    for (std::size_t i = 0; i < errors.size(); ++i) {
      ASSERT_NEAR(errors[i], seen.role.unit->to_si(seen.values[i]), rounding) << seen.column << " " << i;
    }
  }
}

bool says(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

// A rate that is subtracted in the column's unit or in SI differs by the rounding of some 4 rad/s.
constexpr double kRounding = 1e-14;

TEST(StudyAndView, TakeTheSameReferenceFromAColumn) {
  File file;
  file.add("gz", noise(1), role(Quantity::AngularRate, "z", "deg/s"));
  std::vector<double> rate(kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    rate[i] = std::sin(0.01 * static_cast<double>(i));
    file.columns[0][i] += rate[i];
  }
  file.add("rz", rate, role(Quantity::ReferenceAngularRate, "z", "deg/s"));
  file.spec.condition.kind = ConditionKind::Profile;
  expect_the_same_errors(file, kRounding);
}

TEST(StudyAndView, TakeTheSameRateFromAnAngleThatWraps) {
  File file;
  file.add("gz", noise(2), role(Quantity::AngularRate, "z", "rad/s"));
  std::vector<double> angle(kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    angle[i] = std::fmod(1.5 * kDt * static_cast<double>(i), kTurn);
  }
  file.add("angle", angle, role(Quantity::ReferenceAngle, "z", "rad"));
  file.spec.condition.kind = ConditionKind::Profile;
  expect_the_same_errors(file, 1e-12);  // of an angle of 120 rad, over 2 dt
}

TEST(StudyAndView, TakeTheSameRampFromRest) {
  File file;
  file.add("gz", noise(3), role(Quantity::AngularRate, "z", "rad/s"));
  file.spec.condition.kind = ConditionKind::ConstantAngularAcceleration;
  file.spec.condition.axis = "z";
  file.spec.condition.value = 0.05;
  file.spec.condition.unit = "rad/s^2";
  expect_the_same_errors(file, kRounding);
}

TEST(StudyAndView, LeaveOutTheSameSamples) {
  // Story: two empty cells in a day of samples, which characterise left out and said, were refused by investigate; and
  // a logger's -9999 was an outlier to one and no measurement to the other.
  File file;
  file.add("gz", noise(4), role(Quantity::AngularRate, "z", "deg/s"));
  for (const std::size_t hole : {std::size_t{700}, std::size_t{701}, kRows - 1}) {
    file.columns[0][hole] = kNan;
  }
  file.columns[0][0] = -9999.0;
  expect_the_same_errors(file, kRounding);
  const auto study = file.study();
  EXPECT_EQ(study->length, kRows);
  EXPECT_EQ(study->channels[0].valid.absent(), 4U);
  EXPECT_EQ(study->channels[0].rows.size(), kRows - 4);
  EXPECT_EQ(study->stamps.missing, 0U) << "what the time column says, and there is none";
  EXPECT_TRUE(says(study->notes, "3 samples are missing")) << study->notes[0];
  EXPECT_TRUE(says(study->notes, "1 sample is no measurement"));
  EXPECT_TRUE(says(study->notes, "4 rows lack a sample"));
  for (std::size_t i = 0; i < kRows; ++i) {
    ASSERT_LT(std::fabs(study->channels[0].error[i]), 0.01) << "between neighbours, or as the first or last: " << i;
  }
}

TEST(StudyAndView, ARowThatLacksOneSensorHasNoneInAStudy) {
  File file;
  file.add("gx", noise(5), role(Quantity::AngularRate, "x", "deg/s"));
  file.add("gz", noise(6), role(Quantity::AngularRate, "z", "deg/s"));
  file.columns[0][100] = file.columns[1][200] = kNan;
  const auto study = file.study();
  ASSERT_TRUE(study) << study.error().message;
  for (const Channel& channel : study->channels) {
    EXPECT_EQ(channel.valid[100], 0) << channel.column;
    EXPECT_EQ(channel.valid[200], 0) << channel.column;
    EXPECT_EQ(channel.valid.absent(), 2U) << channel.column;
  }
}

TEST(StudyAndView, AHoleInAReferenceIsNoZeroRate) {
  File file;
  file.add("gz", std::vector<double>(kRows, 1.0), role(Quantity::AngularRate, "z", "rad/s"));
  file.add("rz", std::vector<double>(kRows, 1.0), role(Quantity::ReferenceAngularRate, "z", "rad/s"));
  file.columns[0][1] = 1.0001;  // a sensor of one value is frozen
  file.columns[1][50] = kNan;
  file.spec.condition.kind = ConditionKind::Profile;
  const auto study = file.study();
  ASSERT_TRUE(study) << study.error().message;
  EXPECT_EQ(study->channels[0].valid[50], 0);
  EXPECT_EQ(study->channels[0].error[50], 0.0);
  EXPECT_EQ(study->rate[2][50], 1.0);
}

TEST(StudyAndView, ATimeWithoutAUnitIsSecondsOnlyWhereTheRateSaysSo) {
  const auto stamped = [](double unit_s, std::optional<double> rate_hz) {
    File file;
    file.spec.rate_hz = rate_hz;
    std::vector<double> stamps(kRows);
    for (std::size_t i = 0; i < kRows; ++i) {
      stamps[i] = kDt * static_cast<double>(i) / unit_s;
    }
    file.add("t", stamps, ColumnRole{Quantity::Time, "", std::nullopt});
    file.add("gz", noise(5), role(Quantity::AngularRate, "z", "rad/s"));
    return file;
  };
  const File seconds = stamped(1.0, 1.0 / kDt);
  ASSERT_TRUE(seconds.study());
  EXPECT_NEAR(seconds.study()->dt_s, kDt, 1e-9);
  for (const File& file : {stamped(1e-3, 1.0 / kDt), stamped(1.0, std::nullopt), stamped(1e-3, std::nullopt)}) {
    const auto study = file.study();
    const auto view = file.view();
    ASSERT_FALSE(study);
    ASSERT_FALSE(view);
    EXPECT_EQ(study.error().code, ErrorCode::InconsistentSampling);
    EXPECT_EQ(study.error().message, view.error().message);
  }
  EXPECT_NE(stamped(1e-3, 1.0 / kDt).study().error().message.find("In ms it would agree"), std::string::npos);
}

TEST(StudyAndView, RefuseTheSameColumns) {
  File text;
  text.add("gz", noise(7), role(Quantity::AngularRate, "z", "deg/s"));
  text.columns[0][9] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(text.study().error().message, text.view().error().message);
  EXPECT_EQ(text.study().error().code, ErrorCode::NonFinite);
  File sparse;
  sparse.add("gz", noise(8), role(Quantity::AngularRate, "z", "deg/s"));
  std::fill_n(sparse.columns[0].begin(), kRows / 2, kNan);
  EXPECT_EQ(sparse.study().error().message, sparse.view().error().message);
}

TEST(StudyAndView, PassOverTheSameColumns) {
  // Story: a counter beside the sensors was named as skipped by characterise and examined by investigate.
  File file;
  file.add("gyro_x (deg/s)", noise(9), std::nullopt);
  file.add("counter", noise(10), std::nullopt);
  const auto study = file.study();
  const auto view = file.view();
  ASSERT_TRUE(study) << study.error().message;
  ASSERT_TRUE(view) << view.error().message;
  ASSERT_EQ(study->channels.size(), 1U);
  ASSERT_EQ(view->channels.size(), 1U);
  EXPECT_TRUE(says(study->notes, "skipped: 'counter'"));
  EXPECT_TRUE(says(view->window.quality.notes, "skipped: 'counter'"));
}

TEST(StudyAndView, ATemperatureThatIsRecordedLessOftenIsReadBetween) {
  File file;
  file.add("gz", noise(11), role(Quantity::AngularRate, "z", "deg/s"));
  std::vector<double> temperature(kRows, kNan);
  for (std::size_t i = 5; i < kRows; i += 10) {
    temperature[i] = 300.0 + 0.001 * static_cast<double>(i);
  }
  file.add("temperature", temperature, role(Quantity::Temperature, "", "K"));
  const auto study = file.study();
  ASSERT_TRUE(study) << study.error().message;
  EXPECT_EQ(study->channels[0].valid.absent(), 0U);
  for (std::size_t i = 0; i < kRows; ++i) {
    const double at = std::clamp(static_cast<double>(i), 5.0, static_cast<double>(kRows - 5));
    ASSERT_NEAR(study->temperature[i], 300.0 + 0.001 * at, 1e-9) << i;
  }
  file.columns[1].assign(kRows, kNan);
  const auto without = file.study();
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_TRUE(without->temperature.empty());
}

TEST(StudyAndView, WhatIsMissingChangesNoVerdict) {
  // Three samples are missing from white noise: nothing is found, as with all of them.
  File file;
  file.add("gz", noise(12), role(Quantity::AngularRate, "z", "deg/s"));
  for (std::size_t i = 50; i < kRows; i += 1500) {
    file.columns[0][i] = kNan;
  }
  auto recording = file.study();
  ASSERT_TRUE(recording) << recording.error().message;
  Study study;
  study.id = "holes";
  study.recordings.push_back(std::move(*recording));
  settle_channels(study);
  const auto report = investigate(study);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(report->findings.empty()) << report->findings[0].explanation;
}

}  // namespace
}  // namespace driftlab::investigate
