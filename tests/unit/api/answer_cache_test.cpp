// Answers that are kept: given again while nothing has changed, never after, and never to somebody else.
#include "server/api/answer_cache.hpp"

#include "tests/unit/api/world.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace driftlab::server {
namespace {

using Json = nlohmann::json;

Response answer_of(std::size_t bytes) {
  Response response;
  response.body.assign(bytes, 'x');
  return response;
}

TEST(AnswerCache, GivesAnAnswerOnlyAtTheNumberOfChangesThatItWasKeptAt) {
  AnswerCache cache(1 << 20);
  cache.keep("a", 7, answer_of(10));
  ASSERT_NE(cache.find("a", 7), nullptr);
  EXPECT_EQ(cache.find("a", 7)->body.size(), 10U);
  EXPECT_EQ(cache.find("a", 8), nullptr);
  EXPECT_EQ(cache.find("a", 7), nullptr) << "what is stale is gone";
  EXPECT_EQ(cache.bytes(), 0U);
}

TEST(AnswerCache, AChangeFreesEverythingThatWasKeptBeforeIt) {
  // Under a mixed load the budget filled with answers of earlier states, which nobody could be given.
  AnswerCache cache(1 << 20);
  for (int i = 0; i < 50; ++i) {
    cache.keep("k" + std::to_string(i), 7, answer_of(1000));
  }
  cache.keep("other", 8, answer_of(10));
  EXPECT_LT(cache.bytes(), 1000U);
  EXPECT_NE(cache.find("other", 8), nullptr);
  cache.keep("slow", 7, answer_of(10));
  EXPECT_EQ(cache.find("slow", 8), nullptr) << "its rows were read before the change";
  EXPECT_NE(cache.find("other", 8), nullptr);
}

TEST(AnswerCache, StaysWithinItsBudgetAndForgetsTheLeastRecentlyUsedFirst) {
  constexpr std::size_t kBudget = 40'000;
  AnswerCache cache(kBudget);
  for (int i = 0; i < 100; ++i) {
    cache.keep("k" + std::to_string(i), 1, answer_of(4000));
    (void)cache.find("k0", 1);
    EXPECT_LE(cache.bytes(), kBudget);
  }
  EXPECT_NE(cache.find("k0", 1), nullptr) << "used all the time";
  EXPECT_NE(cache.find("k99", 1), nullptr);
  EXPECT_EQ(cache.find("k50", 1), nullptr);
  cache.keep("large", 1, answer_of(kBudget / 2));
  EXPECT_EQ(cache.find("large", 1), nullptr) << "one answer must not drive out all others";
}

/// A route that counts how often its handler ran.
struct Counted {
  int runs = 0;
  Route route = from_rows({"GET", "/counted", "counted", {}, Handler([this](const Request&) -> Result<Response> {
                             ++runs;
                             Response response;
                             response.body = "{\"text\":\"" + std::string(2000, 'a') + "\"}\n";
                             return response;
                           })});
};

Request reading(std::string target, std::vector<std::pair<std::string, std::string>> headers = {}) {
  Request request;
  request.method = "GET";
  request.target = std::move(target);
  request.headers = std::move(headers);
  return request;
}

TEST(Dispatcher, RunsAHandlerOfRowsOncePerChangeOfTheStore) {
  World world;
  Counted counted;
  EXPECT_FALSE(world.dispatcher->known(counted.route, reading("/counted")));
  const Response first = world.dispatcher->run(counted.route, reading("/counted"));
  const auto again = world.dispatcher->known(counted.route, reading("/counted"));
  ASSERT_TRUE(again);
  EXPECT_EQ(counted.runs, 1);
  EXPECT_EQ(again->body, first.body);
  EXPECT_EQ(again->headers, first.headers);
  ASSERT_EQ(world.ask("POST", "/v1/devices", R"({"name": "new"})").status, 201);
  EXPECT_FALSE(world.dispatcher->known(counted.route, reading("/counted")));
  (void)world.dispatcher->run(counted.route, reading("/counted"));
  EXPECT_EQ(counted.runs, 2);
}

TEST(Dispatcher, GivesTheSameBytesWithTheCacheOff) {
  World world;
  World without;
  without.context->budgets.answer_cache_bytes = 0;
  without.dispatcher = std::make_unique<Dispatcher>(*without.context);
  Counted one;
  Counted other;
  const std::string etag = [&] {
    const Response response = world.dispatcher->run(one.route, reading("/counted"));
    for (const auto& [name, value] : response.headers) {
      if (name == "ETag") {
        return value;
      }
    }
    return std::string();
  }();
  for (const auto& headers : std::vector<std::vector<std::pair<std::string, std::string>>>{
           {},
           {{"accept-encoding", "gzip"}},
           {{"if-none-match", etag}},
           {{"if-none-match", etag}, {"accept-encoding", "gzip"}},
           {{"if-none-match", "\"other\""}}}) {
    for (int repeat = 0; repeat < 2; ++repeat) {
      const Response kept = world.dispatcher->run(one.route, reading("/counted", headers));
      const Response made = without.dispatcher->run(other.route, reading("/counted", headers));
      EXPECT_EQ(kept.status, made.status);
      EXPECT_EQ(kept.body, made.body);
      EXPECT_EQ(kept.headers, made.headers);
    }
  }
  EXPECT_EQ(one.runs, 1);
  EXPECT_EQ(other.runs, 10);
}

TEST(Dispatcher, KeepsTheAnswersOfTwoTokensApart) {
  World world;
  Counted counted;
  Request request = reading("/counted");
  request.caller.principal.token = "tok_one";
  (void)world.dispatcher->run(counted.route, request);
  request.caller.principal.token = "tok_two";
  EXPECT_FALSE(world.dispatcher->known(counted.route, request));
}

TEST(Dispatcher, ShowsAChangeInTheVeryNextAnswer) {
  World world;
  const Json made = Json::parse(world.ask("POST", "/v1/devices", R"({"name": "unit-1"})").body);
  const std::string target = "/v1/devices/" + made["id"].get<std::string>();
  for (int i = 0; i < 20; ++i) {
    const Response before = world.ask("GET", target);
    std::string etag;
    for (const auto& [name, value] : before.headers) {
      etag = name == "ETag" ? value : etag;
    }
    const std::string model = "model-" + std::to_string(i);
    ASSERT_EQ(world.ask("PATCH", target, Json{{"model", model}}.dump(), {{"if-match", etag}}).status, 200);
    EXPECT_EQ(Json::parse(world.ask("GET", target).body)["model"], model);
    EXPECT_EQ(world.ask("GET", target, "", {{"if-none-match", etag}}).status, 200);
  }
}

}  // namespace
}  // namespace driftlab::server
