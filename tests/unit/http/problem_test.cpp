#include "server/http/problem.hpp"

#include "server/store/silent_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace driftlab::server {
namespace {

using Json = nlohmann::json;

std::string slug_of(std::string code) {
  std::replace(code.begin(), code.end(), '_', '-');
  return code;
}

TEST(ProblemTable, HasAnEntryOfItsOwnForEveryErrorCodeAndEveryFault) {
  std::set<std::string_view> used;
  for (const ErrorCode code : all_error_codes()) {
    const ProblemType& type = problem_type(code);
    EXPECT_EQ(type.slug, slug_of(std::string(name_of(code))));
    EXPECT_TRUE(used.insert(type.slug).second) << type.slug;
  }
  for (const HttpFault fault : all_http_faults()) {
    const ProblemType& type = problem_type(fault);
    EXPECT_NE(type.slug, "internal");
    EXPECT_TRUE(used.insert(type.slug).second) << type.slug;
  }
  // And the other way round: nothing in the table that nobody can give.
  EXPECT_EQ(used.size(), problem_types().size());
  for (const ProblemType& type : problem_types()) {
    EXPECT_TRUE(used.contains(type.slug)) << type.slug;
  }
}

TEST(ProblemTable, KeepsToTheAgreedStatuses) {
  const std::set<int> agreed{400, 401, 403, 404, 405, 406, 409, 410, 411, 412, 413,
                             415, 416, 422, 428, 429, 431, 460, 500, 503, 507};  // 460: checksums of tus
  for (const ProblemType& type : problem_types()) {
    EXPECT_TRUE(agreed.contains(type.status)) << type.slug;
    EXPECT_GT(type.explanation.size(), 20U) << type.slug;
    EXPECT_EQ(find_problem_type(type.slug), &type);
    if (type.status >= 500) {
      EXPECT_TRUE(type.retryable) << type.slug;
    }
  }
  EXPECT_EQ(find_problem_type("nothing"), nullptr);
}

TEST(ProblemDocument, SeparatesPointersFromPlaces) {
  const Json document = Json::parse(
      problem_document(Error{ErrorCode::RaggedRow,
                             "Row 3 is ragged.",
                             {{"row", "3"}, {"column", "gz"}, {"/columns/gz", "Wrong."}, {"/", "All wrong."}}}));
  EXPECT_EQ(document["type"], "/problems/ragged-row");
  EXPECT_EQ(document["code"], "ragged_row");
  EXPECT_EQ(document["status"], 422);
  EXPECT_EQ(document["detail"], "Row 3 is ragged.");
  EXPECT_EQ(document["where"], (Json{{"row", 3}, {"column", "gz"}}));
  EXPECT_EQ(document["errors"],
            (Json::array({{{"pointer", "/columns/gz"}, {"code", "ragged_row"}, {"detail", "Wrong."}},
                          {{"pointer", ""}, {"code", "ragged_row"}, {"detail", "All wrong."}}})));
}

TEST(ProblemDocument, KeepsTheZerosOfACode) {
  const Json document = Json::parse(problem_document({ErrorCode::Io, "No.", {{"sqlstate", "08001"}, {"row", "17"}}}));
  EXPECT_EQ(document["where"]["sqlstate"], "08001");
  EXPECT_EQ(document["where"]["row"], 17);
}

TEST(ProblemDocument, SurvivesTextThatIsNoUtf8) {
  const std::string text =
      problem_document(Error{ErrorCode::NotANumber, "The field '\xff' is no number.", {{"field", "\xfe"}}});
  EXPECT_TRUE(Json::accept(text)) << text;
}

TEST(ProblemResponse, OfAStoreThatDoesNotAnswerIsNotReady) {
  const Response response = problem_response(silent_store("The database on /run/db does not answer."));
  EXPECT_EQ(response.status, 503);
  ASSERT_TRUE(response.failure);
  EXPECT_EQ(response.failure->message, "The database on /run/db does not answer.");
  EXPECT_THAT(response.headers, testing::Contains(std::pair<std::string, std::string>("Retry-After", "1")));
  EXPECT_THAT(response.body, testing::HasSubstr("[a file that the log names] does not answer"));
  EXPECT_EQ(problem_response(Error{ErrorCode::Io, "The disk failed.", {}}).status, 500);
}

TEST(ProblemResponse, SaysWhenToComeBack) {
  const Response busy = problem_response(HttpFault::Busy, "Later.");
  EXPECT_EQ(busy.status, 503);
  EXPECT_EQ(busy.content_type, "application/problem+json");
  EXPECT_TRUE(busy.has_header("Retry-After"));
  EXPECT_FALSE(problem_response(HttpFault::BadRequest, "No.").has_header("Retry-After"));
}

}  // namespace
}  // namespace driftlab::server
