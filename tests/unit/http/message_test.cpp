#include "server/http/message.hpp"

#include <gtest/gtest.h>

namespace driftlab::server {
namespace {

const std::vector<std::string_view> kTables{"application/json", "text/csv", "text/plain"};

TEST(Negotiate, TakesTheFirstWithoutAWish) {
  EXPECT_EQ(negotiate(std::nullopt, kTables), "application/json");
  EXPECT_EQ(negotiate(" ", kTables), "application/json");
  EXPECT_EQ(negotiate("*/*", kTables), "application/json");
}

TEST(Negotiate, FollowsQualityAndTheMostSpecificRange) {
  EXPECT_EQ(negotiate("text/csv", kTables), "text/csv");
  EXPECT_EQ(negotiate("TEXT/CSV; charset=utf-8", kTables), "text/csv");
  EXPECT_EQ(negotiate("text/*", kTables), "text/csv");
  EXPECT_EQ(negotiate("text/csv;q=0.4, text/plain;q=0.5", kTables), "text/plain");
  EXPECT_EQ(negotiate("*/*;q=0.1, text/*;q=0.9, text/csv;q=0.2", kTables), "text/plain");
  EXPECT_EQ(negotiate("application/json;q=0, */*", kTables), "text/csv");
}

TEST(Negotiate, GivesNothingWhereNothingIsAcceptable) {
  for (const char* const accept :
       {"image/png", "text/csv;q=0", "text", "text/csvx", "*/json", "application/json;q=nonsense"}) {
    EXPECT_FALSE(negotiate(accept, kTables)) << accept;
  }
}

TEST(Target, IsSplitAndDecoded) {
  const auto target =
      parse_target("/v1/devices/a%20b?device=phone+07&columns=gz%3Dangular_rate:z:deg/s&empty=&bare&&unit=m/s^2");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/v1/devices/a b");
  EXPECT_EQ(target->query, (std::vector<std::pair<std::string, std::string>>{{"device", "phone 07"},
                                                                             {"columns", "gz=angular_rate:z:deg/s"},
                                                                             {"empty", ""},
                                                                             {"bare", ""},
                                                                             {"unit", "m/s^2"}}));
  EXPECT_EQ(parse_target("/a+b")->path, "/a+b");
  EXPECT_EQ(parse_target("/a?note=\"b&c=d\" ")->query,
            (std::vector<std::pair<std::string, std::string>>{{"note", "\"b"}, {"c", "d\" "}}));
}

TEST(Target, MalformedIsNothing) {
  for (const char* const target :
       {"", "v1", "*", "http://localhost/", "/%", "/%4", "/%zz", "/a%00b", "/?x=%g0", "/?%"}) {
    EXPECT_FALSE(parse_target(target)) << target;
  }
}

TEST(PercentEncode, IsUndoneByDecoding) {
  std::string every;
  for (int byte = 0; byte < 256; ++byte) {
    every += static_cast<char>(byte);
  }
  const std::string encoded = percent_encode(every);
  EXPECT_EQ(percent_decode(encoded, true), every);
  EXPECT_EQ(encoded.find_first_of("\r\n&=#<>\" +"), std::string::npos);
  EXPECT_EQ(percent_encode("a-Z_0.9~"), "a-Z_0.9~");
}

TEST(Response, FindsHeadersWhateverTheirCase) {
  Response response;
  response.headers.emplace_back("ETag", "x");
  EXPECT_TRUE(response.has_header("etag"));
  EXPECT_FALSE(response.has_header("eta"));
}

TEST(Prefer, SaysHowLongToWait) {
  const auto wait = [](const char* value) {
    Request request;
    request.headers = {{"prefer", value}};
    return preferred_wait(request);
  };
  EXPECT_EQ(wait("wait=20"), std::chrono::seconds(20));
  EXPECT_EQ(wait("respond-async, wait=5"), std::chrono::seconds(5));
  EXPECT_EQ(wait("wait=3600"), std::chrono::seconds(60));
  EXPECT_EQ(wait("wait=0"), std::chrono::seconds(0)) << "not the same as saying nothing";
  EXPECT_EQ(wait("wait=-3"), std::chrono::seconds(0));
  EXPECT_EQ(wait("wait=soon"), std::chrono::seconds(0));
  EXPECT_FALSE(wait("respond-async"));
  EXPECT_FALSE(preferred_wait(Request{}));
}

TEST(Request, GivesFirstValues) {
  Request request;
  request.headers = {{"accept", "a"}, {"accept", "b"}};
  request.query = {{"limit", "1"}, {"limit", "2"}};
  EXPECT_EQ(request.header("accept"), "a");
  EXPECT_EQ(request.parameter("limit"), "1");
  EXPECT_FALSE(request.parameter("cursor"));
}

}  // namespace
}  // namespace driftlab::server
