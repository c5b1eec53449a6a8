// The filter on recorded drives that are not part of the repository, with artificial outages against their references.
#include "core/navigate/recorded_drive.hpp"

#include "core/calibrate/time_alignment.hpp"
#include "core/navigate/outage_prediction.hpp"
#include "core/signal/unit.hpp"
#include "tests/shared_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
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
  const auto shared = shared_folder();
  return shared ? std::optional(*shared / "data") : std::nullopt;
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
  double filter = 0.0, straight = 0.0, nees = 0.0, worst = 0.0, start = 0.0;
};

Figures figures_of(const std::vector<RecordedOutage>& outages, const char* name) {
  Figures figures;
  for (const RecordedOutage& o : outages) {
    figures.filter += o.error_m / static_cast<double>(outages.size());
    figures.straight += o.straight_line_error_m / static_cast<double>(outages.size());
    figures.start += o.start_error_m / static_cast<double>(outages.size());
    figures.nees += o.nees / static_cast<double>(outages.size());
    figures.worst = std::max(figures.worst, o.error_m);
  }
  std::cout << name << ": " << outages.size() << " outages of " << outages.front().outage.duration_s
            << " s, mean error " << figures.filter << " m (worst " << figures.worst << "), straight line "
            << figures.straight << " m, at the start " << figures.start << " m, NEES " << figures.nees << "\n";
  return figures;
}

TEST(RecordedDrive, CarOnAMotorwayWithAPhonesSensors) {
  const auto data = data_folder();
  if (!data) {
    GTEST_SKIP() << "SKIPPED: no recordings; set DRIFTLAB_SHARED to the directory that holds data/";
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
  EXPECT_LT(figures.filter, 0.5 * figures.straight);
  // Two outages of one drive, two dimensions each: the mean of their NEES is below 5.6 in 95 % of drives where the
  // filter is right (chi-square of 4 degrees of freedom at 97.5 %, halved).
  EXPECT_LT(figures.nees, 5.6);
}

/// Heading of the rover's published pose (unix seconds and nanoseconds, then position and quaternion in east, north,
/// up), clockwise from north and unwrapped, at the times of a grid that starts with the poses.
std::vector<double> pose_heading(const std::filesystem::path& path, double dt_s, std::size_t count) {
  std::ifstream file(path);
  std::vector<double> time;
  std::vector<double> heading;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    std::vector<std::string> row;
    for (std::string cell; std::getline(cells, cell, ';');) {
      row.push_back(cell);
    }
    const double x = std::stod(row[8]);
    const double y = std::stod(row[9]);
    const double z = std::stod(row[10]);
    const double w = std::stod(row[11]);
    double value = 0.5 * std::numbers::pi - std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
    if (!heading.empty()) {
      value += 2.0 * std::numbers::pi * std::round((heading.back() - value) / (2.0 * std::numbers::pi));
    }
    time.push_back(std::stod(row[3]) + 1e-9 * std::stod(row[4]));
    heading.push_back(value);
  }
  std::vector<double> out;
  std::size_t at = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = time.front() + static_cast<double>(i) * dt_s;
    while (at + 2 < time.size() && time[at + 1] < t) {
      ++at;
    }
    const double u = std::clamp((t - time[at]) / (time[at + 1] - time[at]), 0.0, 1.0);
    out.push_back((1.0 - u) * heading[at] + u * heading[at + 1]);
  }
  return out;
}

/// How long after the reference the rover's gyro shows the same turns [s]: the reference's heading, differenced over a
/// second, against the gyro's integral over that second, at 20 Hz.
TimeAlignment gyro_delay(const std::filesystem::path& folder, const std::vector<ImuSample>& readings) {
  constexpr std::size_t kEvery = 10;  // 200 Hz to 20 Hz
  constexpr std::size_t kSecond = 20;
  std::vector<double> turned{0.0};
  for (std::size_t i = 0; i + kEvery <= readings.size(); i += kEvery) {
    double sum = 0.0;
    for (std::size_t k = 0; k < kEvery; ++k) {
      sum += readings[i + k][2] * 0.005;
    }
    turned.push_back(turned.back() + sum);
  }
  const std::vector<double> heading = pose_heading(folder / "posecov_gt_data.csv", 0.05, turned.size());
  std::vector<double> measured;
  std::vector<double> reference;
  for (std::size_t i = kSecond; i < turned.size(); ++i) {
    measured.push_back(turned[i] - turned[i - kSecond]);
    reference.push_back(heading[i] - heading[i - kSecond]);
  }
  AlignmentOptions options;
  options.max_shift_s = 10.0;
  return *align_reference(measured, reference, 0.05, options);
}

