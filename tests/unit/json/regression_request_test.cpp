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

}  // namespace
}  // namespace driftlab
