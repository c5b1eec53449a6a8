#include "core/campaign/population_report.hpp"

#include "core/campaign/population_verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace driftlab {
namespace {

ReportedValue value(double v, const char* unit = "deg/sqrt(h)") { return {v, v / 1.05, v * 1.05, unit, ""}; }

ReportedValue none() { return {{}, {}, {}, "", "No B."}; }

ParameterTable table(const std::string& device, const char* axis, double n, const ReportedValue& b) {
  TableRow row;
  row.label = "static";
  row.recordings = {"rec"};
  row.density = {value(n), {}};
  row.cells = {{value(n), {}}, {b, {}}, {none(), {}}};
  ParameterTable made;
  made.device = device;
  made.axis = axis;
  made.method = TableMethod::Av;
  made.columns = {{"N", "deg/sqrt(h)"}, {"B", "deg/h"}, {"K", ""}};
  made.rows = {row};
  return made;
}

TEST(PopulationReport, HasARowForEachParameterThatADeviceIdentifies) {
  const PopulationReport report =
      describe_populations("line", {table("a", "z", 0.30, value(9, "deg/h")), table("b", "z", 0.31, none()),
                                    table("c", "z", 0.33, none()), table("a", "x", 0.40, none())});
  EXPECT_EQ(report.devices, (std::vector<std::string>{"a", "b", "c"}));
  ASSERT_EQ(report.rows.size(), 3U);
  EXPECT_EQ(report.rows[0].axis, "x");
  EXPECT_NE(report.rows[0].reason.find("there is one"), std::string::npos) << report.rows[0].reason;
  EXPECT_EQ(report.rows[1].parameter, "N");
  EXPECT_NEAR(report.rows[1].population.mean.value.value(), std::cbrt(0.30 * 0.31 * 0.33), 1e-6);
  EXPECT_EQ(report.rows[2].parameter, "B");
  EXPECT_EQ(report.rows[2].population.left_out.size(), 2U);
}

TEST(PopulationVerdict, NamesTheDeviceThatIsNotOfTheLineAndByWhat) {
  std::vector<ParameterTable> tables;
  for (const auto& [device, n] : {std::pair{"a", 0.300}, {"b", 0.305}, {"c", 0.296}, {"d", 0.302}, {"e", 0.9}}) {
    tables.push_back(table(device, "z", n, none()));
  }
  const PopulationReport report = describe_populations("line", tables);
  const Verdict verdict = verdict_of(report);
  EXPECT_EQ(verdict.sentence, "One of 5 devices is not of the line: e.");
  EXPECT_EQ(verdict.level, VerdictLevel::Look);
  EXPECT_EQ(verdict.details.front(), "e by N of gyroscope z, static.");
  EXPECT_EQ(standing_out(report, "e"), "e is not of the line of the 5 devices of line, by N of gyroscope z, static.");
  EXPECT_EQ(standing_out(report, "a"), std::nullopt);
  ASSERT_EQ(verdict.facts.size(), 1U);
  EXPECT_EQ(verdict.facts[0].first, "/rows/0/places/4/p_holm");
  EXPECT_EQ(verdict.facts[0].second, report.rows[0].population.places[4].p_holm.value());
}

TEST(PopulationVerdict, SaysThatNobodyStandsOutOrThatFewCannot) {
  const auto line = [](std::size_t devices) {
    std::vector<ParameterTable> tables;
    for (std::size_t i = 0; i < devices; ++i) {
      tables.push_back(table("d" + std::to_string(i), "z", 0.3 + 0.002 * static_cast<double>(i), none()));
    }
    return verdict_of(describe_populations("line", tables));
  };
  EXPECT_EQ(line(5).sentence, "No device of 5 stands out.");
  EXPECT_EQ(line(5).level, VerdictLevel::Fine);
  EXPECT_EQ(line(3).details.front(), "Flags need four devices with results.");
  EXPECT_EQ(line(5).details.back().find("N of gyroscope z, static: 0.30"), 0U) << line(5).details.back();
  EXPECT_EQ(line(0).level, VerdictLevel::Look);
}

TEST(PopulationReport, KnowsTheDevicesOfAModel) {
  EXPECT_TRUE(is_of_model("Probe 7", std::vector<std::string>{"probe 7", ""}));
  EXPECT_TRUE(is_of_model("MPU6050", std::vector<std::string>{"", "InvenSense MPU-6050"}));
  EXPECT_FALSE(is_of_model("MPU-6050", std::vector<std::string>{"board", "MPU-6500"}));
  EXPECT_FALSE(is_of_model("probe", std::vector<std::string>{"", ""}));
}

}  // namespace
}  // namespace driftlab
