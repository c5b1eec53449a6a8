/// A column drawn between two times, with what is no noise of the sensor marked.
#include "core/analysis/draw_trace.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>

namespace driftlab {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

class DrawTrace : public ::testing::Test {
 protected:
  DrawTrace() {
    std::string name = (std::filesystem::temp_directory_path() / "driftlab-trace-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] Result<RecordingTrace> draw(const std::vector<double>& values, const TraceRequest& request) const {
    auto writer = ColumnFileWriter::create(folder_ / "columns", {"gz"});
    EXPECT_TRUE(writer && writer->append_rows(values) && writer->finish());
    const auto columns = ColumnFile::open(folder_ / "columns");
    EXPECT_TRUE(columns);
    return draw_trace(*columns, folder_ / "pyramid", request);
  }

 private:
  std::filesystem::path folder_;
};

std::vector<double> ramp(std::size_t rows) {
  std::vector<double> values(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    values[i] = static_cast<double>(i);
  }
  return values;
}

/// A trace of the whole of a 10 Hz recording, sample by sample.
TraceRequest each_sample(std::size_t rows) {
  TraceRequest request;
  request.rate_hz = 10.0;
  request.stretches = rows;
  return request;
}

using Times = std::vector<std::pair<double, double>>;

Times times_of(const RecordingTrace& trace, TraceMark mark) {
  Times times;
  for (const MarkedTime& one : trace.marks) {
    if (one.mark == mark) {
      times.emplace_back(one.t0_s, one.t1_s);
    }
  }
  return times;
}

TEST_F(DrawTrace, HoldsTheRowsBetweenTheTimesAskedFor) {
  TraceRequest request = each_sample(100);
  request.t0_s = 2.0;
  request.t1_s = 4.0;
  request.stretches = 5;
  const auto trace = draw(ramp(100), request);
  ASSERT_TRUE(trace) << trace.error().message;
  ASSERT_EQ(trace->buckets.size(), 5);
  EXPECT_EQ(trace->samples_per_bucket, 4);
  EXPECT_EQ(trace->buckets.front().first, 20);
  EXPECT_EQ(trace->buckets.front().low, 20.0);
  EXPECT_EQ(trace->buckets.back().high, 39.0);
  EXPECT_EQ(trace->time_s.back(), 3.6);
  EXPECT_EQ(trace->duration_s, 10.0);
}

TEST_F(DrawTrace, AMomentWithinASampleIsThatSampleAndTheFarEndIsTheLast) {
  TraceRequest request = each_sample(100);
  request.t0_s = 3.01;
  request.t1_s = 3.02;
  EXPECT_EQ(draw(ramp(100), request)->buckets.size(), 1);
  EXPECT_EQ(draw(ramp(100), request)->buckets.front().low, 30.0);
  request.t0_s = 1e6;
  request.t1_s = 2e6;
  EXPECT_EQ(draw(ramp(100), request)->buckets.front().low, 99.0);
}

TEST_F(DrawTrace, RefusesAnEndBeforeTheBeginning) {
  TraceRequest request = each_sample(100);
  request.t0_s = 4.0;
  request.t1_s = 4.0;
  const auto refused = draw(ramp(100), request);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::InvalidArgument);
  EXPECT_FALSE(draw({}, each_sample(1))) << "no row at all";
}

TEST_F(DrawTrace, StretchesThatLackSamplesAreJoinedWhereTheyTouch) {
  std::vector<double> values = ramp(20);
  values[5] = values[6] = values[12] = kNone;
  const auto trace = draw(values, each_sample(20));
  ASSERT_TRUE(trace);
  ASSERT_EQ(trace->missing.size(), 2);
  EXPECT_EQ(trace->missing[0].t0_s, 0.5);
  EXPECT_EQ(trace->missing[0].t1_s, 0.7);
  EXPECT_EQ(trace->missing[1].t0_s, 1.2);
}

TEST_F(DrawTrace, MarksTheEndsThatWereTrimmedAndWhatTheSurveyFound) {
  TraceRequest request = each_sample(100);
  request.trim = {1.0, 0.5};
  request.survey.frozen = SampleStretch{60, 20};
  request.survey.implausible = {{10, 2}};
  const auto trace = draw(ramp(100), request);
  ASSERT_TRUE(trace);
  EXPECT_EQ(times_of(*trace, TraceMark::Trim), (Times{{0.0, 1.0}, {9.5, 10.0}}));
  EXPECT_EQ(times_of(*trace, TraceMark::Frozen), (Times{{6.0, 8.0}}));
  EXPECT_EQ(times_of(*trace, TraceMark::Flagged), (Times{{1.0, 1.2}}));
}

/// 100 rows at 10 Hz of which seven samples are lost before row 40.
TraceRequest with_a_gap() {
  TraceRequest request = each_sample(200);
  request.rate_hz = 99.0 / 10.6;
  request.survey.longest_gaps = {{40, 7}};
  request.survey.missing = 7;
  return request;
}

TEST_F(DrawTrace, AGapTakesItsTime) {
  // Story: a recording of 10 min without its fourth minute was drawn at 90 Hz throughout, its gap a hundredth of a
  // second wide and 22 s late.
  TraceRequest request = with_a_gap();
  request.survey.frozen = SampleStretch{60, 20};
  const auto trace = draw(ramp(100), request);
  ASSERT_TRUE(trace);
  EXPECT_NEAR(trace->rate_hz, 10.0, 1e-9);
  EXPECT_NEAR(trace->duration_s, 10.7, 1e-9);
  const auto gap = times_of(*trace, TraceMark::Gap);
  ASSERT_EQ(gap.size(), 1);
  EXPECT_NEAR(gap[0].first, 3.9, 1e-9) << "row 39";
  EXPECT_NEAR(gap[0].second, 4.7, 1e-9) << "row 40";
  EXPECT_EQ(trace->marks[0].missing, 7);
  EXPECT_NEAR(times_of(*trace, TraceMark::Frozen)[0].first, 6.7, 1e-9);
  EXPECT_TRUE(trace->missing.empty()) << "no row lacks its value";
}

TEST_F(DrawTrace, NoLineIsDrawnAcrossAGap) {
  const auto trace = draw(ramp(100), with_a_gap());
  ASSERT_EQ(trace->buckets.size(), 101);
  EXPECT_EQ(trace->buckets[40].present, 0);
  EXPECT_NEAR(trace->time_s[40], 4.0, 1e-9) << "where row 39 ends";
  EXPECT_NEAR(trace->time_s[41], 4.7, 1e-9);
  EXPECT_EQ(trace->buckets[41].low, 40.0);
  TraceRequest coarse = with_a_gap();
  coarse.stretches = 3;  // of 34 rows: the gap lies in the second
  const auto few = draw(ramp(100), coarse);
  ASSERT_EQ(few->buckets.size(), 4);
  EXPECT_EQ(few->buckets[2].present, 0);
  EXPECT_TRUE(std::is_sorted(few->time_s.begin(), few->time_s.end()));
}

TEST_F(DrawTrace, TimesBehindAGapFindTheirRows) {
  TraceRequest request = with_a_gap();
  request.t0_s = 5.71;
  request.t1_s = 5.91;
  EXPECT_EQ(draw(ramp(100), request)->buckets.front().low, 50.0);
  request.t0_s = 4.2;
  request.t1_s = 4.5;
  EXPECT_EQ(draw(ramp(100), request)->buckets.front().low, 40.0) << "in the gap: what comes behind it";
}

TEST_F(DrawTrace, GapsThatAreNotToldAreSpreadOverTheRows) {
  TraceRequest request = with_a_gap();
  request.rate_hz = 99.0 / 11.6;  // ten more samples are lost somewhere
  request.survey.missing = 17;
  const auto trace = draw(ramp(100), request);
  EXPECT_NEAR(times_of(*trace, TraceMark::Gap)[0].second - trace->time_s[39], 0.7 + 1.0 / trace->rate_hz, 1e-9);
  EXPECT_NEAR(trace->time_s.back(), 11.6, 1e-9);
}

TEST_F(DrawTrace, MarksWhereTheValuesPileUpAtAnEndOfTheRange) {
  std::vector<double> values(30, 0.0);
  values[3] = values[4] = 250.0;
  values[20] = -250.0;
  TraceRequest request = each_sample(30);
  request.survey.rails = Rails{-250.0, 250.0};
  EXPECT_EQ(times_of(*draw(values, request), TraceMark::Saturated), (Times{{0.3, 0.5}, {2.0, 2.1}}));
  request.survey.rails = Rails{std::nullopt, 250.0};
  EXPECT_EQ(times_of(*draw(values, request), TraceMark::Saturated), (Times{{0.3, 0.5}}));
}

}  // namespace
}  // namespace driftlab
