#include "core/campaign/sheet_comparison.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace driftlab {
namespace {

KnownSensor adis16405() {
  const std::array<std::string, 1> texts{"ADIS16405"};
  return known_sensor(texts, Quantity::AngularRate).value();
}

ReportedValue n(double value, std::optional<double> low, std::optional<double> high) {
  return {value, low, high, "deg/sqrt(h)", ""};
}

TEST(SheetComparison, ComparesInTheUnitsOfTheTable) {
  const ReportedValue b{40.0, 30.0, 50.0, "deg/h", ""};
  const auto found = compare_with_sheet(adis16405(), "z", "static", n(2.1, 2.0, 2.2), &b);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->sensor, "ADIS16405");
  EXPECT_EQ(found->source, "Analog Devices ADIS16400/ADIS16405 Data Sheet, revision B, table 1, specifications");
  ASSERT_EQ(found->figures.size(), 2U);
  EXPECT_NEAR(found->figures[0].stated, 2.0, 1e-12);
  EXPECT_NEAR(found->figures[0].ratio.value(), 1.05, 1e-12);
  // 25.2 deg/h is the least Allan deviation, sqrt(2 ln 2 / pi) B.
  EXPECT_NEAR(found->figures[1].stated, 25.2 / std::sqrt(2.0 * std::log(2.0) / 3.14159265358979), 1e-9);
  EXPECT_EQ(sentence_of(found->figures[0]), "N is 1.05 times the 2.00 deg/sqrt(h) of its data sheet");
}

TEST(SheetComparison, LetsTheIntervalDecide) {
  const auto verdict = [](const ReportedValue& value) {
    return compare_with_sheet(adis16405(), "z", "static", value, nullptr)->figures[0].verdict;
  };
  EXPECT_EQ(verdict(n(2.9, 2.8, 3.0)), SheetVerdict::Agrees);
  EXPECT_EQ(verdict(n(3.3, 3.1, 3.5)), SheetVerdict::Above);
  EXPECT_EQ(verdict(n(3.3, 2.9, 3.7)), SheetVerdict::Agrees);
  EXPECT_EQ(verdict(n(3.3, {}, 3.7)), SheetVerdict::Agrees);
  EXPECT_EQ(verdict(n(1.0, 0.9, 1.1)), SheetVerdict::Below);
  EXPECT_EQ(verdict(n(1.0, 0.9, {})), SheetVerdict::Agrees);
  EXPECT_FALSE(verdict(ReportedValue{{}, {}, {}, "", "No N."}));
}

TEST(SheetComparison, LeavesOutWhatHasAnotherUnitOrIsNotStated) {
  EXPECT_FALSE(compare_with_sheet(adis16405(), "z", "static", {1.0, 0.9, 1.1, "1*sqrt(s)", ""}, nullptr));
  const std::array<std::string, 1> texts{"LSM9DS0"};
  EXPECT_FALSE(
      compare_with_sheet(known_sensor(texts, Quantity::AngularRate).value(), "z", "static", n(1.0, 0.9, 1.1), nullptr));
}

}  // namespace
}  // namespace driftlab
