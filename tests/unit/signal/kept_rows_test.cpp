// What trims leave of a recording with even steps: the rule of characterise and of investigate.
#include "core/signal/kept_rows.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

TEST(KeptRows, ASampleAtExactlyTheTrimStays) {
  const KeptRows kept = kept_rows({0.5, 0.25}, 0.01, 1000);
  EXPECT_EQ(kept.first, 50);
  EXPECT_EQ(kept.end, 975);
  EXPECT_EQ(kept.count(), 925);
}

TEST(KeptRows, RoundingOfSecondsOverStepsTakesNoSample) {
  // 0.07 s at 100 Hz are 7.000000000000001 steps in floating point, and 7 samples.
  EXPECT_EQ(kept_rows({0.07, 0.0}, 0.01, 1000).first, 7);
  EXPECT_EQ(kept_rows({0.0701, 0.0}, 0.01, 1000).first, 8) << "a tenth of a millisecond more is the next sample";
}

TEST(KeptRows, TrimsBeyondTheRecordingLeaveNothing) {
  EXPECT_EQ(kept_rows({6.0, 6.0}, 0.01, 1000).count(), 0);
  EXPECT_EQ(kept_rows({1e12, 1e12}, 0.01, 1000).count(), 0);
  EXPECT_EQ(kept_rows({-1.0, 0.0}, 0.01, 1000).count(), 1000);
}

}  // namespace
}  // namespace driftlab
