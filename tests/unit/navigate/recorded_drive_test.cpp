// The filter on recorded drives that are not part of the repository, with artificial outages against their references.
#include "core/navigate/recorded_drive.hpp"

#include "core/signal/unit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <numbers>
#include <sstream>

namespace driftlab {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMilliG = 1e-3 * kStandardGravity;

std::optional<std::filesystem::path> data_folder() {
  const char* const stated = std::getenv("DRIFTLAB_SHARED");  // NOLINT(concurrency-mt-unsafe): tests run one thread
  const std::filesystem::path path =
      stated != nullptr ? std::filesystem::path(stated)
                        : std::filesystem::path(__FILE__).parent_path() / ".." / ".." / ".." / ".." / "shared";
  if (std::filesystem::exists(path / "data")) {
    return path / "data";
  }
  std::cerr << "SKIPPED, NOT PASSED: no recordings at " << path << "; set DRIFTLAB_SHARED to the shared folder\n";
  return std::nullopt;
}

/// Rows of an NPY file of little-endian doubles, C or Fortran order, one or two dimensions.
std::vector<std::vector<double>> read_npy(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes.at(i))); };
  const std::size_t header = 10 + byte(8) + 256 * byte(9);
  const std::string text = bytes.substr(10, header - 10);
  const bool fortran = text.find("'fortran_order': True") != std::string::npos;
  const std::size_t open = text.find('(');
  std::istringstream shape(text.substr(open + 1, text.find(')') - open - 1));
  std::size_t rows = 0;
  std::size_t columns = 1;
  char comma = ',';
  shape >> rows >> comma;
  if (!(shape >> columns)) {
    columns = 1;
  }
  std::vector<std::vector<double>> out(rows, std::vector<double>(columns));
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      const std::size_t at = fortran ? c * rows + r : r * columns + c;
      std::memcpy(&out[r][c], bytes.data() + header + at * sizeof(double), sizeof(double));
    }
  }
  return out;
}

/// Rows of a CSV file with one line of names.
std::vector<std::vector<double>> read_csv(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',');) {
      row.push_back(std::stod(cell));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

ImuModel model_of(double gyro_n, double gyro_bias_sd, double gyro_walk, double force_n, double force_bias_sd,
                  double force_walk) {
  ImuModel model;
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    const bool gyro = c < 3;
    model.axes[c].bias_sd = gyro ? gyro_bias_sd : force_bias_sd;
    model.axes[c].processes = ModelSchedule::constant({*make_process("white_noise", {gyro ? gyro_n : force_n}),
                                                       *make_process("random_walk", {gyro ? gyro_walk : force_walk})});
  }
  return model;
}

/// Mean errors of filter and straight line, told to whoever reads the log.
struct Figures {
  double filter = 0.0, straight = 0.0, nees = 0.0, worst = 0.0;
};

Figures figures_of(const std::vector<RecordedOutage>& outages, const char* name) {
  Figures figures;
  for (const RecordedOutage& o : outages) {
    figures.filter += o.error_m / static_cast<double>(outages.size());
    figures.straight += o.straight_line_error_m / static_cast<double>(outages.size());
    figures.nees += o.nees / static_cast<double>(outages.size());
    figures.worst = std::max(figures.worst, o.error_m);
  }
  std::cout << name << ": " << outages.size() << " outages of " << outages.front().outage.duration_s
            << " s, mean error " << figures.filter << " m (worst " << figures.worst << "), straight line "
            << figures.straight << " m, NEES " << figures.nees << "\n";
  return figures;
}

TEST(RecordedDrive, CarOnAMotorwayWithAPhonesSensors) {
  const auto data = data_folder();
  if (!data) {
    GTEST_SKIP() << "no recordings";
  }
  const auto folder = *data / "comma2k19-segment40";
  const auto t = read_npy(folder / "processed_log/IMU/accelerometer/t.npy");
  const auto force = read_npy(folder / "processed_log/IMU/accelerometer/value.npy");
  const auto rate = read_npy(folder / "processed_log/IMU/gyro_uncalibrated/value.npy");
  RecordedDrive drive;
  drive.dt_s = (t.back()[0] - t.front()[0]) / static_cast<double>(t.size() - 1);
  drive.start_s = t.front()[0] - drive.dt_s;
  for (std::size_t i = 0; i < t.size(); ++i) {
    drive.readings.push_back({rate[i][0], rate[i][1], rate[i][2], force[i][0], force[i][1], force[i][2]});
  }
  const auto frame_t = read_npy(folder / "global_pose/frame_times.npy");
  const auto position = read_npy(folder / "global_pose/frame_positions.npy");
  const auto velocity = read_npy(folder / "global_pose/frame_velocities.npy");
  const auto orientation = read_npy(folder / "global_pose/frame_orientations.npy");
  for (std::size_t i = 0; i < frame_t.size(); ++i) {
    drive.reference.push_back({frame_t[i][0], {position[i][0], position[i][1], position[i][2]}});
  }
  // Fixes: latitude, longitude, speed, time, altitude, bearing. Altitude is above the geoid, 32 m higher than the
  // ellipsoid at San Francisco; positions are compared horizontally, so height is told to the filter as poorly known.
  const auto fix_t = read_npy(folder / "processed_log/GNSS/live_gnss_ublox/t.npy");
  const auto fix = read_npy(folder / "processed_log/GNSS/live_gnss_ublox/value.npy");
  const double height = to_geodetic(drive.reference.front().position_ecef_m).height_m;
  for (std::size_t i = 0; i < fix.size(); ++i) {
    GnssFix out;
    out.arrival_s = out.validity_s = fix_t[i][0];
    const Geodetic place{fix[i][0] * kDegree, fix[i][1] * kDegree, height};
    out.position_ecef_m = to_ecef(place);
    out.velocity_ecef_m_s =
        ned_axes(place.latitude_rad, place.longitude_rad) *
        Vector3(fix[i][2] * std::cos(fix[i][5] * kDegree), fix[i][2] * std::sin(fix[i][5] * kDegree), 0.0);
    out.position_sd_m = {3.0, 3.0, 10.0};
    out.velocity_sd_m_s = {0.3, 0.3, 1.0};
    drive.fixes.push_back(out);
  }
  FilterSettings settings;
  settings.imu = model_of(5e-4, 0.07, 2e-5, 0.01, 50.0 * kMilliG, 1e-3);
  settings.initial.position_sd_m = {5.0, 5.0, 10.0};
  settings.initial.velocity_sd_m_s = {0.5, 0.5, 0.5};
  settings.initial.tilt_sd_rad = 2.0 * kDegree;
  settings.initial.heading_sd_rad = 5.0 * kDegree;
  const FilterDesign design = *FilterDesign::make(settings, drive.dt_s);
  NavigationState start;
  start.position_ecef_m = drive.reference.front().position_ecef_m;
  start.velocity_ecef_m_s = {velocity[0][0], velocity[0][1], velocity[0][2]};
  start.attitude = Quaternion(orientation[0][0], orientation[0][1], orientation[0][2], orientation[0][3]).normalized();
  const double begin = drive.reference.front().time_s;
  const auto outages = *evaluate_recorded(drive, design, start, {{begin + 25.0, 10.0}, {begin + 40.0, 10.0}});
  ASSERT_EQ(outages.size(), 2U);
  const Figures figures = figures_of(outages, "car");
  // A consumer unit carries ten seconds of motorway to a few metres; the receiver itself is 2 to 4 m off this
  // reference.
  EXPECT_LT(figures.worst, 15.0);
}

