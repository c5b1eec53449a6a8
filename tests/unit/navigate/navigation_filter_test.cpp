#include "core/navigate/navigation_filter.hpp"

#include "core/navigate/outage_runs.hpp"
#include "core/navigate/paper_scenario.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kDt = 0.01;

Process process_of(std::string_view name, std::vector<double> values) { return *make_process(name, std::move(values)); }

/// A unit with the kinds of states a filter can hold: alone, in pairs, known and unknown.
ImuModel rich_model() {
  ImuModel model;
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    const double unit = c < 3 ? 1e-3 : 1e-2;
    model.axes[c].bias_sd = unit;
    model.axes[c].processes =
        ModelSchedule::constant({process_of("white_noise", {0.1 * unit}), process_of("gauss_markov", {unit, 2.0})});
  }
  model.axes[0].processes =
      ModelSchedule::constant({process_of("random_walk", {1e-4}), process_of("linear_drift", {1e-5})});
  model.axes[5].processes = ModelSchedule::constant({process_of("sinusoid", {1e-2, 0.7})});
  return model;
}

NavigationState start_state() {
  NavigationState start;
  start.position_ecef_m = to_ecef({0.8, 0.2, 300.0});
  start.attitude = Quaternion(ned_axes(0.8, 0.2)) * from_euler({0.1, -0.2, 0.9});
  start.velocity_ecef_m_s = start.attitude * Vector3(20.0, 0.0, 0.0);
  return start;
}

/// Twenty samples of hard manoeuvre: turning at up to 60 deg/s with changing force.
std::vector<ImuSample> manoeuvre(int samples) {
  std::vector<ImuSample> readings;
  for (int i = 0; i < samples; ++i) {
    const double t = i * kDt;
    readings.push_back({0.3 * std::sin(9.0 * t), 0.2, 1.0 + 0.3 * t, 2.0 + std::cos(5.0 * t), 3.0 * t, -9.8});
  }
  return readings;
}

/// Position, velocity and attitude of `other` minus `base`, in e.
Eigen::Matrix<double, 9, 1> gap(const NavigationState& other, const NavigationState& base) {
  Eigen::Matrix<double, 9, 1> out;
  out << other.position_ecef_m - base.position_ecef_m, other.velocity_ecef_m_s - base.velocity_ecef_m_s,
      rotation_vector(other.attitude * base.attitude.conjugate());
  return out;
}

NavigationState mechanise(const NavigationState& start, const std::vector<ImuSample>& readings, std::size_t channel,
                          const std::vector<double>& error) {
  Strapdown strapdown(start, kDt);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    ImuSample s = readings[i];
    if (!error.empty()) {
      s[channel] -= error[i];
    }
    (void)strapdown.advance({s[0], s[1], s[2]}, {s[3], s[4], s[5]});
  }
  return strapdown.state();
}

