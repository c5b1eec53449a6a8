#include "server/store/s3/place.hpp"

#include "server/store/s3/keys.hpp"
#include "tests/unit/store/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace driftlab::server::s3 {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(S3Place, ReadsEveryPart) {
  const auto place = read_place("s3://lab-data/unit/7/?endpoint=http%3A%2F%2F%5B::1%5D:9000&region=eu-west-1");
  ASSERT_TRUE(place) << place.error().message;
  EXPECT_EQ(place->bucket, "lab-data");
  EXPECT_EQ(place->prefix, "unit/7/");
  EXPECT_FALSE(place->secure);
  EXPECT_EQ(place->authority(), "[::1]:9000");
  EXPECT_EQ(place->region, "eu-west-1");
}

TEST(S3Place, WithoutAnEndpointIsThatOfTheRegion) {
  const auto place = read_place("s3://lab");
  ASSERT_TRUE(place);
  EXPECT_EQ(place->prefix, "");
  EXPECT_TRUE(place->secure);
  EXPECT_EQ(place->authority(), "s3.us-east-1.amazonaws.com");
  EXPECT_EQ(read_place("s3://lab?region=eu-north-1")->authority(), "s3.eu-north-1.amazonaws.com");
  EXPECT_EQ(read_place("s3://lab?endpoint=https://Store.example:8080")->authority(), "store.example:8080");
}

TEST(S3Place, RefusesWhatItIsNotAndRepeatsNothing) {
  for (const char* text : {"s3:",
                           "s3:lab",
                           "s3://",
                           "s3:///prefix",
                           "s3://AKIA:secret@lab",
                           "s3://l",
                           "s3://lab:80",
                           "s3://lab/a//b",
                           "s3://lab/../up",
                           "s3://lab/a%20b",
                           "s3://lab?bucket=secret",
                           "s3://lab?endpoint=secret",
                           "s3://lab#secret",
                           "s3://lab?endpoint=https://me:secret@store",
                           "s3://lab?endpoint=ftp://store",
                           "s3://lab?endpoint=https://store/x",
                           "s3://lab?region=",
                           "s3://lab?region=a/b",
                           "s3://lab?endpoint=http://store:0",
                           "s3://lab?secret=AKIA"}) {
    const auto place = read_place(text);
    ASSERT_FALSE(place) << text;
    EXPECT_EQ(place.error().code, ErrorCode::InvalidArgument);
    EXPECT_THAT(place.error().message, Not(HasSubstr("secret"))) << text;
    EXPECT_THAT(place.error().message, testing::EndsWith("."));
  }
}

TEST(S3Keys, ReadTheSectionDefault) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "credentials";
  std::ofstream(file) << "[other]\naws_access_key_id = wrong\n[default]\r\n aws_access_key_id = AKIA \r\n"
                         "aws_secret_access_key=a/b=c\n# aws_session_token = no\n[last]\naws_session_token = no\n";
  const auto key = read_key_file(file);
  ASSERT_TRUE(key) << key.error().message;
  EXPECT_EQ(key->key_id, "AKIA");
  EXPECT_EQ(key->secret, "a/b=c");
  EXPECT_EQ(key->session_token, "");
}

TEST(S3Keys, AFileThatChangesIsReadAgainAndOneThatIsHalfWrittenIsNot) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "credentials";
  const auto write = [&](const std::string& text, int seconds) {
    std::ofstream(file) << text;
    std::filesystem::last_write_time(file,
                                     std::filesystem::file_time_type::clock::now() + std::chrono::seconds(seconds));
  };
  write("aws_access_key_id=one\naws_secret_access_key=1\n", 0);
  const auto ring = find_key(file);
  ASSERT_TRUE(ring);
  EXPECT_EQ((*ring)()->key_id, "one");
  write("aws_access_key_id=two\n", 1);
  EXPECT_EQ((*ring)()->key_id, "one");
  write("aws_access_key_id=two\naws_secret_access_key=2\n", 2);
  EXPECT_EQ((*ring)()->key_id, "two");
}

TEST(S3Keys, WhatIsNoKeyIsSaidWithoutItsWords) {
  const TemporaryDirectory directory;
  EXPECT_EQ(find_key(directory.path() / "none").error().code, ErrorCode::NotFound);
  std::ofstream(directory.path() / "half") << "aws_secret_access_key = s3cret\n";
  const auto half = find_key(directory.path() / "half");
  EXPECT_EQ(half.error().code, ErrorCode::ParseError);
  EXPECT_THAT(half.error().message, Not(HasSubstr("s3cret")));
}

}  // namespace
}  // namespace driftlab::server::s3