TEST(RecordedDrive, RoverOverRoughGround) {
  const auto data = data_folder();
  if (!data) {
    GTEST_SKIP() << "no recordings";
  }
  const auto folder = *data / "nav" / "navego_canada";
  const auto imu = read_csv(folder / "imu.csv");
  const auto gnss = read_csv(folder / "gnss_planetary.csv");
  const auto reference = read_csv(folder / "gnss_planetary_r.csv");
  RecordedDrive drive;
  drive.dt_s = 0.005;
  drive.start_s = -drive.dt_s;
  for (const auto& row : imu) {
    drive.readings.push_back({row[4], row[5], row[6], row[1], row[2], row[3]});
  }
  for (const auto& row : reference) {
    drive.reference.push_back({row[0], to_ecef({row[1], row[2], row[3]})});
  }
  for (std::size_t i = 0; i < gnss.size(); i += 20) {  // one of twenty fixes: once a second
    GnssFix fix;
    fix.arrival_s = fix.validity_s = gnss[i][0];
    fix.position_ecef_m = to_ecef({gnss[i][1], gnss[i][2], gnss[i][3]});
    fix.velocity_ecef_m_s = ned_axes(gnss[i][1], gnss[i][2]) * Vector3(gnss[i][4], gnss[i][5], gnss[i][6]);
    fix.position_sd_m = {5.0, 5.0, 5.0};
    fix.velocity_sd_m_s = {0.1, 0.1, 0.1};
    drive.fixes.push_back(fix);
  }
  FilterSettings settings;
  settings.imu = model_of(2e-3, 0.02, 1e-5, 0.05, 30.0 * kMilliG, 1e-3);
  settings.initial.position_sd_m = {5.0, 5.0, 5.0};
  settings.initial.velocity_sd_m_s = {0.2, 0.2, 0.2};
  settings.initial.tilt_sd_rad = 3.0 * kDegree;
  settings.initial.heading_sd_rad = 20.0 * kDegree;
  const FilterDesign design = *FilterDesign::make(settings, drive.dt_s);
  NavigationState start;
  start.position_ecef_m = drive.reference.front().position_ecef_m;
  // The rover's nose points where its pose says at the start: 90 deg - 2.2 deg from north.
  start.attitude = level_attitude(std::span(drive.readings).first(200), start.position_ecef_m, 88.0 * kDegree);
  std::vector<Outage> outages;
  for (double begin = 60.0; begin < 340.0; begin += 30.0) {
    outages.push_back({begin, 10.0});
  }
  const auto scored = *evaluate_recorded(drive, design, start, outages);
  ASSERT_EQ(scored.size(), outages.size());
  const Figures figures = figures_of(scored, "rover");
  // Fixes of 5 m average to about 1 m; ten seconds of an industrial unit add a few.
  EXPECT_LT(figures.filter, 10.0);
}

TEST(RecordedDrive, RefusesOutagesBeyondItsReference) {
  RecordedDrive drive;
  drive.readings.resize(1000);
  drive.fixes.resize(1);
  drive.reference = {{0.0, {6.4e6, 0.0, 0.0}}, {5.0, {6.4e6, 0.0, 0.0}}};
  const FilterDesign design = *FilterDesign::make({}, drive.dt_s);
  EXPECT_EQ(evaluate_recorded(drive, design, {}, {{3.0, 5.0}}).error().code, ErrorCode::InvalidArgument);
  drive.readings.clear();
  EXPECT_EQ(evaluate_recorded(drive, design, {}, {}).error().code, ErrorCode::TooFewSamples);
}

}  // namespace
}  // namespace driftlab