/// A test of the transition in units where every entry matters: each column is scaled by the disturbance, each row by
/// the largest entry of the row among all columns of its block.
TEST(NavigationFilter, TransitionMatchesDifferencesOfTheMechanisation) {
  FilterSettings settings;
  settings.imu = rich_model();
  settings.covariance_samples = 50;
  const FilterDesign design = *FilterDesign::make(settings, kDt);
  const NavigationState start = start_state();
  const auto readings = manoeuvre(20);
  NavigationFilter filter(design, start);
  filter.advance(std::span(readings));
  const Eigen::MatrixXd phi = filter.pending_transition();
  // The filter takes the drift's known mean off the x rate; the reference for differences is its own path.
  std::vector<ImuSample> corrected = readings;
  for (std::size_t i = 0; i < corrected.size(); ++i) {
    corrected[i][0] -= 1e-5 * kDt * static_cast<double>(i);
  }
  const NavigationState base = mechanise(start, corrected, 0, {});
  EXPECT_LT(gap(base, filter.state()).norm(), 1e-8);

  const auto compare = [&](Eigen::Index column, const Eigen::Matrix<double, 9, 1>& slope, double tolerance) {
    for (Eigen::Index block = 0; block < 9; block += 3) {
      const double size = slope.segment<3>(block).norm();
      const double off = (phi.block<3, 1>(block, column) - slope.segment<3>(block)).norm();
      // Left out: (w_ie T)^2 = 2e-10, sums for integrals (1/20^2), and that a state's weight changes while the body
      // turns: a twelfth of the turning (0.2 rad here) times the relative change of the weight (2 for a slope from
      // 0): 3.3 %.
      const double floor = block == 0 ? 1e-7 : 1e-8;
      EXPECT_LT(off, tolerance * size + floor) << "column " << column << ", rows from " << block;
    }
  };
  for (Eigen::Index k = 0; k < 9; ++k) {
    const double step = k < 3 ? 10.0 : (k < 6 ? 1e-2 : 1e-4);
    const Vector3 unit = step * Vector3::Unit(k % 3);
    const auto moved = [&](double sign) {
      NavigationState s = start;
      if (k < 3) {
        s.position_ecef_m += sign * unit;
      } else if (k < 6) {
        s.velocity_ecef_m_s += sign * unit;
      } else {
        s.attitude = rotation(sign * unit) * s.attitude;
      }
      return mechanise(s, corrected, 0, {});
    };
    compare(k, gap(moved(1.0), moved(-1.0)) / (2.0 * step), 0.01);
  }
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    const ChannelDynamics& axis = design.channel(c, 0);
    for (int i = 0; i < axis.states; ++i) {
      const double step = 1e-3;  // positions are rounded to 1e-9 m: 1e-6 of the slope
      AxisVector x = AxisVector::Zero(axis.states);
      x(i) = step;
      std::vector<double> error;
      for (std::size_t t = 0; t < readings.size(); ++t) {
        error.push_back(axis.output.dot(x));
        x = (axis.sample_phi * x).eval();
      }
      const Eigen::Index column = 9 + design.first_state(c) + i;
      compare(column, gap(mechanise(start, corrected, c, error), base) / step, i == 0 ? 0.01 : 0.05);
      for (int j = 0; j < axis.states; ++j) {
        EXPECT_NEAR(phi(9 + design.first_state(c) + j, column), x(j) / step, 1e-12);
      }
    }
  }
}

/// Covariance of one step by the textbook: Phi P Phi^T + Q with everything dense.
TEST(NavigationFilter, StructuredStepIsTheDenseStep) {
  FilterSettings settings;
  settings.imu = rich_model();
  settings.covariance_samples = 20;
  const FilterDesign design = *FilterDesign::make(settings, kDt);
  NavigationFilter warm(design, start_state());
  const auto readings = manoeuvre(60);
  warm.advance(std::span(readings).first(40));  // two steps: P is full
  const Eigen::MatrixXd before = warm.covariance().dense();
  warm.advance(std::span(readings).subspan(40, 10));
  const Eigen::MatrixXd phi = warm.pending_transition();
  const Eigen::MatrixXd after = warm.covariance().dense();
  const Eigen::MatrixXd noise = after - phi * before * phi.transpose();
  // What remains is process noise: positive semidefinite up to rounding of P, and far below P.
  const Eigen::VectorXd scale = after.diagonal().cwiseSqrt().cwiseMax(1e-12).cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * noise * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (scaled + scaled.transpose()));
  EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-12);
  EXPECT_LT((noise - noise.transpose()).norm(), 1e-9);
}

