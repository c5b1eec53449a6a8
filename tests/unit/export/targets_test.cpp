// What the numbers of every export target mean: each program's own recursion, written anew here from its documentation,
// must give the noise that was exported. A target without its recursion fails.
#include "core/export/target.hpp"
#include "schema/text/export.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>

namespace driftlab {
namespace {

constexpr double kRate = 200.0;
constexpr std::array<double, 3> kDensity{1.1e-4, 2.3e-4,
                                         3.7e-4};  // gyroscope [rad/s/sqrt(Hz)]; the accelerometer 10 times
constexpr std::array<double, 3> kWalk{0.7e-6, 1.9e-6, 2.8e-6};
constexpr std::array<double, 3> kSigma{2.1e-5, 1.3e-5, 3.9e-5};
constexpr std::array<double, 3> kTime{210.0, 330.0, 540.0};

NoiseFigure known(double value) { return {value, 0.9 * value, 1.1 * value, false, "joint fit"}; }

ImuNoise example() {
  ImuNoise imu;
  imu.device = "unit-1";
  imu.condition = "static";
  imu.recordings = {"rec"};
  imu.rate_hz = kRate;
  for (const double factor : {1.0, 10.0}) {
    SensorNoise& sensor = factor == 1.0 ? imu.gyroscope : imu.accelerometer;
    for (std::size_t i = 0; i < 3; ++i) {
      sensor.axes.push_back({std::string(1, static_cast<char>('x' + static_cast<int>(i))), "c", kRate, 3600.0,
                             known(factor * kDensity[i]), known(factor * kWalk[i]), known(factor * kSigma[i]),
                             known(kTime[i])});
    }
  }
  return imu;
}

using Values = std::map<std::string, std::vector<double>>;

Values values_of(const ExportTarget& target, const ImuNoise& imu) {
  Values values;
  for (const ExportEntry& entry : target.entries(imu)) {
    for (const NoiseFigure& figure : entry.figures) {
      values[entry.key].push_back(figure.value.value_or(-1.0));
    }
  }
  return values;
}

/// Variances after one second: of the integral of the white noise, and of a bias that starts at zero.
struct Growth {
  double integral = 0.0;
  double bias = 0.0;
};

/// A recursion with a step: what it adds to the two variances, and by what the bias decays.
Growth run(double step_s, double integral_step, double bias_step, double decay = 1.0) {
  Growth growth;
  const auto steps = static_cast<int>(std::lround(1.0 / step_s));
  for (int i = 0; i < steps; ++i) {
    growth.integral += integral_step;
    growth.bias = decay * decay * growth.bias + bias_step;
  }
  const double rest = (1.0 - steps * step_s) / step_s;  // a step that does not divide a second
  return {growth.integral * (1.0 + rest / steps), growth.bias * (1.0 + rest / steps)};
}

double square(double value) { return value * value; }

/// What the values mean for a sensor (0 gyroscope, 1 accelerometer) about an axis.
using Meaning = std::function<Growth(const Values& v, std::size_t sensor, std::size_t axis)>;

double one(const Values& v, const std::string& key, std::size_t index = 0) { return v.at(key).at(index); }

/// Continuous densities, as Kalibr's wiki writes them: sigma_d = sigma / sqrt(dt), sigma_bd = sigma_b sqrt(dt).
Meaning densities(std::array<const char*, 2> noise, std::array<const char*, 2> walk) {
  return [=](const Values& v, std::size_t s, std::size_t) {
    const double dt = 1.0 / kRate;
    const double reading = one(v, noise[s]) / std::sqrt(dt);
    const double step = one(v, walk[s]) * std::sqrt(dt);
    return run(dt, square(reading * dt), square(step));
  };
}

/// (number * step)^2 a step for both: EKF2 and EKF3.
Meaning per_step(double step_s, std::array<const char*, 2> noise, std::array<const char*, 2> walk) {
  return [=](const Values& v, std::size_t s, std::size_t) {
    return run(step_s, square(one(v, noise[s]) * step_s), square(one(v, walk[s]) * step_s));
  };
}

const std::map<std::string_view, Meaning>& meanings() {
  static const double dt = 1.0 / kRate;
  static const double deg = std::acos(-1.0) / 180.0;
  static const std::map<std::string_view, Meaning> all{
      {"kalibr", densities({"gyroscope_noise_density", "accelerometer_noise_density"},
                           {"gyroscope_random_walk", "accelerometer_random_walk"})},
      {"openvins", densities({"imu0/gyroscope_noise_density", "imu0/accelerometer_noise_density"},
                             {"imu0/gyroscope_random_walk", "imu0/accelerometer_random_walk"})},
      {"orb-slam3",
       [](const Values& v, std::size_t s, std::size_t) {  // Calib: noise * sqrt(f), walk / sqrt(f)
         const double root = std::sqrt(one(v, "IMU.Frequency"));
         const double reading = one(v, s == 0 ? "IMU.NoiseGyro" : "IMU.NoiseAcc") * root;
         const double step = one(v, s == 0 ? "IMU.GyroWalk" : "IMU.AccWalk") / root;
         return run(dt, square(reading * dt), square(step));
       }},
      {"vins-fusion",
       [](const Values& v, std::size_t s, std::size_t) {  // readings of deviation n; the bias row of V is dt
         const double reading = one(v, s == 0 ? "gyr_n" : "acc_n");
         const double walk = one(v, s == 0 ? "gyr_w" : "acc_w");
         return run(dt, square(reading * dt), square(walk * dt));
       }},
      {"gtsam",
       [](const Values& v, std::size_t s, std::size_t i) {  // cov / dt for a reading, cov * dt for the bias
         const double white = one(v, s == 0 ? "gyroscopeCovariance" : "accelerometerCovariance", i);
         const double walk = one(v, s == 0 ? "biasOmegaCovariance" : "biasAccCovariance", i);
         return run(dt, white / dt * square(dt), walk * dt);
       }},
      {"kf-gins",
       [](const Values& v, std::size_t s, std::size_t i) {  // Qd = Q dt with Q = 2 std^2 / T, Phi = 1 - dt / T
         const double time = one(v, "imunoise/corrtime") * 3600.0;
         const double white = s == 0 ? one(v, "imunoise/arw", i) * deg / 60.0 : one(v, "imunoise/vrw", i) / 60.0;
         const double deviation =
             s == 0 ? one(v, "imunoise/gbstd", i) * deg / 3600.0 : one(v, "imunoise/abstd", i) * 1e-5;
         return run(dt, square(white) * dt, 2.0 / time * square(deviation) * dt, 1.0 - dt / time);
       }},
      {"navego",
       [](const Values& v, std::size_t s, std::size_t i) {  // Q = diag(arw, vrw, gb_psd, ab_psd)^2, F = -1 / corr
         const double white = one(v, s == 0 ? "imu.arw" : "imu.vrw", i);
         const double driving = one(v, s == 0 ? "imu.gb_psd" : "imu.ab_psd", i);
         const double time = one(v, s == 0 ? "imu.gb_corr" : "imu.ab_corr", i);
         return run(dt, square(white) * dt, square(driving) * dt, std::exp(-dt / time));
       }},
      {"gnss-ins-sim",
       [](const Values& v, std::size_t s, std::size_t i) {  // a = 1 - dt/T, b = drift sqrt(1 - exp(-2 dt/T))
         const double white = s == 0 ? one(v, "gyro_arw", i) * deg / 60.0 : one(v, "accel_vrw", i) / 60.0;
         const double drift = s == 0 ? one(v, "gyro_b_stability", i) * deg / 3600.0 : one(v, "accel_b_stability", i);
         const double time = one(v, s == 0 ? "gyro_b_corr" : "accel_b_corr", i);
         return run(dt, square(white / std::sqrt(dt) * dt), square(drift) * -std::expm1(-2.0 * dt / time),
                    1.0 - dt / time);
       }},
      {"px4", per_step(0.010, {"EKF2_GYR_NOISE", "EKF2_ACC_NOISE"}, {"EKF2_GYR_B_NOISE", "EKF2_ACC_B_NOISE"})},
      {"ardupilot", per_step(0.012, {"EK3_GYRO_P_NSE", "EK3_ACC_P_NSE"}, {"EK3_GBIAS_P_NSE", "EK3_ABIAS_P_NSE"})},
      {"robot-localization",
       [](const Values& v, std::size_t s, std::size_t i) {  // variance of a reading; no bias
         const double variance =
             one(v, s == 0 ? "angular_velocity_covariance" : "linear_acceleration_covariance", 4 * i);
         return run(dt, variance * square(dt), -1.0);
       }},
      {"imu-tools",
       [](const Values& v, std::size_t,
          std::size_t) {  // beta = sqrt(3/4) error of a reading, zeta likewise of its rate
         const double error = one(v, "imu_filter_madgwick_node/ros__parameters/gain") / std::sqrt(0.75);
         const double rate = one(v, "imu_filter_madgwick_node/ros__parameters/zeta") / std::sqrt(0.75);
         return run(dt, square(error * dt), square(rate * dt));
       }},
      {"gazebo",
       [](const Values& v, std::size_t s, std::size_t i) {  // GaussianNoiseModel: sigma_b^2 T/2 (1 - exp(-2 dt/T))
         const std::string axis(1, static_cast<char>('x' + static_cast<int>(i)));
         const std::string group = std::string("imu/") + (s == 0 ? "angular_velocity/" : "linear_acceleration/") +
                                   axis + "/noise type=\"gaussian\"/";
         const double time = one(v, group + "dynamic_bias_correlation_time");
         const double sigma = one(v, group + "dynamic_bias_stddev");
         return run(dt, square(one(v, group + "stddev") * dt),
                    -square(sigma) * time / 2.0 * std::expm1(-2.0 * dt / time), std::exp(-dt / time));
       }},
      {"isaac",
       [](const Values& v, std::size_t s, std::size_t) {  // one draw a reading, one draw of the bias a reset
         const double reading = one(v, s == 0 ? "GYROSCOPE_STD" : "ACCELEROMETER_STD");
         const Growth growth = run(dt, square(reading * dt), 0.0);
         return Growth{growth.integral, square(one(v, s == 0 ? "GYROSCOPE_BIAS_STD" : "ACCELEROMETER_BIAS_STD"))};
       }},
  };
  return all;
}

/// Programs with one number a sensor get the largest; the others each axis its own.
bool per_axis(std::string_view name) {
  for (const std::string_view one_each :
       {"gtsam", "kf-gins", "navego", "gnss-ins-sim", "gazebo", "robot-localization"}) {
    if (name == one_each) {
      return true;
    }
  }
  return false;
}

double expected_bias(const ExportTarget& target, std::size_t axis) {
  if (target.name == "isaac") {
    return square(kSigma[2]);
  }
  if (target.bias == BiasModel::Markov) {
    return square(kSigma[axis]) * -std::expm1(-2.0 / kTime[axis]);
  }
  return target.bias == BiasModel::Walk ? square(kWalk[axis]) : -kRate;
}

TEST(ExportTargets, MeanInEachProgramsOwnRecursionTheNoiseThatWasMeasured) {
  const ImuNoise imu = example();
  for (const ExportTarget& target : export_targets()) {
    SCOPED_TRACE(std::string(target.name));
    const auto meaning = meanings().find(target.name);
    ASSERT_NE(meaning, meanings().end()) << "write the recursion of this program into this test";
    const Values values = values_of(target, imu);
    for (std::size_t sensor = 0; sensor < (target.name == "imu-tools" ? 1U : 2U); ++sensor) {
      const double scale = sensor == 0 ? 1.0 : 100.0;
      for (std::size_t axis = per_axis(target.name) ? 0U : 2U; axis < 3; ++axis) {
        const Growth growth = meaning->second(values, sensor, axis);
        EXPECT_NEAR(growth.integral / (scale * square(kDensity[axis])), 1.0, 1e-9);
        // Steps against T, and one correlation time for all axes: the decay within a second differs by up to 1/T of it.
        const double tolerance = target.bias == BiasModel::Markov ? 0.005 : 1e-9;
        const double wanted = expected_bias(target, axis) * (target.bias == BiasModel::None ? 1.0 : scale);
        EXPECT_NEAR(growth.bias / wanted, 1.0, tolerance);
      }
    }
  }
}

TEST(ExportTargets, AreFilesWhoseNumbersReadersTakeForNumbers) {
  // "200" is an integer for OpenCV, which ORB-SLAM3 refuses for a rate, and "1e-05" a word for PyYAML.
  const ImuNoise imu = example();
  for (const ExportTarget& target : export_targets()) {
    SCOPED_TRACE(std::string(target.name));
    const std::string text = export_to_text(target, imu);
    if (!target.first_line.empty()) {
      EXPECT_TRUE(text.starts_with(std::string(target.first_line) + "\n"));
    }
    EXPECT_TRUE(text.ends_with("\n"));
    EXPECT_NE(text.find("unit-1"), std::string::npos);
    EXPECT_NE(text.find(std::string(target.source).substr(0, 30)), std::string::npos);
    EXPECT_NE(text.find("95 % interval"), std::string::npos);
    EXPECT_TRUE(export_gaps(target, imu).empty());
    if (target.syntax != ExportSyntax::Yaml) {
      continue;
    }
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t colon = line.find(": ");
      const std::string value =
          colon == std::string::npos || line.find('#') != std::string::npos ? "" : line.substr(colon + 2);
      if (!value.empty() && value.find_first_not_of("0123456789.e-+") == std::string::npos) {
        EXPECT_NE(value.find('.'), std::string::npos) << line;
      }
    }
  }
}

TEST(ExportTargets, LeaveOutWhatTheRecordingDoesNotGiveAndSayWhy) {
  ImuNoise imu = example();
  imu.accelerometer.axes.clear();
  imu.accelerometer.missing = "No column is known to be an accelerometer.";
  for (AxisNoise& axis : imu.gyroscope.axes) {
    axis.walk.limit = true;
  }
  const auto kalibr = find_export_target("kalibr");
  ASSERT_TRUE(kalibr);
  const std::string text = export_to_text(**kalibr, imu);
  EXPECT_NE(text.find("# accelerometer_noise_density is not given. No column is known to be an accelerometer."),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("\naccelerometer_noise_density:"), std::string::npos);
  const std::vector<std::string> gaps = export_gaps(**kalibr, imu);
  ASSERT_EQ(gaps.size(), 3U);
  EXPECT_EQ(gaps[2], "gyroscope_random_walk is an upper limit: the recording does not identify it.");
  EXPECT_NE(text.find("identified about no axis"), std::string::npos) << text;
}

TEST(ExportTargets, SayOfAnOpenIntervalWhichSideIsKnown) {
  ImuNoise imu = example();
  imu.gyroscope.axes[0].correlation_s.high.reset();
  imu.gyroscope.axes[1].correlation_s.low.reset();
  imu.gyroscope.axes[2].correlation_s = {540.0, std::nullopt, std::nullopt, false, "joint fit"};
  const std::string text = export_to_text(**find_export_target("navego"), imu);
  std::string line;  // the comments run over line ends
  for (const char c : text) {
    line += c == '\n' || c == '%' ? ' ' : c;
  }
  for (std::size_t at = line.find("  "); at != std::string::npos; at = line.find("  ")) {
    line.erase(at, 1);
  }
  EXPECT_NE(line.find("x: 95 interval above 189.0; joint fit. y: 95 interval below 363.0; joint fit. z: joint fit."),
            std::string::npos)
      << line;
}

TEST(ExportTargets, PreferWhatIsIdentifiedToALimitThatIsLarger) {
  ImuNoise imu = example();
  imu.gyroscope.axes[2].walk = {1.0, {}, {}, true, "limit"};
  const NoiseFigure walk = largest(imu.gyroscope, &AxisNoise::walk);
  EXPECT_FALSE(walk.limit);
  EXPECT_DOUBLE_EQ(walk.value.value_or(0.0), kWalk[1]);
  const auto each = by_axis(imu.gyroscope, &AxisNoise::walk);
  EXPECT_DOUBLE_EQ(each[0].value.value_or(0.0), kWalk[0]);
  EXPECT_DOUBLE_EQ(each[2].value.value_or(0.0), kWalk[1]);
}

TEST(ExportTargets, LendAnAxisTheWholeBiasOfAnotherOne) {
  // About x the fit found no bias and a limit stands for it, with the record's length for its time; the largest
  // deviation is that about z, the longest time that about y, the fastest bias is y's.
  ImuNoise imu = example();
  for (SensorNoise* const sensor : {&imu.gyroscope, &imu.accelerometer}) {
    sensor->axes[0].bias_sd = {2.0 * *sensor->axes[2].bias_sd.value, {}, {}, true, "limit"};
    sensor->axes[0].correlation_s = {3600.0, {}, {}, false, "the record's length"};
    sensor->axes[1].correlation_s = known(30.0);
  }
  ImuNoise unrecorded = imu;
  unrecorded.gyroscope.axes.erase(unrecorded.gyroscope.axes.begin());
  unrecorded.accelerometer.axes.erase(unrecorded.accelerometer.axes.begin());
  for (const ExportTarget& target : export_targets()) {
    if (target.bias != BiasModel::Markov || !per_axis(target.name)) {
      continue;
    }
    for (const ImuNoise& one : {imu, unrecorded}) {
      SCOPED_TRACE(std::string(target.name));
      const Values values = values_of(target, one);
      for (std::size_t sensor = 0; sensor < 2; ++sensor) {
        const Meaning& meaning = meanings().at(target.name);
        // One correlation time for all axes (KF-GINS) takes the fastest bias for the largest: of its own kind again.
        const std::size_t lender = target.name == "kf-gins" ? 1 : 2;
        EXPECT_NEAR(meaning(values, sensor, 0).bias / meaning(values, sensor, lender).bias, 1.0, 1e-12);
        const double wanted = (sensor == 0 ? 1.0 : 100.0) * square(kSigma[2]) * -std::expm1(-2.0 / kTime[2]);
        EXPECT_NEAR(meaning(values, sensor, 2).bias / wanted, 1.0, 0.01);  // a second against the times
      }
    }
  }
}

TEST(ExportTargets, AreKnownByNameAndAnUnknownOneNamesThem) {
  for (const ExportTarget& target : export_targets()) {
    EXPECT_TRUE(find_export_target(target.name));
  }
  const auto none = find_export_target("kaliber");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("kalibr"), std::string::npos);
}

}  // namespace
}  // namespace driftlab
