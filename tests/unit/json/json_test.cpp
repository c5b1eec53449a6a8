#include "schema/json/json.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace driftlab {
namespace {

TEST(ParseJson, ReadsWhatEveryoneAgreesOn) {
  const auto document = parse_json(R"( {"b": [1, -2.5, true, null, "é\u00e9\n"], "a": {}} )");
  ASSERT_TRUE(document);
  EXPECT_EQ((*document)["b"][1], -2.5);
  EXPECT_EQ((*document)["b"][4], "éé\n");
  EXPECT_EQ(document->begin().key(), "b") << "members keep their order";
}

TEST(ParseJson, RefusesWhatParsersDisagreeAbout) {
  const char* const documents[] = {"",
                                   " ",
                                   "{",
                                   "[1,]",
                                   "{\"a\":1,}",
                                   "{'a':1}",
                                   "{a:1}",
                                   "1 2",
                                   "{} x",
                                   "nan",
                                   "NaN",
                                   "Infinity",
                                   "01",
                                   "+1",
                                   ".5",
                                   "1.",
                                   "// c\n1",
                                   "[1] // c",
                                   "\"\xff\"",
                                   "\"\xc0\x80\"",
                                   "\"a\nb\"",
                                   "\"\\x41\"",
                                   "\"\\ud800\"",
                                   "1e400",
                                   "-1e400",
                                   "tru",
                                   "\"open",
                                   "{\"a\":1,\"a\":2}",
                                   "{\"x\":{\"a\":1,\"b\":2,\"a\":1}}"};
  for (const char* const text : documents) {
    const auto document = parse_json(text);
    ASSERT_FALSE(document) << text;
    EXPECT_EQ(document.error().code, ErrorCode::ParseError) << text;
    EXPECT_TRUE(document.error().message.ends_with('.')) << document.error().message;
  }
  EXPECT_FALSE(parse_json(std::string_view("{}\0", 3)));
  EXPECT_FALSE(parse_json(std::string_view("{}\0{\"hidden\": 1}", 16)));
}

TEST(ParseJson, SaysAtWhichByte) {
  const auto document = parse_json("[1, x]");
  ASSERT_FALSE(document);
  ASSERT_EQ(document.error().fields.size(), 1U);
  EXPECT_EQ(document.error().fields[0], (ErrorField{"byte", "5"}));
}

std::string nested(int depth, char open, char close) { return std::string(depth, open) + std::string(depth, close); }

TEST(ParseJson, StopsAtDepth64) {
  EXPECT_TRUE(parse_json(nested(kMaxJsonDepth, '[', ']')));
  EXPECT_FALSE(parse_json(nested(kMaxJsonDepth + 1, '[', ']')));
  EXPECT_FALSE(parse_json(nested(100'000, '[', ']')));
  EXPECT_FALSE(parse_json(std::string(100'000, '[')));
  std::string objects;
  for (int i = 0; i <= kMaxJsonDepth; ++i) {
    objects += "{\"a\":";
  }
  EXPECT_FALSE(parse_json(objects + "1" + std::string(kMaxJsonDepth + 1, '}')));
  std::string wide = "[0";
  for (int i = 0; i < 1000; ++i) {
    wide += ",[[]]";  // depth falls again: many siblings are not deep
  }
  EXPECT_TRUE(parse_json(wide + "]"));
}

TEST(CanonicalText, IsTheSameForEqualDocuments) {
  const auto one = parse_json(R"({"b": [1, {"y": 2, "x": 3}], "a": 0.1})");
  const auto two = parse_json(R"({"a": 0.10, "b": [1, {"x": 3, "y": 2}]})");
  ASSERT_TRUE(one && two);
  EXPECT_EQ(canonical_text(*one), R"({"a":0.1,"b":[1,{"x":3,"y":2}]})");
  EXPECT_EQ(canonical_text(*one), canonical_text(*two));
  EXPECT_NE(canonical_text(*one), canonical_text(*parse_json(R"({"a": 0.1, "b": [{"x": 3, "y": 2}, 1]})")));
}

TEST(Writing, NeverEmitsWhatIsNoNumber) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(number(std::nan("")).is_null());
  EXPECT_TRUE(number(-infinity).is_null());
  EXPECT_EQ(to_text(interval({-infinity, 2.0}, 3.0)), "[null,6.0]");
  EXPECT_EQ(to_text(quantity({2.0, {1.0, infinity}}, 10.0, "deg/h")),
            R"({"value":20.0,"unit":"deg/h","ci95":[10.0,null]})");
  EXPECT_EQ(to_text(Json("\xff")), "\"\xEF\xBF\xBD\"");
}

TEST(Writing, GivesDoublesBackBitForBit) {
  for (const double value :
       {0.1, 1.0 / 3.0, 5e-324, 1.7976931348623157e308, -2.2250738585072014e-308, 123456789012345680.0}) {
    const auto back = parse_json(to_text(number(value)));
    ASSERT_TRUE(back);
    EXPECT_EQ(back->get<double>(), value);
  }
}

/// What somebody wrote comes back, in units that no power of two leads to; and any value is written as one that is
/// written the same again.
TEST(NumberIn, GivesBackWhatWasWritten) {
  std::mt19937_64 random(20261129);
  std::uniform_int_distribution<int> digits(1, 999'999);
  std::uniform_real_distribution<double> magnitude(-30.0, 30.0);
  for (const double unit : {std::numbers::pi / 180.0, std::numbers::pi / 180.0 / 60.0, 9.80665e-3, 1e-3, 1e-6, 1.0}) {
    for (int k = 0; k < 20'000; ++k) {
      const double written = digits(random) / 1e4;
      EXPECT_EQ(number_in(written * unit, unit), written) << "times " << unit;
      const double si = std::pow(10.0, magnitude(random));
      const double once = number_in(si, unit).get<double>();
      EXPECT_EQ(number_in(once * unit, unit), once) << si << " in " << unit;
      EXPECT_NEAR(once * unit / si, 1.0, 4e-16);
    }
  }
}

TEST(NumberIn, HoldsAtTheEndsOfADouble) {
  EXPECT_EQ(number_in(0.0, 1e-3), 0.0);
  EXPECT_EQ(number_in(-2e-3, 1e-3), -2.0);
  EXPECT_TRUE(number_in(1e308, 1e-3).is_null()) << "too large for its unit";
  EXPECT_TRUE(number_in(std::numeric_limits<double>::quiet_NaN(), 1.0).is_null());
  const double tiny = number_in(5e-324, 1e-3).get<double>();
  EXPECT_EQ(number_in(tiny * 1e-3, 1e-3), tiny);
}

TEST(ObjectReader, ReportsEveryFaultAtItsPlace) {
  const auto document =
      parse_json(R"({"text": 1, "real": "x", "integer": 1.5, "big": 18446744073709551615, "a/b~c": 0, "good": "g"})");
  ASSERT_TRUE(document);
  Faults faults;
  ObjectReader reader(*document, "/at", faults);
  EXPECT_FALSE(reader.text("text"));
  EXPECT_FALSE(reader.real("real"));
  EXPECT_FALSE(reader.integer("integer"));
  EXPECT_FALSE(reader.integer("big"));
  EXPECT_EQ(reader.required_text("good"), "g");
  EXPECT_EQ(reader.required_text("missing"), "");
  EXPECT_FALSE(reader.text("absent"));
  reader.reject_unknown();
  const Error error = faults.error();
  std::vector<std::string> pointers;
  pointers.reserve(error.fields.size());
  for (const ErrorField& field : error.fields) {
    pointers.push_back(field.name);
  }
  EXPECT_EQ(pointers,
            (std::vector<std::string>{"/at/text", "/at/real", "/at/integer", "/at/big", "/at/missing", "/at/a~1b~0c"}));
  EXPECT_NE(error.message.find("6 faults"), std::string::npos);
}

TEST(ObjectReader, TakesWhatIsNoObjectAsOneFault) {
  const Json document = Json::array();
  Faults faults;
  ObjectReader reader(document, "", faults);
  EXPECT_EQ(reader.required_text("name"), "");
  EXPECT_EQ(reader.member("x"), nullptr);
  reader.reject_unknown();
  EXPECT_EQ(faults.error().fields.size(), 1U);
}

TEST(Within, BringsAWholeNumberBetweenItsEnds) {
  EXPECT_EQ(within(5, 0, 9), 5);
  EXPECT_EQ(within(-5, 0, 9), 0);
  EXPECT_EQ(within(std::numeric_limits<std::int64_t>::max(), 0, 9), 9);
}

}  // namespace
}  // namespace driftlab