TEST(NavigationFilter, ProcessNoiseOfAStepIsTheSumOverItsSamples) {
  // From a start that is known and without states that are not, P is the noise alone: one step of ten samples against
  // the sum over ten steps of one. Axes differ, so that a wrong direction shows.
  const auto noise_of = [](int covariance_samples) {
    FilterSettings settings;
    for (std::size_t c = 0; c < kImuChannels; ++c) {
      const double level = (c < 3 ? 1e-3 : 1e-2) * static_cast<double>(1 + c % 3);
      settings.imu.axes[c].processes =
          ModelSchedule::constant({process_of("white_noise", {level}), process_of("random_walk", {level})});
    }
    settings.initial = {{1e-9, 1e-9, 1e-9}, {1e-9, 1e-9, 1e-9}, 1e-9, 1e-9};
    settings.covariance_samples = covariance_samples;
    const FilterDesign design = *FilterDesign::make(settings, kDt);
    NavigationFilter filter(design, start_state());
    filter.advance(manoeuvre(10));
    return filter.covariance().dense();
  };
  const Eigen::MatrixXd coarse = noise_of(10);
  const Eigen::MatrixXd fine = noise_of(1);
  // White noise of 1, 2 and 3 levels through 0.1 s has this trace however the body turns.
  const double time = 10 * kDt;
  EXPECT_NEAR(fine.diagonal().segment<3>(6).sum(), 14e-6 * time, 0.01 * 14e-6 * time);
  EXPECT_NEAR(fine.diagonal().segment<3>(3).sum(), 14e-4 * time, 0.01 * 14e-4 * time);
  // The body turns by 0.1 rad within the step, which the mean of its axes holds up to the square: 0.1^2/12 of a level,
  // and a twelfth of 0.1 where a state's weight grows while the body turns. Against the largest of each block.
  for (Eigen::Index block = 0; block < coarse.rows(); block += 3) {
    const double size = fine.diagonal().segment<3>(block).maxCoeff();
    ASSERT_GT(size, 0.0);
    for (Eigen::Index i = block; i < block + 3; ++i) {
      EXPECT_NEAR(coarse(i, i), fine(i, i), 0.02 * size) << "state " << i;
    }
  }
}

void expect_healthy(const ErrorCovariance& covariance) {
  const Eigen::MatrixXd p = covariance.dense();
  EXPECT_EQ(p, p.transpose()) << "symmetric to the bit";
  const Eigen::VectorXd scale = p.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd correlation = scale.asDiagonal() * p * scale.asDiagonal();
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(correlation).eigenvalues().minCoeff(), 0.0);
}

TEST(NavigationFilter, CovarianceStaysSymmetricAndPositiveDefinite) {
  // The paper's drive, all fixes, then a receiver a thousand times better, which conditions P as badly as it gets.
  for (const double gnss_scale : {1.0, 1e-3}) {
    OutageScenario scenario = *paper_scenario("paper-nhc");
    scenario.gnss.position_sd_m *= gnss_scale;
    scenario.gnss.velocity_sd_m_s *= gnss_scale;
    const OutageExperiment experiment = *OutageExperiment::make(scenario);
    const Trajectory& truth = experiment.truth();
    const ImuRun imu = simulate_imu(truth.imu, truth.dt_s, scenario.truth, {}, 1, 0);
    Random random(1, 8);
    const auto fixes = simulate_gnss(truth, scenario.gnss, {}, random);
    NavigationFilter filter(experiment.design(2), truth.states.front());
    for (std::size_t k = 0; k < fixes.size(); ++k) {
      filter.advance(std::span(imu.readings).subspan(100 * k, 100));
      filter.update(fixes[k]);
      if (k % 60 == 59) {
        expect_healthy(filter.covariance());
      }
    }
  }
}

/// One minute: departure, a turn, two outages of 10 s; one filter that believes the truth.
OutageScenario matched_minute() {
  OutageScenario scenario = *paper_scenario("paper");
  scenario.name = "matched";
  scenario.drive.duration_s = 60.0;
  scenario.drive.segments = {
      {.kind = SegmentKind::Accelerate, .start_s = 2.0, .acceleration_m_s2 = 2.0, .until_speed_m_s = 15.0},
      {.kind = SegmentKind::Turn, .start_s = 20.0, .duration_s = 10.0, .rate_rad_s = 9.0 * kDegree},
      {.kind = SegmentKind::Turn, .start_s = 40.0, .duration_s = 5.0, .rate_rad_s = -18.0 * kDegree}};
  scenario.outages = {{20.0, 10.0}, {45.0, 10.0}};
  // M_dyn(GMWM) holds what the truth is made of; only the instant at which bands change differs, by one step.
  scenario.filters = {scenario.filters[2]};
  return scenario;
}

