#include "server/http/guard.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace driftlab::server {
namespace {

const GuardLimits kLimits{8UL * 1024, {"localhost", "127.0.0.1", "[::1]"}};

HeadView head(std::string_view method, std::vector<std::pair<std::string, std::string>> headers) {
  return {11, method, "/v1/devices", std::move(headers)};
}

/// The slug of the refusal, or an empty text.
std::string refusal(const HeadView& view) {
  const GuardVerdict verdict = inspect(view, kLimits);
  if (!verdict.refusal) {
    return "";
  }
  return nlohmann::json::parse(verdict.refusal->body)["code"].get<std::string>();
}

TEST(Guard, LetsAnOrdinaryRequestPass) {
  const GuardVerdict verdict = inspect(
      head("POST", {{"host", "localhost:8477"}, {"content-length", "12"}, {"expect", "100-continue"}}), kLimits);
  EXPECT_FALSE(verdict.refusal);
  EXPECT_EQ(verdict.content_length, 12U);
  EXPECT_TRUE(verdict.expects_continue);
}

TEST(Guard, AnswersOnlyForItsOwnHosts) {
  for (const char* const host : {"localhost", "LocalHost:1", "127.0.0.1:8477", "[::1]", "[::1]:8477"}) {
    EXPECT_EQ(refusal(head("GET", {{"host", host}})), "") << host;
  }
  for (const char* const host :
       {"", "evil.example", "localhost.evil.example", "[::1", "[", "[]", "::1", "127.0.0.1.", "a@localhost"}) {
    EXPECT_EQ(refusal(head("GET", {{"host", host}})), "host_not_allowed") << host;
  }
  EXPECT_EQ(refusal(head("GET", {})), "host_not_allowed");
}

TEST(Guard, RefusesWhatMayBeGivenOnceWhenItComesTwice) {
  EXPECT_EQ(refusal(head("GET", {{"host", "localhost"}, {"host", "localhost"}})), "host_not_allowed");
  for (const char* const name : {"content-length", "content-type", "authorization", "origin", "sec-fetch-site"}) {
    const std::string value = name == std::string("origin") ? "http://localhost" : "none";
    EXPECT_EQ(refusal(head("POST", {{"host", "localhost"}, {name, value}, {name, value}})), "bad_request") << name;
  }
}

TEST(Guard, RefusesEveryTransferEncodingButChunkedAlone) {
  for (const char* const coding : {"gzip", "identity", "", "chunked, gzip", "gzip, chunked", "chunked, chunked"}) {
    EXPECT_EQ(refusal(head("POST", {{"host", "localhost"}, {"transfer-encoding", coding}})), "length_required");
  }
  for (const char* const coding : {"chunked", "gzip"}) {
    EXPECT_EQ(refusal(head("POST", {{"host", "localhost"}, {"content-length", "4"}, {"transfer-encoding", coding}})),
              "length_required");
    EXPECT_EQ(refusal(head("POST", {{"host", "localhost"}, {"transfer-encoding", coding}, {"content-length", "0"}})),
              "length_required");
  }
  HeadView upload = head("POST", {{"host", "localhost"}, {"transfer-encoding", "Chunked"}});
  EXPECT_TRUE(inspect(upload, kLimits).chunked);
  EXPECT_EQ(refusal(upload), "");
  upload.version = 10;
  EXPECT_EQ(refusal(upload), "length_required");
}

TEST(Guard, ReadsContentLengthStrictly) {
  for (const char* const length : {"", "-1", "+1", " 1", "1 ", "0x10", "1e3", "1,1", "18446744073709551616"}) {
    EXPECT_EQ(refusal(head("POST", {{"host", "localhost"}, {"content-length", length}})), "bad_request") << length;
  }
  EXPECT_EQ(inspect(head("POST", {{"host", "localhost"}, {"content-length", "18446744073709551615"}}), kLimits)
                .content_length,
            18446744073709551615U);
}

TEST(Guard, RefusesBodiesOfOldHttpAndLongTargets) {
  HeadView old = head("POST", {{"host", "localhost"}, {"content-length", "1"}});
  old.version = 10;
  EXPECT_EQ(refusal(old), "bad_request");
  HeadView reading = head("GET", {{"host", "localhost"}});
  reading.version = 10;
  EXPECT_EQ(refusal(reading), "");
  std::string target(kLimits.target_bytes + 1, 'a');
  target[0] = '/';
  target[1] = '/';
  HeadView long_target = head("GET", {{"host", "localhost"}});
  long_target.target = target;
  EXPECT_EQ(refusal(long_target), "target_too_long");
  long_target.target = std::string_view(target).substr(1);
  EXPECT_EQ(refusal(long_target), "");
}

TEST(Guard, LetsPagesOfOtherOriginsReadButChangeNothing) {
  for (const char* const origin :
       {"http://evil.example", "null", "", "localhost", "http://localhost.evil.example", "http://"}) {
    EXPECT_EQ(refusal(head("POST", {{"host", "localhost"}, {"origin", origin}})), "origin_not_allowed") << origin;
    EXPECT_EQ(refusal(head("DELETE", {{"host", "localhost"}, {"origin", origin}})), "origin_not_allowed") << origin;
    EXPECT_EQ(refusal(head("GET", {{"host", "localhost"}, {"origin", origin}})), "") << origin;
  }
  for (const char* const origin : {"http://localhost", "http://localhost:80", "HTTP://LocalHost"}) {
    EXPECT_EQ(refusal(head("POST", {{"host", "localhost"}, {"origin", origin}})), "") << origin;
  }
  EXPECT_EQ(refusal(head("POST", {{"host", "[::1]:8477"}, {"origin", "http://[::1]:8477"}})), "");
}

// Found in review: an origin was held to its host alone, so that whatever else served pages on this machine, on any
// port, could change what the daemon keeps.
TEST(Guard, ComparesTheWholeOrigin) {
  for (const char* const origin : {"http://localhost", "http://localhost:80", "http://localhost:9999",
                                   "https://localhost:8477", "http://127.0.0.1:8477", "http://localhost:8477.evil"}) {
    EXPECT_EQ(refusal(head("POST", {{"host", "localhost:8477"}, {"origin", origin}})), "origin_not_allowed") << origin;
  }
  EXPECT_EQ(refusal(head("POST", {{"host", "localhost:8477"}, {"origin", "http://localhost:8477"}})), "");
  GuardLimits secure = kLimits;
  secure.secure = true;
  const auto refused = [&](const char* origin) {
    return inspect(head("POST", {{"host", "localhost"}, {"origin", origin}}), secure).refusal.has_value();
  };
  EXPECT_FALSE(refused("https://localhost"));
  EXPECT_FALSE(refused("https://localhost:443"));
  EXPECT_TRUE(refused("http://localhost"));
}

TEST(Guard, BelievesWhatTheBrowserSaysOfTheSite) {
  const auto post = [](std::vector<std::pair<std::string, std::string>> more) {
    more.emplace_back("host", "localhost:8477");
    return refusal(head("POST", std::move(more)));
  };
  for (const char* const site : {"cross-site", "same-site", "", "Same-Origin"}) {
    EXPECT_EQ(post({{"sec-fetch-site", site}}), "origin_not_allowed") << site;
    EXPECT_EQ(post({{"sec-fetch-site", site}, {"origin", "http://localhost:8477"}}), "origin_not_allowed") << site;
    EXPECT_EQ(refusal(head("GET", {{"host", "localhost"}, {"sec-fetch-site", site}})), "") << site;
  }
  EXPECT_EQ(post({{"sec-fetch-site", "none"}}), "");
  EXPECT_EQ(post({{"sec-fetch-site", "same-origin"}}), "");
  // A proxy ends TLS: scheme and port of the page are the proxy's, its host is one that the daemon answers for.
  EXPECT_EQ(post({{"sec-fetch-site", "same-origin"}, {"origin", "https://localhost"}}), "");
  EXPECT_EQ(post({{"sec-fetch-site", "same-origin"}, {"origin", "https://evil.example"}}), "origin_not_allowed");
  EXPECT_EQ(post({{"sec-fetch-site", "same-origin"}, {"origin", "null"}}), "origin_not_allowed");
}

TEST(Guard, SeesWhereAHeaderEndsAndThatALineIsFolded) {
  const std::string whole = "GET / HTTP/1.1\r\nHost: a\r\nX: 1\r\n\r\n";
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::string_view part = std::string_view(whole).substr(0, length);
    EXPECT_FALSE(look_at_head(part).whole) << length;
    EXPECT_FALSE(look_at_head(part).folded) << length;
    EXPECT_TRUE(look_at_head(whole, length).whole) << "however much was looked at before: " << length;
  }
  for (const char* const fold : {" ", "\t"}) {
    const std::string folded = "GET / HTTP/1.1\r\nHost: a\r\n" + std::string(fold) + "b: 1\r\n\r\n";
    const std::size_t line_end = folded.find("\r\n" + std::string(fold)) + 2;
    for (std::size_t length = 0; length <= line_end; ++length) {
      EXPECT_FALSE(look_at_head(std::string_view(folded).substr(0, length)).folded) << length;
      EXPECT_TRUE(look_at_head(folded, length).folded) << length;
    }
  }
  EXPECT_FALSE(look_at_head(whole + " a body may begin with a space").folded);
  for (const char* const beyond_repair : {"GET / HTTP/1.1\n", "\x16\x03\x01", "GET / HTTP/1.1\r\n\rx"}) {
    EXPECT_TRUE(look_at_head(beyond_repair).whole) << "more bytes mend nothing: the parser is to say so at once";
  }
}

TEST(Guard, MeetsOneExpectationOnly) {
  EXPECT_EQ(refusal(head("POST", {{"host", "localhost"}, {"expect", "100-Continue"}})), "");
  EXPECT_EQ(refusal(head("POST", {{"host", "localhost"}, {"expect", "202-later"}})), "bad_request");
}

TEST(RequestId, IsShortAndPlain) {
  EXPECT_TRUE(is_request_id("a"));
  EXPECT_TRUE(is_request_id("Az09._-"));
  EXPECT_TRUE(is_request_id(std::string(64, 'x')));
  for (const std::string& text : {std::string(), std::string(65, 'x'), std::string("a b"), std::string("a\r\nb"),
                                  std::string("é"), std::string("a\0b", 3)}) {
    EXPECT_FALSE(is_request_id(text)) << text;
  }
}

}  // namespace
}  // namespace driftlab::server
