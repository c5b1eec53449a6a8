// What was found true of a recording, through its document and back.
#include "schema/json/quality.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

TEST(QualityDocument, GivesBackWhatWasFound) {
  Quality quality;
  quality.samples = 15000;
  quality.repeated_rows = 2;
  quality.analysed = 14000;
  quality.missing = 12;
  quality.gaps = 3;
  quality.repeated_stamps = 4;
  quality.backward_steps = 5;
  quality.counter_wraps = 1;
  quality.bursts = true;
  quality.longest_gap_s = 0.25;
  quality.jitter_s = 1e-4;
  quality.measured_rate_hz = 50.2;
  quality.clock_ratio = 1.004;
  quality.channels = {{"gz", 3, 4, 30, 200, 0.01, 2, 50, 7, 57, 14900, 13000}};
  quality.notes = {"The column t has no unit."};
  const Json document = to_json(quality);
  const Quality read = quality_from_json(*parse_json(to_text(document)));
  EXPECT_EQ(to_text(to_json(read)), to_text(document));
  EXPECT_EQ(frozen_samples(read, "gz"), 50U);
  EXPECT_EQ(read.clock_ratio, 1.004);
}

TEST(QualityDocument, OfAnOlderRecordingHasFoundNothing) {
  for (const char* const text : {"null", "{}", R"({"samples": null, "channels": [{"column": "gz"}, {}]})"}) {
    const Quality read = quality_from_json(*parse_json(text));
    EXPECT_EQ(read.samples, 0U) << text;
    EXPECT_EQ(frozen_samples(read, "gz"), 0U) << text;
    EXPECT_FALSE(read.clock_ratio) << text;
  }
}

}  // namespace
}  // namespace driftlab