TEST(NavigationFilter, IsConsistentWithItsOwnModelOver200Runs) {
  const OutageScenario scenario = matched_minute();
  const OutageExperiment experiment = *OutageExperiment::make(scenario);
  double horizontal = 0.0;
  double all = 0.0;
  constexpr int kRuns = 200;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    horizontal += experiment.run(11, run, nullptr)[0][1].nees();
    // All nine navigation states at the end of the minute.
    const Trajectory& truth = experiment.truth();
    const ImuRun imu = simulate_imu(truth.imu, truth.dt_s, scenario.truth, {}, 12, run);
    Random gnss_random(12, 16 * run + 8);
    const auto fixes = simulate_gnss(truth, scenario.gnss, {}, gnss_random);
    Random random(12, 16 * run + 9);
    const InitialUncertainty& initial = scenario.initial;
    NavigationState start = truth.states.front();
    const Matrix3 axes = ned_axes(start.position_ecef_m);
    const auto draw = [&](const Vector3& sd) -> Vector3 {
      return axes * Vector3(sd.x() * random.normal(), sd.y() * random.normal(), sd.z() * random.normal());
    };
    start.position_ecef_m += draw(initial.position_sd_m);
    start.velocity_ecef_m_s += draw(initial.velocity_sd_m_s);
    start.attitude =
        rotation(draw({initial.tilt_sd_rad, initial.tilt_sd_rad, initial.heading_sd_rad})) * start.attitude;
    NavigationFilter filter(experiment.design(0), start);
    for (std::size_t k = 0; k < fixes.size(); ++k) {
      filter.advance(std::span(imu.readings).subspan(100 * k, 100));
      filter.update(fixes[k]);
    }
    const Eigen::Matrix<double, 9, 1> error = gap(truth.states.back(), filter.state());
    const Eigen::Matrix<double, 9, 9> p = filter.covariance().navigation();
    all += error.dot(p.ldlt().solve(error));
  }
  // Sums are chi-square with 200 x 2 and 200 x 9 degrees of freedom: 99 % bands n +- 2.576 sqrt(2 n).
  EXPECT_NEAR(horizontal, 400.0, 2.576 * std::sqrt(2.0 * 400.0));
  EXPECT_NEAR(all, 1800.0, 2.576 * std::sqrt(2.0 * 1800.0));
}

TEST(NavigationFilter, SlowCovarianceStepsLeaveTheFiguresAsTheyAre) {
  // Steps of 10 samples against steps of 1, on the hardest of the paper's drives. The errors of single outages differ
  // by far less than their own scatter of metres.
  OutageScenario scenario = *paper_scenario("paper-s-curves");
  scenario.drive.duration_s = 210.0;
  scenario.outages.resize(2);
  std::erase_if(scenario.drive.segments, [](const Segment& s) { return s.start_s > 210.0; });
  scenario.filters = {scenario.filters[2], scenario.filters[0]};
  OutageScenario fine = scenario;
  for (FilterCandidate& filter : fine.filters) {
    filter.settings.covariance_samples = 1;
  }
  const OutageExperiment slow = *OutageExperiment::make(scenario);
  const OutageExperiment fast = *OutageExperiment::make(fine);
  for (std::uint64_t run = 0; run < 3; ++run) {
    const auto a = slow.run(3, run, nullptr);
    const auto b = fast.run(3, run, nullptr);
    for (std::size_t f = 0; f < 2; ++f) {
      for (std::size_t o = 0; o < 2; ++o) {
        EXPECT_NEAR(a[f][o].error_m(), b[f][o].error_m(), 0.005 * std::sqrt(b[f][o].var_north + b[f][o].var_east));
        EXPECT_NEAR(a[f][o].var_north, b[f][o].var_north, 0.005 * b[f][o].var_north);
        EXPECT_NEAR(a[f][o].var_east, b[f][o].var_east, 0.005 * b[f][o].var_east);
      }
    }
  }
}

