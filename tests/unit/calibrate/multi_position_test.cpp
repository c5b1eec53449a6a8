#include "core/calibrate/multi_position.hpp"

#include "core/calibrate/still_intervals.hpp"
#include "core/read/column_file.hpp"
#include "core/read/format.hpp"
#include "tests/shared_folder.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <optional>
#include <random>

namespace driftlab {
namespace {

constexpr double kG = 9.80665;

/// A triad in counts: y = L x + o, L lower... any matrix; its inverse up to a rotation is what the calibration can
/// find.
Triple counts(const Triple& x) {
  return {33000.0 + 410.0 * x[0] + 3.0 * x[1] - 2.0 * x[2], 33300.0 + 405.0 * x[1] + 4.0 * x[2],
          32900.0 + 415.0 * x[2]};
}

std::vector<Triple> attitudes(std::size_t count, double noise, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Triple> readings;
  for (std::size_t k = 0; k < count; ++k) {
    Triple x{normal(random), normal(random), normal(random)};
    const double size = length(x);
    for (double& value : x) {
      value *= kG / size;
    }
    Triple y = counts(x);
    for (double& value : y) {
      value += noise * normal(random);
    }
    readings.push_back(y);
  }
  return readings;
}

TEST(MultiPosition, FindsTheNineNumbersOfATriadInCounts) {
  // counts() is upper triangular, and so is its inverse: A is that inverse, b the offsets.
  const auto found = calibrate_multi_position(attitudes(40, 0.0, 1), kG);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_TRUE(found->converged);
  EXPECT_NEAR(found->bias[0].value, 33000.0, 1e-6);
  EXPECT_NEAR(found->bias[1].value, 33300.0, 1e-6);
  EXPECT_NEAR(found->bias[2].value, 32900.0, 1e-6);
  EXPECT_NEAR(found->correction[0][0].value, 1.0 / 410.0, 1e-12);
  EXPECT_NEAR(found->correction[1][1].value, 1.0 / 405.0, 1e-12);
  EXPECT_NEAR(found->correction[2][2].value, 1.0 / 415.0, 1e-12);
  EXPECT_NEAR(found->correction[0][1].value, -3.0 / (410.0 * 405.0), 1e-12);
  EXPECT_LT(found->residual_after, 1e-9);
  EXPECT_GT(found->residual_before, 1e-2);
  EXPECT_NEAR(length(found->correct(counts({0.0, kG, 0.0}))), kG, 1e-9);
}

TEST(MultiPosition, SaysHowTheAxesLieToEachOther) {
  // counts(): x reads 3 counts of y where it reads 410 of x, and so on; noise of 4 counts in 40 positions.
  const auto exact = calibrate_multi_position(attitudes(40, 0.0, 1), kG)->misalignment();
  EXPECT_NEAR(exact[0][1].value_or(Estimate{}).value, 3.0 / 410.0, 1e-9);
  EXPECT_NEAR(exact[0][2].value_or(Estimate{}).value, -2.0 / 410.0, 1e-9);
  EXPECT_NEAR(exact[1][2].value_or(Estimate{}).value, 4.0 / 405.0, 1e-9);
  EXPECT_FALSE(exact[1][0] || exact[2][0] || exact[2][1]);  // the frame is chosen so that they are 0
  int held = 0;
  for (std::uint64_t run = 0; run < 200; ++run) {
    const auto angle = calibrate_multi_position(attitudes(40, 4.0, 1000 + run), kG)->misalignment()[0][2];
    held += angle && angle->ci95.contains(-2.0 / 410.0) ? 1 : 0;
  }
  EXPECT_GE(held, 180);  // 0.95 * 200, less three standard errors of 3.1
}

TEST(MultiPosition, LeavesOpenWhatThePositionsDoNotDetermine) {
  // Turned about one level axis only, with x and y alike: no attitude tells A_xx, A_xy and A_yy apart, A_zz stays
  // known.
  std::vector<Triple> readings;
  for (int k = 0; k < 24; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 24.0;
    readings.push_back(
        {kG * std::sin(angle) / std::sqrt(2.0), kG * std::sin(angle) / std::sqrt(2.0), kG * std::cos(angle)});
  }
  const auto found = calibrate_multi_position(readings, kG);
  ASSERT_TRUE(found) << found.error().message;
  const auto angle = found->misalignment()[0][1];
  ASSERT_TRUE(angle);
  EXPECT_TRUE(std::isinf(angle->ci95.low) && std::isinf(angle->ci95.high));
  EXPECT_TRUE(std::isfinite(angle->value));
  EXPECT_TRUE(std::isinf(found->correction[0][0].ci95.high));
  EXPECT_TRUE(std::isfinite(found->correction[2][2].ci95.high));
  EXPECT_GT(found->condition, 1e8);
  EXPECT_FALSE(found->warnings.empty());
}

TEST(MultiPosition, IntervalsHoldTheTruthInNinetyFivePercent) {
  // 400 runs of 30 positions, noise of 4 counts (0.01 m/s^2): standard error of a coverage 1.1 %.
  int bias = 0;
  int scale = 0;
  for (std::uint64_t run = 0; run < 400; ++run) {
    const auto found = calibrate_multi_position(attitudes(30, 4.0, 10 + run), kG);
    ASSERT_TRUE(found);
    bias += found->bias[0].ci95.contains(33000.0) ? 1 : 0;
    scale += found->correction[1][1].ci95.contains(1.0 / 405.0) ? 1 : 0;
  }
  EXPECT_NEAR(bias / 400.0, 0.95, 0.035);
  EXPECT_NEAR(scale / 400.0, 0.95, 0.035);
}

TEST(MultiPosition, RefusesPositionsThatSayTooLittle) {
  EXPECT_FALSE(calibrate_multi_position(attitudes(9, 0.0, 1), kG));
  EXPECT_FALSE(calibrate_multi_position(attitudes(40, 0.0, 1), 0.0));
  std::vector<Triple> flat = attitudes(40, 0.0, 1);
  for (Triple& reading : flat) {
    reading[2] = 33000.0;
  }
  const auto found = calibrate_multi_position(flat, kG);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::TooFewSamples);
}

TEST(StillIntervals, AreFoundBetweenMotions) {
  // Ten rests of 3 s with turns of 1 s between them.
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0.0, 0.02);
  std::array<std::vector<double>, 3> channels;
  for (int i = 0; i < 4000; ++i) {
    const int phase = i % 400;
    const int turn = i / 400;
    const double moving = phase >= 300 ? 3.0 * std::sin(0.2 * phase) : 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      channels[axis].push_back(normal(random) + moving +
                               9.8 * std::sin(static_cast<double>(turn) + static_cast<double>(axis)));
    }
  }
  const auto found = find_still_intervals({channels[0], channels[1], channels[2]}, 100.0);
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->size(), 10U);
  for (std::size_t k = 0; k < found->size(); ++k) {
    const StillInterval& still = (*found)[k];
    EXPECT_GE(still.first, 400 * k);
    EXPECT_LE(still.first + still.count, 400 * k + 300);
    EXPECT_GT(still.count, 150U);
  }
}

