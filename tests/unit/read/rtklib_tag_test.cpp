// The time tag beside a log: what RTKLIB's stream.c writes, made here byte by byte.
#include "core/read/rtklib_tag.hpp"

#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace driftlab {
namespace {

using namespace driftlab::testing;
using ::testing::HasSubstr;

constexpr std::uint32_t kStart = 1'752'003'261;  // 2025-07-08 19:34:21 GPST
constexpr double kFraction = 0.853515625;        // exact in a double, as is its sum with the start
constexpr std::size_t kHeader = 76;
constexpr std::size_t kEntry = 8;

/// 60 bytes of text, the tick of the start, its time and fraction; then milliseconds and bytes of each entry.
std::string tag_of(const std::vector<std::uint32_t>& entries_ms, std::uint32_t start = kStart,
                   double fraction = kFraction, const std::string& text = "TIMETAG RTKLIB 2.4.2") {
  std::string bytes = padded(text, 60) + word(123'456'789, 4) + word(start, 4) + bytes_of(fraction);
  for (std::size_t i = 0; i < entries_ms.size(); ++i) {
    bytes += word(entries_ms[i], 4) + word(64 * (i + 1), 4);
  }
  return bytes;
}

void expect_refused(const Result<RtklibTag>& tag, ErrorCode code, const std::string& words) {
  ASSERT_FALSE(tag);
  EXPECT_EQ(tag.error().code, code) << tag.error().message;
  EXPECT_THAT(tag.error().message, HasSubstr(words));
  EXPECT_TRUE(tag.error().message.ends_with('.')) << tag.error().message;
}

TEST(RtklibTag, DatesTheStartAndTheLastEntry) {
  const auto tag = parse_rtklib_tag(tag_of({131, 146, 2500}));
  ASSERT_TRUE(tag) << tag.error().message;
  EXPECT_EQ(tag->first_s, kStart + kFraction);
  EXPECT_EQ(tag->last_s, kStart + kFraction + 2.5);
}

TEST(RtklibTag, CutAtAnyByteIsThatOfItsWholeEntriesOrASentence) {
  const std::vector<std::uint32_t> entries{250, 500, 1250};
  const std::string whole = tag_of(entries);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const auto tag = parse_rtklib_tag(std::string_view(whole).substr(0, length));
    if (length < kHeader + kEntry) {
      expect_refused(tag, ErrorCode::Truncated, length < kHeader ? "within its header" : "before its first entry");
      continue;
    }
    ASSERT_TRUE(tag) << length << ": " << tag.error().message;
    EXPECT_EQ(tag->last_s - tag->first_s, 1e-3 * entries[(length - kHeader) / kEntry - 1]) << length;
  }
}

TEST(RtklibTag, RefusesOtherBytesAtAnyPlaceOfItsSignature) {
  const std::string whole = tag_of({1000});
  for (std::size_t i = 0; i < kTagSignature.size(); ++i) {
    std::string other = whole;
    other[i] = static_cast<char>(other[i] ^ 0x20);
    expect_refused(parse_rtklib_tag(other), ErrorCode::UnsupportedFormat, "begins with other bytes");
    expect_refused(parse_rtklib_tag(other.substr(0, i + 1)), ErrorCode::UnsupportedFormat, "begins with other bytes");
  }
  expect_refused(parse_rtklib_tag("t,gx\n0,1\n"), ErrorCode::UnsupportedFormat, "begins with other bytes");
}

TEST(RtklibTag, RefusesAStartThatIsNoTime) {
  for (const double fraction : {-1e-9, 1.0, 1e300, std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    expect_refused(parse_rtklib_tag(tag_of({1000}, kStart, fraction)), ErrorCode::UnsupportedFormat, "is no time");
  }
  // A board without a clock that is powered counts from 1970; GPS time begins on 1980-01-06.
  constexpr std::uint32_t kGpsEpoch = 315'964'800;
  for (const std::uint32_t start : {0U, kGpsEpoch - 1}) {
    expect_refused(parse_rtklib_tag(tag_of({1000}, start)), ErrorCode::UnsupportedFormat, "had no date");
  }
  EXPECT_TRUE(parse_rtklib_tag(tag_of({1000}, kGpsEpoch)));
}

TEST(RtklibTag, TakesTheLargestCountsAsTheyAreAndRefusesATagOfNoTime) {
  const std::uint32_t most = std::numeric_limits<std::uint32_t>::max();
  const auto tag = parse_rtklib_tag(tag_of({0, most}, most));
  ASSERT_TRUE(tag) << tag.error().message;
  EXPECT_EQ(tag->first_s, most + kFraction);
  EXPECT_EQ(tag->last_s, tag->first_s + 1e-3 * most) << "49.7 days, all that 32 bits of milliseconds hold";
  // All samples of the log would have been dated to one moment.
  expect_refused(parse_rtklib_tag(tag_of({0})), ErrorCode::TooFewSamples, "dates no log");
  expect_refused(parse_rtklib_tag(tag_of({250, 0})), ErrorCode::TooFewSamples, "dates no log");
}

TEST(RtklibTag, IsReadFromAFilePlainOrCompressedUpToItsLimit) {
  const TemporaryDirectory directory;
  const std::string whole = tag_of({131, 2500});
  for (const Compression kind : kCompressions) {
    write_file(directory / "log.tag", compress(kind, whole));
    const auto tag = read_rtklib_tag(directory / "log.tag");
    ASSERT_TRUE(tag) << tag.error().message;
    EXPECT_EQ(tag->last_s, kStart + kFraction + 2.5);
  }
  write_file(directory / "log.tag", gzip(whole).substr(0, 40));
  expect_refused(read_rtklib_tag(directory / "log.tag"), ErrorCode::Truncated, "");
  write_file(directory / "log.tag", zstd(whole + std::string(std::size_t{64} << 20, '\0')));
  expect_refused(read_rtklib_tag(directory / "log.tag"), ErrorCode::LimitExceeded, "64 MiB");
  write_file(directory / "log.tag", "");
  expect_refused(read_rtklib_tag(directory / "log.tag"), ErrorCode::Truncated, "within its header");
  expect_refused(read_rtklib_tag(directory / "none.tag"), ErrorCode::NotFound, "");
}

}  // namespace
}  // namespace driftlab
