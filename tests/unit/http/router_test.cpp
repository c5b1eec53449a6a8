#include "server/http/router.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace driftlab::server {
namespace {

Router sample() {
  Router router;
  const Handler handler = [](const Request&) -> Result<Response> { return Response{}; };
  router.add({"GET", "/v1/jobs", "list", {"limit"}, handler});
  router.add({"POST", "/v1/jobs", "create", {}, handler});
  router.add({"GET", "/v1/jobs/{id}", "get", {}, handler});
  router.add({"POST", "/v1/jobs/{id}/cancel", "cancel", {}, handler});
  router.add({"GET", "/healthz", "alive", {}, handler});
  router.add({"GET", "/schemas/{file}", "schema", {}, handler});
  return router;
}

TEST(Router, BindsSegments) {
  const Router router = sample();
  const auto match = router.match("POST", "/v1/jobs/job_1/cancel");
  ASSERT_NE(match.route, nullptr);
  EXPECT_EQ(match.route->operation_id, "cancel");
  EXPECT_EQ(match.parameters, std::vector<std::string>{"job_1"});
}

TEST(Router, TellsAMissingPathFromAMissingMethod) {
  const Router router = sample();
  EXPECT_EQ(router.match("GET", "/healthz").route->operation_id, "alive");
  EXPECT_EQ(router.match("GET", "/schemas/jobs").route->operation_id, "schema");
  EXPECT_TRUE(router.match("GET", "/v1").allowed.empty());
  EXPECT_TRUE(router.match("GET", "/v1/job").allowed.empty());
  EXPECT_TRUE(router.match("GET", "/v1/jobs/").allowed.empty());
  EXPECT_TRUE(router.match("GET", "/v1/jobs/a/b/c").allowed.empty());
  const auto match = router.match("DELETE", "/v1/jobs");
  EXPECT_EQ(match.route, nullptr);
  EXPECT_EQ(match.allowed, (std::vector<std::string_view>{"GET", "POST"}));
}

TEST(Router, ServesHeadByGet) {
  const Router router = sample();
  EXPECT_EQ(router.match("HEAD", "/v1/jobs").route, router.match("GET", "/v1/jobs").route);
  EXPECT_EQ(router.match("HEAD", "/v1/jobs/x/cancel").route, nullptr);
}

TEST(Router, RefusesUnknownAndRepeatedParameters) {
  const Router router = sample();
  const Route& route = router.routes()[0];
  Request request;
  EXPECT_FALSE(refuse_unknown_query(route, request));
  request.query = {{"limit", "1"}};
  EXPECT_FALSE(refuse_unknown_query(route, request));
  request.query = {{"limit", "1"}, {"limit", "1"}};
  EXPECT_TRUE(refuse_unknown_query(route, request));
  request.query = {{"page", "1"}};
  const auto refusal = refuse_unknown_query(route, request);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->status, 400);
  EXPECT_NE(refusal->body.find("known are limit"), std::string::npos);
}

}  // namespace
}  // namespace driftlab::server
