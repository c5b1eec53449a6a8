#include "core/calibrate/sensor_calibration.hpp"

#include "core/calibrate/aligned_reference.hpp"
#include "core/signal/missing.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;
constexpr std::size_t kRows = 3000;
constexpr double kTurn = 3.14159265358979323846;

using Table = std::vector<std::vector<double>>;

Unit unit(const char* symbol) { return *parse_unit(symbol); }

std::vector<double> noise(std::size_t count, double sigma, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  std::vector<double> values(count);
  for (double& value : values) {
    value = normal(random);
  }
  return values;
}

/// The table about z: 88 deg/s at most.
double table_rate(double t) { return 60.0 * std::sin(0.785 * t) + 28.0 * std::sin(2.1 * t + 0.4); }

RecordingView view_of(const Table& table, const std::map<std::string, ColumnRole>& columns, const ColumnNames& names) {
  RecordingSpec spec;
  spec.rate_hz = 1.0 / kDt;
  spec.columns = columns;
  spec.condition = *parse_condition("profile");
  auto view = view_recording(spec, names, table.front().size(),
                             [&](std::size_t i) { return std::span<const double>(table[i]); });
  EXPECT_TRUE(view) << view.error().message;
  return view ? std::move(*view) : RecordingView{};  // a copy would point into this one
}

std::map<std::string, ColumnRole> gyro_columns() {
  return {{"gx", {Quantity::AngularRate, "x", unit("deg/s")}},
          {"gy", {Quantity::AngularRate, "y", unit("deg/s")}},
          {"gz", {Quantity::AngularRate, "z", unit("deg/s")}},
          {"rz", {Quantity::ReferenceAngularRate, "z", unit("deg/s")}}};
}

/// A triad on the table that reads y = L x + b, without noise.
Table misread(const std::array<Triple, 3>& law, const Triple& bias_deg_s) {
  Table table(4, std::vector<double>(kRows));
  for (std::size_t i = 0; i < kRows; ++i) {
    const double rate = table_rate(kDt * static_cast<double>(i));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      table[axis][i] = law[axis][2] * rate + bias_deg_s[axis];
    }
    table[3][i] = rate;
  }
  return table;
}

constexpr std::array<Triple, 3> kLaw{Triple{1.01, 0.002, 0.004}, Triple{-0.003, 0.98, 0.001},
                                     Triple{0.005, -0.002, 1.03}};
constexpr double kDegree = kTurn / 180.0;

TEST(SensorCalibration, TakesScaleFactorAndMisalignmentOutOfTheError) {
  const Triple bias{0.5, -0.2, 1.0};
  const Table table = misread(kLaw, bias);
  RecordingView view = view_of(table, gyro_columns(), {"gx", "gy", "gz", "rz"});
  TriadCalibration known;
  known.law.matrix = kLaw;
  known.law.bias = {bias[0] * kDegree, bias[1] * kDegree, bias[2] * kDegree};
  Calibration calibration;
  calibration.gyroscope = to_apply(known, unit("rad/s"));
  ASSERT_TRUE(apply_calibration(calibration, view));
  for (const ChannelView& channel : view.channels) {
    EXPECT_EQ(channel.role.unit->symbol, "deg/s");
    ASSERT_EQ(channel.values.size(), kRows);
    for (const double error : channel.values) {
      ASSERT_NEAR(error, 0.0, 1e-9) << channel.column;
    }
  }
  EXPECT_THAT(view.window.quality.notes,
              testing::Contains(testing::HasSubstr("'gx', 'gy', 'gz' are corrected by a calibration")));
}

TEST(SensorCalibration, BringsCountsToMetresPerSecondSquared) {
  // 16 bits for +-2 g, an offset of 100 counts on x.
  Table table(3);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    table[axis] = noise(kRows, 20.0, axis);
    for (double& count : table[axis]) {
      count += (axis == 0 ? 100.0 : 0.0) + (axis == 2 ? 16384.0 : 0.0);
    }
  }
  std::map<std::string, ColumnRole> columns;
  for (const char* const axis : {"x", "y", "z"}) {
    columns[axis] = {Quantity::SpecificForce, axis, {}};
  }
  RecordingView view = view_of(table, columns, {"x", "y", "z"});
  const double factor = 2.0 * kStandardGravity / 32768.0;
  Calibration calibration;
  calibration.accelerometer = {unit("1"), {100.0, 0.0, 0.0}, {Triple{factor, 0, 0}, {0, factor, 0}, {0, 0, factor}}};
  ASSERT_TRUE(apply_calibration(calibration, view));
  EXPECT_EQ(view.channels[2].role.unit->symbol, "m/s^2");
  EXPECT_NEAR(view.channels[0].values[7], factor * (table[0][7] - 100.0), 1e-12);
  EXPECT_NEAR(view.channels[2].values[7], factor * table[2][7], 1e-12);
}

