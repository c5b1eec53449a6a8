// A tag read with a compressed answer was refused when it came back with a change.
#include "server/http/compression.hpp"

#include <gtest/gtest.h>

namespace driftlab::server {
namespace {

Request asking(const std::string& encodings) {
  Request request;
  request.headers = {{"accept-encoding", encodings}};
  return request;
}

TEST(Compression, TagsOfBothRepresentationsAreOne) {
  EXPECT_EQ(plain_tag("\"rec_1-r1-gzip\""), "\"rec_1-r1\"");
  EXPECT_EQ(plain_tag("\"a\", \"b-gzip\""), "\"a\", \"b\"");
}

TEST(Compression, IsForWhoTakesItAlone) {
  EXPECT_TRUE(takes_gzip(asking("gzip, deflate, br")));
  EXPECT_FALSE(takes_gzip(asking("gzip;q=0, br")));
  EXPECT_FALSE(takes_gzip(asking("identity")));
}

TEST(Compression, OfALongTextChangesBodyAndTag) {
  Response response;
  response.body = std::string(5000, 'x');
  response.headers = {{"ETag", "\"t\""}, {"Vary", "Accept"}};
  compress(asking("gzip"), response);
  EXPECT_LT(response.body.size(), 100U);
  EXPECT_EQ(response.headers[0].second, "\"t-gzip\"");
  EXPECT_EQ(response.headers[1].second, "Accept, Accept-Encoding");
  EXPECT_TRUE(response.has_header("Content-Encoding"));
}

TEST(Compression, LeavesWhatIsShortOrNoText) {
  Response brief;
  brief.body = "{}";
  compress(asking("gzip"), brief);
  EXPECT_EQ(brief.body, "{}");
  Response font;
  font.content_type = "font/woff2";
  font.body = std::string(5000, 'x');
  compress(asking("gzip"), font);
  EXPECT_EQ(font.body.size(), 5000U);
}

}  // namespace
}  // namespace driftlab::server
