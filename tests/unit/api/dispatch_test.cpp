#include "tests/unit/api/world.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <future>

namespace driftlab::server {
namespace {

using Json = nlohmann::json;

std::string header_of(const Response& response, std::string_view name) {
  for (const auto& [key, value] : response.headers) {
    if (key == name) {
      return value;
    }
  }
  return "";
}

TEST(Dispatcher, RefusesTheSecondOfTwoRequestsWithOneKeyWhileTheFirstRuns) {
  World world;
  std::promise<void> entered;
  std::promise<void> leave;
  const Route slow{"POST", "/slow", "slow", {}, Handler([&](const Request&) -> Result<Response> {
                     entered.set_value();
                     leave.get_future().wait();
                     return Response{};
                   })};
  Request request;
  request.method = "POST";
  request.target = "/slow";
  request.headers = {{"idempotency-key", "k"}};
  auto first = std::async(std::launch::async, [&] { return world.dispatcher->run(slow, request); });
  entered.get_future().wait();
  const Response second = world.dispatcher->run(slow, request);
  EXPECT_EQ(second.status, 409);
  EXPECT_EQ(Json::parse(second.body)["code"], "idempotency_in_flight");
  leave.set_value();
  EXPECT_EQ(first.get().status, 200);
  const Response replayed = world.dispatcher->run(slow, request);  // the handler would throw: its promise is used up
  EXPECT_EQ(replayed.status, 200);
  EXPECT_EQ(header_of(replayed, "Idempotency-Replayed"), "true");
}

TEST(Dispatcher, TurnsWhatAHandlerThrowsIntoAProblem) {
  World world;
  Request request;
  request.method = "GET";
  const Route memory{"GET", "/m", "m", {}, Handler([](const Request&) -> Result<Response> { throw std::bad_alloc(); })};
  EXPECT_EQ(world.dispatcher->run(memory, request).status, 503);
  const Route other{
      "GET", "/o", "o", {}, Handler([](const Request&) -> Result<Response> { throw std::runtime_error("x"); })};
  const Response internal = world.dispatcher->run(other, request);
  EXPECT_EQ(internal.status, 500);
  EXPECT_EQ(Json::parse(internal.body)["code"], "internal");
}

TEST(Dispatcher, TakesJsonBodiesOnly) {
  World world;
  const std::string body = R"({"name":"phone-07"})";
  for (const char* const type : {"text/plain", "application/x-www-form-urlencoded", "application/jsonx", "json"}) {
    EXPECT_EQ(world.ask("POST", "/v1/devices", body, {{"content-type", type}}).status, 415) << type;
  }
  for (const char* const type :
       {"application/json", "Application/JSON; charset=utf-8", "application/merge-patch+json"}) {
    EXPECT_LT(world.ask("POST", "/v1/devices", body, {{"content-type", type}}).status, 300) << type;
  }
  EXPECT_EQ(world.ask("POST", "/v1/devices", body).status, 200);
}

TEST(Liveness, IsAnsweredWithoutThePool) {
  World world;
  EXPECT_EQ(world.router.match("GET", "/healthz").route->lane, Lane::Instant);
  EXPECT_EQ(world.router.match("GET", "/readyz").route->lane, Lane::Prompt) << "it looks at the store";
}

TEST(Readiness, SaysWhyNot) {
  World world;
  EXPECT_EQ(world.ask("GET", "/readyz").status, 200);
  world.not_ready = "The disk is nearly full.";
  const Response response = world.ask("GET", "/readyz");
  EXPECT_EQ(response.status, 503);
  const Json document = Json::parse(response.body);
  EXPECT_EQ(document["code"], "not_ready");
  EXPECT_EQ(document["detail"], world.not_ready);
  EXPECT_EQ(document["request_id"], "req_test");
  EXPECT_EQ(document["instance"], "/readyz");
}

TEST(Jobs, WakeTheWorkersOnceWhenNew) {
  World world;
  auto device = world.store->ensure_device([] {
    Device made;
    made.name = "phone-07";
    return made;
  }());
  ASSERT_TRUE(device);
  Blob blob;
  blob.sha256 = std::string(64, 'a');
  blob.format = "csv";
  blob.compression = "none";
  Recording recording;
  recording.device_id = device->device.id;
  recording.blob_sha256 = blob.sha256;
  recording.metadata_json = R"({"condition":{"kind":"static"}})";
  recording.condition = "static";
  const auto stored = world.store->add_recording(blob, recording);
  ASSERT_TRUE(stored) << stored.error().message;
  const std::string body = R"({"kind":"characterise","inputs":{"recordings":[")" + stored->recording.id + R"("]}})";
  const Response first = world.ask("POST", "/v1/jobs", body);
  EXPECT_EQ(first.status, 202) << first.body;
  EXPECT_EQ(world.wake_ups, 1);
  EXPECT_EQ(world.ask("POST", "/v1/jobs", body).status, 200);
  EXPECT_EQ(world.wake_ups, 1);
  EXPECT_EQ(header_of(first, "Location"), "/v1/jobs/" + Json::parse(first.body)["id"].get<std::string>());
  EXPECT_FALSE(first.pending_job.empty());
}

}  // namespace
}  // namespace driftlab::server
