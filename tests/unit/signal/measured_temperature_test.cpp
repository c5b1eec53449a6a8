#include "core/signal/measured_temperature.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace driftlab {
namespace {

using Table = std::vector<std::vector<double>>;

std::optional<MeasuredTemperature> of(const Table& table, const RecordingSpec& spec) {
  const ColumnNames names{"time", "gz", "temp"};
  const auto column = [&](std::size_t i) -> std::span<const double> { return table[i]; };
  const auto view = view_recording(spec, names, table[0].size(), column);
  EXPECT_TRUE(view) << view.error().message;
  return view ? measured_temperature(spec, names, *view, column) : std::nullopt;
}

/// A recording of 4,000 rows at 100 Hz whose thermometer counts 340 to the degree from 36.53 degC at 0.
struct Warming {
  Table table = Table(3);
  RecordingSpec spec;

  explicit Warming(const char* unit = "degC/340+36.53") {
    std::mt19937_64 draw(3);
    std::normal_distribution<double> noise;
    for (int i = 0; i < 4000; ++i) {
      table[0].push_back(0.01 * i);
      table[1].push_back(noise(draw));
      table[2].push_back(340.0 * (20.0 + 0.001 * i - 36.53));  // 20 to 24 degC
    }
    spec.columns["time"] = {Quantity::Time, "", *parse_unit("s")};
    spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
    spec.columns["temp"] = {Quantity::Temperature, "", std::nullopt};
    if (*unit != '\0') {
      spec.columns["temp"].unit = *parse_unit(unit);
    }
  }
};

TEST(MeasuredTemperature, IsTheMedianOfTheAnalysedRowsInDegrees) {
  Warming warming;
  auto found = of(warming.table, warming.spec);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->column, "temp");
  EXPECT_NEAR(found->median_degc, 22.0, 0.002);  // a row is 0.001 K
  EXPECT_NEAR(found->low_degc, 20.2, 0.002);
  EXPECT_NEAR(found->high_degc, 23.8, 0.002);
  warming.spec.trim.start_s = 20.0;
  found = of(warming.table, warming.spec);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->median_degc, 23.0, 0.002) << "what is trimmed was not analysed";
}

TEST(MeasuredTemperature, IsNotMovedByCellsThatMeanMissing) {
  Warming warming;
  for (std::size_t i = 0; i < 4000; i += 100) {
    warming.table[2][i] = i % 200 == 0 ? -999999.0 : std::numeric_limits<double>::quiet_NaN();
  }
  const auto found = of(warming.table, warming.spec);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->median_degc, 22.0, 0.02);  // half a per cent of the rows lies below
}

TEST(MeasuredTemperature, IsNotThereWithoutAColumnOrItsUnit) {
  const Warming counts("");
  EXPECT_FALSE(of(counts.table, counts.spec)) << "a count has no temperature";
  Warming none;
  none.spec.columns.erase("temp");
  EXPECT_FALSE(of(none.table, none.spec));
  Warming empty;
  empty.table[2].assign(4000, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(of(empty.table, empty.spec));
}

}  // namespace
}  // namespace driftlab