TEST(SensorCalibration, LeavesOutRowsThatAnAxisLacks) {
  Table table = misread(kLaw, {});
  table[1][100] = missing_sample(Missing::Nan, 102);
  RecordingView view = view_of(table, gyro_columns(), {"gx", "gy", "gz", "rz"});
  Calibration calibration;
  calibration.gyroscope = {unit("rad/s"), {}, {Triple{1, 0, 0}, {0, 1, 0}, {0, 0.01, 1}}};
  ASSERT_TRUE(apply_calibration(calibration, view));
  EXPECT_EQ(view.channels[0].values.size(), kRows);  // needs no other axis
  EXPECT_THAT(view.channels[2].gaps, testing::ElementsAre(Gap{100, 1}));
  EXPECT_NEAR(view.channels[2].values[100], table[2][101] + 0.01 * table[1][101] - table[3][101], 1e-9);
}

TEST(SensorCalibration, RefusesReadingsItIsNotOf) {
  const Table table = misread(kLaw, {});
  Calibration calibration;
  calibration.gyroscope = {unit("1"), {}, {Triple{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  RecordingView view = view_of(table, gyro_columns(), {"gx", "gy", "gz", "rz"});
  const auto in_counts = apply_calibration(calibration, view);
  ASSERT_FALSE(in_counts);
  EXPECT_EQ(in_counts.error().code, ErrorCode::UnitMismatch);
  auto columns = gyro_columns();
  columns.erase("gy");
  RecordingView two = view_of({table[0], table[2], table[3]}, columns, {"gx", "gz", "rz"});
  calibration.gyroscope = {unit("rad/s"), {}, {Triple{1, 0.1, 0}, {0, 1, 0}, {0, 0, 1}}};
  const auto without_y = apply_calibration(calibration, two);
  ASSERT_FALSE(without_y);
  EXPECT_EQ(without_y.error().code, ErrorCode::InvalidArgument);
}

TEST(AlignedReference, TakesOutTheDelayOfTheTable) {
  // The sensor shows the table 37.3 ms late, with noise of 0.05 deg/s: unaligned the error would be some 3 deg/s.
  constexpr double kDelay = 0.0373;
  Table table{noise(6000, 0.05, 3), std::vector<double>(6000)};
  for (std::size_t i = 0; i < 6000; ++i) {
    const double t = kDt * static_cast<double>(i);
    table[0][i] += table_rate(t - kDelay);
    table[1][i] = table_rate(t);
  }
  table[0][4000] = missing_sample(Missing::Nan, 4002);
  const std::map<std::string, ColumnRole> columns{{"gz", {Quantity::AngularRate, "z", unit("deg/s")}},
                                                  {"rz", {Quantity::ReferenceAngularRate, "z", unit("deg/s")}}};
  RecordingView view = view_of(table, columns, {"gz", "rz"});
  const auto aligned = align_references(view);
  ASSERT_EQ(aligned.size(), 1U);
  EXPECT_EQ(aligned[0].reference, "rz");
  EXPECT_TRUE(aligned[0].applied) << aligned[0].reason;
  ASSERT_TRUE(aligned[0].estimate);
  EXPECT_TRUE(aligned[0].estimate->delay_s.ci95.contains(kDelay));
  const ChannelView& channel = view.channels[0];
  EXPECT_EQ(channel.values.size(), 6000U - 1U - 4U * 6U);  // ceil(3.73) + 2 rows at both ends of both runs
  EXPECT_THAT(channel.gaps, testing::ElementsAre(Gap{3988, 13}));
  double square = 0.0;
  for (const double error : channel.values) {
    square += error * error;
  }
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(channel.values.size())), 0.05, 0.003);
}

TEST(AlignedReference, LeavesAReferenceThatSaysNothing) {
  // A table at a constant rate, measured with noise: nothing tells the delay.
  Table table{noise(kRows, 0.05, 5), noise(kRows, 0.01, 6)};
  const std::map<std::string, ColumnRole> columns{{"gz", {Quantity::AngularRate, "z", unit("deg/s")}},
                                                  {"rz", {Quantity::ReferenceAngularRate, "z", unit("deg/s")}}};
  RecordingView view = view_of(table, columns, {"gz", "rz"});
  const auto aligned = align_references(view);
  ASSERT_EQ(aligned.size(), 1U);
  EXPECT_FALSE(aligned[0].applied);
  EXPECT_FALSE(aligned[0].reason.empty());
  EXPECT_EQ(view.channels[0].values.size(), kRows);
}

TEST(AlignedReference, ReadsTheRateOfAnAngle) {
  // An encoder in degrees that starts again after a turn; the gyroscope reads the rate without error.
  Table table(2, std::vector<double>(kRows));
  for (std::size_t i = 0; i < kRows; ++i) {
    const double t = kDt * static_cast<double>(i);
    table[0][i] = 90.0;
    table[1][i] = std::fmod(90.0 * t, 360.0);
  }
  const std::map<std::string, ColumnRole> columns{{"gz", {Quantity::AngularRate, "z", unit("deg/s")}},
                                                  {"angle", {Quantity::ReferenceAngle, "z", unit("deg")}}};
  const RecordingView view = view_of(table, columns, {"gz", "angle"});
  ASSERT_EQ(view.channels.size(), 1U);
  EXPECT_EQ(view.channels[0].reference_column, "angle");
  for (const double error : view.channels[0].values) {
    ASSERT_NEAR(error, 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace driftlab