std::optional<std::filesystem::path> shared_data() {
  const auto shared = shared_folder();
  return shared ? std::optional(*shared / "data") : std::nullopt;
}

/// Calibrates the accelerometer in three columns of a file from the rests in it.
MultiPositionCalibration calibrate_file(const std::filesystem::path& file, std::size_t first_column, double rate_hz) {
  std::string scratch = (std::filesystem::temp_directory_path() / "driftlab-calibrate-XXXXXX").string();
  const std::filesystem::path directory = ::mkdtemp(scratch.data());
  const auto decoded = decode_file(file, directory / "columns");
  EXPECT_TRUE(decoded) << decoded.error().message;
  const auto columns = ColumnFile::open(directory / "columns");
  std::filesystem::remove_all(directory);
  const std::array<std::span<const double>, 3> triad{columns->column(first_column), columns->column(first_column + 1),
                                                     columns->column(first_column + 2)};
  const auto stills = find_still_intervals(triad, rate_hz);
  EXPECT_TRUE(stills);
  std::vector<Triple> readings;
  for (const StillInterval& still : *stills) {
    const auto mean =
        triad_mean({triad[0].subspan(still.first, still.count), triad[1].subspan(still.first, still.count),
                    triad[2].subspan(still.first, still.count)});
    EXPECT_TRUE(mean) << mean.error().message;
    readings.push_back(mean->mean);
  }
  const auto found = calibrate_multi_position(readings, kG);
  EXPECT_TRUE(found) << readings.size() << " positions: " << found.error().message;
  return found.value_or(MultiPositionCalibration{});
}

TEST(MultiPosition, BringsRealRecordingsToGravity) {
  const auto data = shared_data();
  if (!data) {
    GTEST_SKIP() << "SKIPPED: no real recordings; set DRIFTLAB_SHARED to the directory that holds data/";
  }
  struct Case {
    const char* file;
    std::size_t first_column;
  };
  for (const Case& one :
       {Case{"imu-tk-xsens-multiposition/xsens_acc.mat.xz", 1}, Case{"mpu9150-multiposition/imu0.log.xz", 0},
        Case{"mpu9150-multiposition/imu2.log.xz", 0}, Case{"mpu9150-multiposition/imu4.log.xz", 0}}) {
    const MultiPositionCalibration found = calibrate_file(*data / one.file, one.first_column, 100.0);
    std::cout << one.file << ": " << found.positions << " positions, | |f| - g | rms " << found.residual_before
              << " -> " << found.residual_after << " m/s^2, " << found.iterations << " iterations, condition "
              << found.condition << "\n";
    EXPECT_TRUE(found.converged) << one.file;
    EXPECT_LT(found.residual_after, 0.02 * kG) << one.file;
    EXPECT_LT(found.residual_after, 0.3 * found.residual_before) << one.file;
  }
}

}  // namespace
}  // namespace driftlab
