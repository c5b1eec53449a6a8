#include "server/http/byte_range.hpp"

#include <gtest/gtest.h>

namespace driftlab::server {
namespace {

using Kind = WantedBytes::Kind;

WantedBytes of(std::vector<std::pair<std::string, std::string>> headers, std::uint64_t size = 1000,
               const char* method = "GET") {
  Request request;
  request.method = method;
  request.headers = std::move(headers);
  return wanted_bytes(request, size, "\"tag\"");
}

void expect_part(const char* range, std::uint64_t first, std::uint64_t length) {
  const WantedBytes found = of({{"range", range}});
  EXPECT_EQ(found.kind, Kind::Part) << range;
  EXPECT_EQ(found.first, first) << range;
  EXPECT_EQ(found.length, length) << range;
}

// RFC 9110, section 14.1.2, has these forms.
TEST(ByteRange, HasTheFormsOfTheStandard) {
  expect_part("bytes=0-499", 0, 500);
  expect_part("bytes=500-999", 500, 500);
  expect_part("bytes=500-", 500, 500);
  expect_part("bytes=-500", 500, 500);
  expect_part("bytes=999-5000", 999, 1);
  expect_part("bytes=-5000", 0, 1000);
  expect_part("Bytes=0-0", 0, 1);
  expect_part("bytes=1-99999999999999999999999", 1, 999);
}

TEST(ByteRange, BehindTheEndThereIsNothing) {
  for (const char* const range : {"bytes=1000-", "bytes=1000-1001", "bytes=99999999999999999999-", "bytes=-0"}) {
    EXPECT_EQ(of({{"range", range}}).kind, Kind::None) << range;
  }
  EXPECT_EQ(of({{"range", "bytes=0-"}}, 0).kind, Kind::None);
}

TEST(ByteRange, WhatIsNoRangeOfBytesGivesTheWhole) {
  for (const char* const range : {"", "bytes", "bytes=", "bytes=-", "bytes=a-b", "bytes=5-4", "bytes=1-x", "items=0-1",
                                  "bytes=0-1,5-6", "bytes= 0-1 x", "bytes=+1-2", "bytes=--1"}) {
    const WantedBytes found = of({{"range", range}});
    EXPECT_EQ(found.kind, Kind::Whole) << range;
    EXPECT_EQ(found.length, 1000U) << range;
  }
  EXPECT_EQ(of({{"range", "bytes=0-1"}}, 1000, "HEAD").kind, Kind::Whole);
}

TEST(ByteRange, CountsOnlyForTheTagThatIsKnown) {
  EXPECT_EQ(of({{"range", "bytes=0-1"}, {"if-range", "\"tag\""}}).kind, Kind::Part);
  EXPECT_EQ(of({{"range", "bytes=0-1"}, {"if-range", "\"other\""}}).kind, Kind::Whole);
  EXPECT_EQ(of({{"range", "bytes=0-1"}, {"if-range", "W/\"tag\""}}).kind, Kind::Whole);
  EXPECT_EQ(of({{"range", "bytes=0-1"}, {"if-range", "Sun, 22 Nov 2026 00:00:00 GMT"}}).kind, Kind::Whole);
}

}  // namespace
}  // namespace driftlab::server
