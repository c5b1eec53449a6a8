#include "schema/json/unnamed_effect.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

namespace driftlab {
namespace {

using investigate::Against;
using investigate::UnnamedKind;

constexpr double kDegree = std::numbers::pi / 180.0;

struct Read {
  investigate::Baseline model;
  std::string fault;  ///< the sentence of the first; empty: none
};

Read read(const char* text) {
  Read result;
  Faults faults;
  read_unnamed_effect(*parse_json(text), "/unnamed/0", result.model, faults);
  if (!faults.none()) {
    const Error error = faults.error();
    result.fault = error.message;
    for (const ErrorField& field : error.fields) {
      result.fault += " " + field.name + " " + field.value;
    }
  }
  return result;
}

TEST(UnnamedEffect, IsReadInSiAndWrittenAsItWasRead) {
  const Read mean = read(R"json({"kind": "mean", "against": "temperature", "along": "degC", "channel": "gz",
                                 "recordings": ["a"], "edges": [20, 30, 45], "values": [0.1, -0.2], "unit": "deg/s"})json");
  ASSERT_EQ(mean.fault, "");
  const investigate::UnnamedEffect& effect = mean.model.unnamed.at(0);
  EXPECT_EQ(effect.kind, UnnamedKind::Mean);
  EXPECT_EQ(effect.against, Against::Temperature);
  EXPECT_EQ(effect.recordings, std::vector<std::string>{"a"});
  EXPECT_NEAR(effect.edge[0], 293.15, 1e-9);
  EXPECT_NEAR(effect.value[1], -0.2 * kDegree, 1e-12);
  const Json written = to_json(effect, *parse_unit("deg/s"));
  EXPECT_EQ(written.at("along"), "degC");
  EXPECT_EQ(written.at("unit"), "deg/s");
  EXPECT_NEAR(written.at("edges").at(2).get<double>(), 45.0, 1e-9);
  EXPECT_NEAR(written.at("values").at(0).get<double>(), 0.1, 1e-12);
  const Read density = read(
      R"json({"kind": "spectrum", "against": "frequency", "channel": "gz", "edges": [1, 10], "values": [0.5]})json");
  ASSERT_EQ(density.fault, "");
  EXPECT_TRUE(density.model.unnamed.at(0).recordings.empty());
  EXPECT_FALSE(to_json(density.model.unnamed.at(0), *parse_unit("deg/s")).contains("unit"));
}

TEST(UnnamedEffect, OfAPhaseHasItsPeriod) {
  const Read pulses = read(R"json({"kind": "mean", "against": "phase", "period_s": 7.25, "channel": "gz",
                                   "recordings": ["a"], "edges": [0, 0.5, 7.25], "values": [1, 0], "unit": "deg/s"})json");
  ASSERT_EQ(pulses.fault, "");
  const investigate::UnnamedEffect& effect = pulses.model.unnamed.at(0);
  EXPECT_EQ(effect.against, Against::Phase);
  EXPECT_EQ(effect.period_s, 7.25);
  const Json written = to_json(effect, *parse_unit("deg/s"));
  EXPECT_EQ(written.at("against"), "phase");
  EXPECT_EQ(written.at("period_s"), 7.25);
  EXPECT_EQ(written.at("along"), "s");
}

TEST(UnnamedEffect, IsRefusedWhereItCannotBeOne) {
  const auto refused = [](const char* text, const char* part) {
    const Read result = read(text);
    EXPECT_NE(result.fault.find(part), std::string::npos) << text << "\n" << result.fault;
    EXPECT_TRUE(result.model.unnamed.empty()) << text;
  };
  refused(R"json({"kind": "spectrum", "against": "rate", "channel": "g", "edges": [1, 2], "values": [1]})json",
          "against frequency");
  refused(
      R"json({"kind": "mean", "against": "moon", "channel": "g", "edges": [1, 2], "values": [1], "unit": "deg/s"})json",
      "against time");
  refused(
      R"json({"kind": "mean", "against": "rate", "channel": "g", "edges": [1, 2], "values": [1], "unit": "furlong"})json",
      "/unit");
  refused(R"json({"kind": "variance", "against": "rate", "channel": "g", "edges": [1, 1], "values": [1]})json",
          "rising order");
  refused(R"json({"kind": "variance", "against": "rate", "channel": "g", "edges": [1, 2, 3], "values": [1]})json",
          "one edge more");
  refused(R"json({"kind": "variance", "against": "rate", "channel": "g", "edges": [1, 2], "values": [-1]})json",
          "not negative");
  refused(R"json({"kind": "variance", "against": "rate", "channel": "g", "edges": [1, "2"], "values": [1]})json",
          "list of numbers");
  refused(R"json({"kind": "variance", "against": "phase", "channel": "g", "edges": [1, 2], "values": [1]})json",
          "/period_s");
  refused(
      R"json({"kind": "variance", "against": "phase", "period_s": 0, "channel": "g", "edges": [1, 2], "values": [1]})json",
      "/period_s");
}

}  // namespace
}  // namespace driftlab
