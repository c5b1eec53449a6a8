#include "server/http/answer_head.hpp"

#include <gtest/gtest.h>

namespace driftlab::server {
namespace {

TEST(AnswerHead, HoldsStatusTypeLengthAndWhatEveryAnswerSays) {
  Response response;
  response.status = 201;
  response.headers = {{"Location", "/v1/recordings/rec_1"}};
  EXPECT_EQ(answer_head(response, {"req_1", 17}),
            "HTTP/1.1 201 Created\r\nContent-Type: application/json\r\nContent-Length: 17\r\nX-Request-Id: req_1\r\n"
            "X-Content-Type-Options: nosniff\r\nContent-Security-Policy: default-src 'self'; frame-ancestors 'none'\r\n"
            "Referrer-Policy: no-referrer\r\nCache-Control: no-cache\r\nLocation: /v1/recordings/rec_1\r\n\r\n");
}

TEST(AnswerHead, LeavesWhatTheAnswerSaysItself) {
  Response response;
  response.headers = {{"Cache-Control", "no-store"}, {"content-security-policy", "default-src 'none'"}};
  const std::string head = answer_head(response, {"req_1", 0});
  EXPECT_EQ(head.find("no-cache"), std::string::npos);
  EXPECT_EQ(head.find("frame-ancestors"), std::string::npos);
  EXPECT_NE(head.find("\r\nCache-Control: no-store\r\n"), std::string::npos);
  EXPECT_NE(head.find("\r\nContent-Length: 0\r\n"), std::string::npos);
}

TEST(AnswerHead, HasNeitherTypeNorLengthWithoutContent) {
  for (const int status : {204, 304}) {
    Response response;
    response.status = status;
    const std::string head = answer_head(response, {"req_1", 0});
    EXPECT_EQ(head.find("Content-Type:"), std::string::npos) << status;
    EXPECT_EQ(head.find("Content-Length:"), std::string::npos) << status;
  }
}

TEST(AnswerHead, SaysThatTheConnectionClosesAndNoLengthOfWhatEndsWithIt) {
  const std::string head = answer_head({}, {"req_1", std::nullopt, true});
  EXPECT_TRUE(head.starts_with("HTTP/1.1 200 OK\r\nConnection: close\r\n")) << head;
  EXPECT_EQ(head.find("Content-Length:"), std::string::npos);
  EXPECT_TRUE(head.ends_with("\r\n\r\n"));
}

}  // namespace
}  // namespace driftlab::server
