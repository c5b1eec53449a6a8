/// A column drawn between two times, with what is no noise of the sensor marked.
#include "core/analysis/draw_trace.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

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
  ~DrawTrace() override { std::filesystem::remove_all(folder_); }

  Result<RecordingTrace> draw(const std::vector<double>& values, const TraceRequest& request) const {
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
  request.survey.longest_gaps = {{40, 7}};
  request.survey.frozen = SampleStretch{60, 20};
  request.survey.implausible = {{10, 2}};
  const auto trace = draw(ramp(100), request);
  ASSERT_TRUE(trace);
  EXPECT_EQ(times_of(*trace, TraceMark::Trim), (Times{{0.0, 1.0}, {9.5, 10.0}}));
  EXPECT_EQ(times_of(*trace, TraceMark::Gap), (Times{{3.9, 4.0}})) << "between row 39 and the one behind the gap";
  EXPECT_EQ(times_of(*trace, TraceMark::Frozen), (Times{{6.0, 8.0}}));
  EXPECT_EQ(times_of(*trace, TraceMark::Flagged), (Times{{1.0, 1.2}}));
  for (const MarkedTime& one : trace->marks) {
    EXPECT_EQ(one.missing, one.mark == TraceMark::Gap ? 7 : 0);
  }
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
