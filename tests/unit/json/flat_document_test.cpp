#include "schema/json/flat_document.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

TEST(FlatDocument, HasARowForEachValue) {
  const Json document =
      parse_json(
          R"({"a": {"tau_s": [0.1, null, 2]}, "list": [{"b": true}, {"b": "x, \"y\""}], "n": null, "t": 1e-300})")
          .value();
  EXPECT_EQ(flat_csv(document),
            "path,index,number,text\n"
            "a.tau_s,1,0.1,\n"
            "a.tau_s,2,,\n"
            "a.tau_s,3,2,\n"
            "list.0.b,,,true\n"
            "list.1.b,,,\"x, \"\"y\"\"\"\n"
            "n,,,\n"
            "t,,1e-300,\n");
}

TEST(FlatDocument, OfOneValueOrOfNoneIsATableToo) {
  EXPECT_EQ(flat_csv(Json(3)), "path,index,number,text\n,,3,\n");
  EXPECT_EQ(flat_csv(Json::object()), "path,index,number,text\n");
  EXPECT_EQ(flat_csv(Json::array({1, 2})), "path,index,number,text\n,1,1,\n,2,2,\n");
}

}  // namespace
}  // namespace driftlab