TEST(NavigationFilter, SwitchesWithTheReadingOfItsGyro) {
  const OutageExperiment experiment = *OutageExperiment::make(matched_minute());
  NavigationFilter filter(experiment.design(0), experiment.truth().states.front());
  std::vector<std::size_t> seen;
  for (std::size_t second = 0; second < 60; ++second) {
    filter.advance(std::span(experiment.truth().imu).subspan(100 * second, 100));
    seen.push_back(filter.band(2));
  }
  EXPECT_EQ(seen[15], 0U);
  EXPECT_EQ(seen[25], 1U);  // 9 deg/s
  EXPECT_EQ(seen[35], 0U);
  EXPECT_EQ(seen[42], 2U);  // -18 deg/s
  EXPECT_EQ(filter.band(0), 0U);
}

TEST(NavigationFilter, KnowsItsLeverArmAndLateFixes) {
  // A perfect unit, fixes of a centimetre, an antenna 3 m ahead and 2 m up, fixes 0.2 s late: an estimate that starts 3
  // m off comes to the truth; one that ignores the latency stays 15 m/s x 0.2 s behind.
  OutageScenario scenario = matched_minute();
  scenario.gnss.position_sd_m.setConstant(0.01);
  scenario.gnss.velocity_sd_m_s.setConstant(0.01);
  scenario.gnss.lever_arm_m = {3.0, 0.5, -2.0};
  scenario.gnss.latency_s = 0.2;
  const auto motion = *make_segment_motion(scenario.drive);
  const Trajectory truth = *make_trajectory(*motion, 100.0);
  Random random(2);
  const auto fixes = simulate_gnss(truth, scenario.gnss, {}, random);
  for (const bool compensate : {true, false}) {
    FilterSettings settings = scenario.filters[0].settings;
    settings.lever_arm_m = scenario.gnss.lever_arm_m;
    settings.compensate_latency = compensate;
    const FilterDesign design = *FilterDesign::make(settings, truth.dt_s);
    NavigationState start = truth.states.front();
    start.position_ecef_m += Vector3(2.0, -2.0, 1.0);
    NavigationFilter filter(design, start);
    std::size_t done = 0;
    for (const GnssFix& fix : fixes) {
      const auto arrival = static_cast<std::size_t>(std::llround(fix.arrival_s * 100.0));
      filter.advance(std::span(truth.imu).subspan(done, arrival - done));
      done = arrival;
      filter.update(fix);
    }
    const double error = error_of(filter.state(), truth.states[done]).position_ned_m.norm();
    if (compensate) {
      EXPECT_LT(error,
                0.2);  // 3.6 m of lever arm under a heading that fixes of an even drive leave open by a degree or two
    } else {
      EXPECT_GT(error, 1.0);
    }
  }
}

TEST(NavigationFilter, HoldsFlickerNoiseOnEveryGyroAndRefusesMore) {
  FilterSettings settings;
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    settings.imu.axes[c].bias_sd = 1e-3;
    settings.imu.axes[c].processes = ModelSchedule::constant({process_of("white_noise", {1e-4})});
  }
  for (std::size_t c = 0; c < 3; ++c) {
    settings.imu.axes[c].processes =
        ModelSchedule::constant({process_of("white_noise", {1e-4}), process_of("flicker_noise", {1e-4})});
  }
  const auto design = FilterDesign::make(settings, kDt);
  ASSERT_TRUE(design);
  EXPECT_EQ(design->sensor_states(), 3 * 17 + 3);
  NavigationFilter filter(*design, start_state());
  const auto readings = manoeuvre(200);
  filter.advance(std::span(readings));
  expect_healthy(filter.covariance());
  for (std::size_t c = 3; c < kImuChannels; ++c) {
    settings.imu.axes[c].processes = settings.imu.axes[0].processes;
  }
  EXPECT_EQ(FilterDesign::make(settings, kDt).error().code, ErrorCode::LimitExceeded);
  settings = {};
  settings.covariance_samples = 0;
  EXPECT_EQ(FilterDesign::make(settings, kDt).error().code, ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace driftlab
