/// Devices of one model, held against each other from what is stored of their axes.
#include "core/analysis/compare_devices.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

/// An axis whose one static recording has white noise of `n` and no other coefficient.
SensorSources axis(const char* quantity, const char* name, double n, const char* unit = "deg/s") {
  const ReportedValue none{{}, {}, {}, "", "No flat region."};
  ReportedChannel channel;
  channel.unit = unit;
  channel.allan = {
      {"N", {n, n / 1.05, n * 1.05, "deg/sqrt(h)", ""}}, {"B", none}, {"K", none}, {"Q", none}, {"R", none}};
  return {quantity, name, {{"rec_" + std::to_string(n), "static", std::move(channel)}}};
}

DeviceSensors device(const char* name, double n) {
  return {name, {axis("angular_rate", "z", n), axis("specific_force", "x", 10.0 * n, "m/s^2")}};
}

TEST(CompareDevices, HoldsEachSensorAxisAgainstThatOfTheOtherDevices) {
  const PopulationReport report = compare_devices("line", {device("a", 0.30), device("b", 0.31), device("c", 0.33)});
  EXPECT_EQ(report.devices, (std::vector<std::string>{"a", "b", "c"}));
  ASSERT_EQ(report.rows.size(), 2);
  EXPECT_EQ(report.rows[0].quantity, Quantity::AngularRate);
  EXPECT_EQ(report.rows[0].axis, "z");
  EXPECT_EQ(report.rows[1].quantity, Quantity::SpecificForce);
  EXPECT_EQ(report.rows[0].population.places.size(), 3);
}

TEST(CompareDevices, TakesTheSensorThatIsWantedAlone) {
  const PopulationReport report =
      compare_devices("line", {device("a", 0.30), device("b", 0.31)}, Quantity::SpecificForce);
  ASSERT_EQ(report.rows.size(), 1);
  EXPECT_EQ(report.rows[0].quantity, Quantity::SpecificForce);
}

TEST(CompareDevices, LeavesOutAxesWithoutResultsAndChannelsThatNobodyNamed) {
  const DeviceSensors empty{"empty", {{"angular_rate", "z", {}}}};
  const DeviceSensors unnamed{"unnamed", {axis("unspecified", "adc3", 0.3, "1")}};
  const PopulationReport report = compare_devices("line", {empty, unnamed, device("a", 0.30)});
  EXPECT_EQ(report.devices, std::vector<std::string>{"a"});
}

TEST(CompareDevices, UnitsThatDoNotConvertKeepAnAxisOut) {
  DeviceSensors mixed = device("mixed", 0.30);
  SensorSources counts = axis("angular_rate", "z", 0.31, "1");
  mixed.sensors.front().sources.push_back(counts.sources.front());
  const PopulationReport report = compare_devices("line", {mixed, device("a", 0.30)}, Quantity::AngularRate);
  EXPECT_EQ(report.devices, std::vector<std::string>{"a"});
}

}  // namespace
}  // namespace driftlab