/// The rover with its unit's clock `delay_s` ahead of the fixes, with or without velocity constraints.
Figures rover(const std::filesystem::path& folder, double delay_s, bool constrained, const char* name) {
  const auto gnss = read_csv(folder / "gnss_planetary.csv");
  RecordedDrive drive;
  drive.dt_s = 0.005;
  drive.start_s = -drive.dt_s - delay_s;
  for (const auto& row : read_csv(folder / "imu.csv")) {
    drive.readings.push_back({row[4], row[5], row[6], row[1], row[2], row[3]});
  }
  for (const auto& row : read_csv(folder / "gnss_planetary_r.csv")) {
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
  if (constrained) {
    // The reference's lateral velocity has a standard deviation of 0.08 m/s and stays for seconds; at 10 Hz that is
    // worth a white error of 0.3 m/s.
    settings.non_holonomic = NonHolonomic{10.0, 0.3};
  }
  const FilterDesign design = *FilterDesign::make(settings, drive.dt_s);
  NavigationState start;
  start.position_ecef_m = drive.reference.front().position_ecef_m;
  // The rover's nose points where its pose says at the start: 90 deg - 2.2 deg from north.
  start.attitude = level_attitude(std::span(drive.readings).first(200), start.position_ecef_m, 88.0 * kDegree);
  std::vector<Outage> outages;
  for (double begin = 60.0; begin < 340.0; begin += 30.0) {
    outages.push_back({begin, 10.0});
  }
  return figures_of(*evaluate_recorded(drive, design, start, outages), name);
}

TEST(RecordedDrive, RoverOverRoughGround) {
  const auto data = data_folder();
  if (!data) {
    GTEST_SKIP() << "SKIPPED: no recordings; set DRIFTLAB_SHARED to the directory that holds data/";
  }
  const auto folder = *data / "nav" / "navego_canada";
  std::vector<ImuSample> readings;
  for (const auto& row : read_csv(folder / "imu.csv")) {
    readings.push_back({row[4], row[5], row[6], row[1], row[2], row[3]});
  }
  // The files' time stamps were written anew by those who published them: the gyro shows each turn 4.7 s after the
  // reference does, and the two recordings differ by 5.4 s in length.
  const TimeAlignment delay = gyro_delay(folder, readings);
  std::cout << "rover: gyro behind the reference by " << delay.delay_s.value << " s [" << delay.delay_s.ci95.low << ", "
            << delay.delay_s.ci95.high << "]\n";
  // Three quarters of the drive by themselves say 4.68 to 4.72 s, the first, where the pose still settles, 4.56 s.
  EXPECT_NEAR(delay.delay_s.value, 4.68, 0.2);
  EXPECT_TRUE(delay.delay_s.ci95.contains(4.68));
  const Figures as_stamped = rover(folder, 0.0, false, "rover, times as stamped");
  const Figures aligned = rover(folder, delay.delay_s.value, false, "rover, aligned");
  const Figures constrained = rover(folder, delay.delay_s.value, true, "rover, aligned, velocity constraints");
  EXPECT_LT(aligned.filter, as_stamped.filter);
  // At 0.4 m/s over rough ground a straight line is hard to beat. With the constraint the filter adds little to the
  // error that fixes of 5 m leave at the start, and knows how good it is (NEES 2; 10 outages: 1.0 to 3.4 hold 95 %).
  EXPECT_LT(constrained.filter, 3.0);
  EXPECT_LT(constrained.filter, 1.5 * constrained.straight);
  EXPECT_LT(constrained.nees, 3.5);
}

TEST(RecordedDrive, ARealDriveThroughTownIsAScenario) {
  // A car's reference trajectory (once a second, with attitude) in place of segments: simulated sensors along it, and a
  // filter that believes the truth knows how good it is on real roads too.
  const auto data = data_folder();
  if (!data) {
    GTEST_SKIP() << "SKIPPED: no recordings; set DRIFTLAB_SHARED to the directory that holds data/";
  }
  const auto rows = read_csv(*data / "nav" / "navego_turin" / "ref.csv");
  OutageScenario scenario = prediction_scenario();
  scenario.drive.start = {rows[0][1], rows[0][2], rows[0][3]};
  for (std::size_t i = 0; i <= 600; ++i) {
    scenario.recorded.push_back(
        {rows[i][0], {rows[i][4], rows[i][5], rows[i][6]}, {rows[i][7], rows[i][8], rows[i][9]}});
  }
  scenario.drive.duration_s = 600.0;
  scenario.outages.clear();
  for (double begin = 60.0; begin < 580.0; begin += 60.0) {
    scenario.outages.push_back({begin, 10.0});
  }
  scenario.filters.front().settings.imu = scenario.truth;
  OutageOptions options;
  options.runs = 20;
  const OutageEvaluation found = *evaluate_outages(scenario, options);
  // The path is the integral of the velocities: after ten minutes within 1 % of its 1.8 km of where the reference is.
  const Vector3 end =
      ned_axes(rows[0][1], rows[0][2]).transpose() *
      (to_ecef({rows[600][1], rows[600][2], rows[600][3]}) - to_ecef({rows[0][1], rows[0][2], rows[0][3]}));
  EXPECT_NEAR(found.truth.north_m.back(), end.x(), 18.0);
  EXPECT_NEAR(found.truth.east_m.back(), end.y(), 18.0);
  const FilterEvaluation& filter = found.filters.front();
  std::cout << "town: " << filter.mean_error_m.value << " m after 10 s, NEES " << filter.nees.value << " ["
            << filter.nees.ci95.low << ", " << filter.nees.ci95.high << "]\n";
  // Twice the half-width of the interval: one seed in 10 000 would fail a filter that is right.
  EXPECT_NEAR(filter.nees.value, 2.0, 2.0 * (filter.nees.ci95.high - filter.nees.value));
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
