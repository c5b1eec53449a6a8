// What causes of drives are made of, and the smoother's path. Hidden ones: drive_hidden_test.cpp; the laws of every
// one: drive_cause_laws_test.cpp.
#include "core/navigate/drive/motion_power.hpp"
#include "core/navigate/drive/profile.hpp"
#include "core/navigate/drive/smoother.hpp"
#include "tests/unit/navigate/drive_injections.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab::drive {
namespace {

const DriveFinding* found_in(const SearchResult& result, std::string_view cause, std::string_view parameter) {
  for (const DriveFinding& finding : result.findings) {
    if (finding.cause == cause && finding.parameter == parameter) {
      return &finding;
    }
  }
  return nullptr;
}

std::string names_of(const SearchResult& result) {
  std::string names;
  for (const DriveFinding& finding : result.findings) {
    names += finding.cause + " " + finding.parameter + ", ";
  }
  return names;
}

SearchResult searched(const Drive& drive, FilterOptions options = {}) {
  auto result = search_causes(drive, options, 4);
  EXPECT_TRUE(result) << result.error().message;
  return result ? *result : SearchResult{};
}

TEST(DriveCauses, AreCalledByTheirParameterWhereTheyHaveSeveral) {
  EXPECT_EQ(words_of(*find_knob("gnss_velocity_latency", "delay_s")), "late velocities of fixes");
  EXPECT_EQ(words_of(*find_knob("gnss_coloured_noise", "tau_s")), "lasting errors of positions (tau)");
}

TEST(DriveCauses, AValueWhereTheSearchEndsIsSaidToBeOne) {
  // A phone's gyroscope was said to read 49 % too much. Refits walked there in strides that were each allowed.
  Hidden hidden;
  hidden.errors.gyroscope(2, 2) = 0.45;
  const SearchResult result = searched(simulated_drive(31, hidden));
  const DriveFinding* const scale = found_in(result, "gyro_scale_factor_error", "z");
  ASSERT_NE(scale, nullptr) << names_of(result);
  EXPECT_LE(std::abs(scale->value), 30.0 + 1e-9);
  EXPECT_TRUE(scale->at_bound) << scale->value;
  hidden.errors.gyroscope(2, 2) = 0.02;
  const SearchResult small = searched(simulated_drive(31, hidden));
  const DriveFinding* const usual = found_in(small, "gyro_scale_factor_error", "z");
  ASSERT_NE(usual, nullptr) << names_of(small);
  EXPECT_FALSE(usual->at_bound) << usual->value;
}

TEST(DriveCauses, TheBoundIsOnWhatTheDocumentDoesNotSay) {
  // A stated latency of 3 s was pulled to the 2 s at which the search ended, and everything after it was fitted on
  // that.
  Hidden hidden;
  hidden.velocity_latency_s = 3.05;
  Drive drive = simulated_drive(31, hidden);
  drive.document.gnss.velocity_latency_s = 3.0;
  const SearchResult result = searched(drive, options_of(drive.document));
  const DriveFinding* const late = found_in(result, "gnss_velocity_latency", "delay_s");
  ASSERT_NE(late, nullptr) << names_of(result);
  EXPECT_NEAR(late->value, 3.05, 0.01);
  EXPECT_FALSE(late->at_bound);
}

TEST(DriveCauses, AQuietAxisHasNoScaleFactor) {
  // A phone's gyroscope was said to read 30 to 49 % too much about an axis that hardly turned. There a smaller reading
  // is a better one, whatever the scale: on a flat road, where the gyroscope turns about down alone, 30 % about y raise
  // the log likelihood by 16, and by more where the filter believes the noise to stay as it was.
  const Drive drive = simulated_drive(33);
  const RunControl control;
  const Profile profile(drive, {true, true}, control);
  const FilterOptions none;
  const double at = profile.values({none}).front();
  FilterOptions quieter;
  quieter.errors.gyroscope(1, 1) = 0.3;
  EXPECT_GT(profile.values({quieter}).front(), at + 5.0);
  const Knob* const flat = find_knob("gyro_scale_factor_error", "y");
  const Knob* const turned = find_knob("gyro_scale_factor_error", "z");
  const auto estimates = profile.estimates(none, at, {flat, turned}, profile.scale(none));
  EXPECT_GT(estimates[0].se, 0.2);
  EXPECT_LT(estimates[1].se, 0.01);
  EXPECT_DOUBLE_EQ(noise_after_correction(none.errors, 1), 1.0);
  ReadingErrors errors;
  errors.gyroscope(1, 1) = 0.25;
  EXPECT_DOUBLE_EQ(noise_after_correction(errors, 1), 0.8);
  EXPECT_DOUBLE_EQ(noise_after_correction(errors, 2), 1.0);
  EXPECT_DOUBLE_EQ(noise_after_correction(errors, 4), 1.0);
}

TEST(DriveCauses, AShareEndsWhereItIsTheWhole) {
  // The noise that follows the vibration was told over the rest: 96.9 +- 109 of an accelerometer for which 5 was
  // hidden, under one compiler, and 5 under another. The likelihood hardly falls towards a ratio without end. Of the
  // share that is the end of what can be, and not doubtful.
  const Drive drive = shaken_drive(36, 1000.0, 3, 0);
  for (const Knob& knob : all_knobs()) {
    EXPECT_EQ(knob.share, knob.cause == "vibration_noise" || knob.cause == "gnss_velocity_averaging") << words_of(knob);
  }
  const SearchResult result = searched(drive);
  const DriveFinding* const found = found_in(result, "vibration_noise", "gyroscope");
  ASSERT_NE(found, nullptr) << names_of(result);
  EXPECT_GT(found->value, 90.0);
  EXPECT_LE(found->value, 100.0);
  EXPECT_GT(found->value, 3.0 * found->se);
  EXPECT_FALSE(found->at_bound);
}

TEST(DriveCauses, MotionAndNoiseOfAChannelAreToldApart) {
  Drive drive = simulated_drive(35);
  const double noise = 0.02 * kDegree;
  const MotionPower down = motion_power(drive, {}, 2, 1.0);
  EXPECT_DOUBLE_EQ(down.noise, noise * noise);
  EXPECT_GT(down.motion, 1e3 * down.noise);
  Random random(35);
  for (ImuSample& sample : drive.runs.front().readings) {
    sample[2] = 0.3 + noise / std::sqrt(drive.runs.front().dt_s) * random.normal();
  }
  const MotionPower still = motion_power(drive, {}, 2, 1.0);
  EXPECT_LT(still.motion, 0.3 * still.noise);
  FilterOptions doubled;
  doubled.gyro_noise = 2.0;
  EXPECT_EQ(motion_power(drive, doubled, 2, 1.0).motion, 0.0);
  EXPECT_TRUE(std::isinf(scale_of_noise(drive, doubled, 2)));
}

TEST(DriveCauses, LevelsOfTheNoiseEndAtTheTopOfTheLikelihood) {
  // Steps that end where the next is 3 % leave the level up to 3 % off; the vertex of a parabola is nearer, from afar
  // and from nearby.
  Hidden loud;
  loud.noise_factor = 4.0;
  const Drive drive = simulated_drive(37, loud);
  const RunControl control;
  const Profile profile(drive, {true, true}, control);
  FilterOptions nearby;
  nearby.gyro_noise = 3.5;
  for (const auto& [start, first_factor] : {std::pair{FilterOptions{}, 4.0}, std::pair{nearby, 1.2}}) {
    const FilterOptions fitted = profile.with_noise_fitted(start, first_factor);
    EXPECT_NEAR(fitted.gyro_noise, 4.0, 0.6);
    const double top = profile.values({fitted}).front();
    for (const double factor : {0.98, 1.02}) {
      FilterOptions beside = fitted;
      beside.gyro_noise *= factor;
      EXPECT_LT(profile.values({beside}).front(), top) << factor << " from steps by " << first_factor;
    }
  }
}

TEST(DriveCauses, TheArmDownIsNotSoughtOnAFlatRoad) {
  // Read from the gyroscope's noise it was 1.1 m too high, with a score above 5, on three of eight drives of seeds 71
  // to 78 with four times the noise.
  const Knob& down = *find_knob("gnss_lever_arm", "z");
  Hidden loud;
  loud.noise_factor = 4.0;
  FilterOptions told;
  told.gyro_noise = 4.0;
  const RunControl control;
  for (const std::uint64_t seed : {71U, 72U, 73U}) {
    const Drive flat = simulated_drive(seed, loud);
    const Profile profile(flat, {true, true}, control);
    const double at = profile.values({told}).front();
    EXPECT_NEAR(profile.estimates(told, at, {&down}, profile.scale(told)).front().value, -0.9, 0.5) << seed;
    EXPECT_FALSE(down.applies(flat, told));
  }
  Drive drive = simulated_drive(34);
  EXPECT_FALSE(down.applies(drive, {}));
  UniformRun& run = drive.runs.front();
  for (std::size_t i = 0; i < run.readings.size(); ++i) {
    run.readings[i][1] += 2.0 * kDegree * std::sin(0.02 * static_cast<double>(i));
  }
  EXPECT_TRUE(down.applies(drive, {}));
}

TEST(DriveCauses, VibrationSaysWhenThereIsNoise) {
  std::vector<ImuSample> readings(4000);
  Random random(33);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double size = i < 2000 ? 1.0 : 3.0;
    readings[i] = {size * random.normal(), random.normal(), std::sin(0.01 * static_cast<double>(i)), 0.0, 0.0, -9.8};
  }
  const Vibration vibration(readings, 0.01);
  double calm = 0.0;
  double shaken = 0.0;
  for (std::size_t i = 0; i < 2000; i += 50) {
    calm += vibration.at(i)[0] / 40.0;
    shaken += vibration.at(i + 2000)[0] / 40.0;
  }
  EXPECT_NEAR(shaken / calm, 9.0, 1.5);
  EXPECT_NEAR(0.5 * (calm + shaken), 1.0, 1e-9);
  EXPECT_EQ(vibration.from(2000).at(0), vibration.at(2000));
}

TEST(DriveFilter, KnowsItselfUnderLastingErrorsThatItEstimates) {
  const Drive drive = with_lasting_errors(35, 0.5, 20.0, 6);
  FilterOptions options;
  options.coloured = {0.5, 20.0};
  const auto with = PreparedDrive::make(drive, options);
  const auto without = PreparedDrive::make(drive, {});
  ASSERT_TRUE(with && without);
  FilterTask task;
  task.keep_innovations = true;
  const auto mean_square = [&](const PreparedDrive& prepared) {
    double sum = 0.0;
    double count = 0.0;
    for (const Innovation& one : prepared.run(0, task).innovations) {
      if (one.kind == MeasurementKind::Position && one.time_s > 60.0) {
        sum += one.scalar[0].value * one.scalar[0].value / one.scalar[0].variance;
        count += 1.0;
      }
    }
    return sum / count;
  };
  EXPECT_NEAR(mean_square(*with), 1.0, 0.12);
  EXPECT_GT(mean_square(*without), 1.3);
}

TEST(DriveCauses, TellsASlipFromAScaleOfTheOdometer) {
  Drive drive = simulated_drive(37);
  for (const Fix& fix : drive.fixes) {
    const double speed = fix.velocity_ned_m_s->head<2>().norm();
    const bool slips = fix.time_s > 140.0 && fix.time_s < 143.0;
    drive.odometer.push_back({fix.time_s, 1.03 * speed + (slips ? 2.0 : 0.0)});
  }
  const auto found = slips_of(drive, 0.0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->scale, 0.03, 0.002);
  ASSERT_EQ(found->slips.size(), 1U);
  EXPECT_NEAR(found->slips.front()[0], 140.0, 1.0);
  EXPECT_NEAR(found->slips.front()[1], 143.0, 1.0);
  for (OdometerReading& reading : drive.odometer) {
    reading.speed_m_s *= 1.1;
  }
  EXPECT_NEAR(slips_of(drive, 0.0)->scale, 0.133, 0.003);
  drive.odometer.resize(20);
  EXPECT_FALSE(slips_of(drive, 0.0));
}

/// Errors of a path of points against the truth of the fixture.
struct PathErrors {
  double rms_m = 0.0, nees = 0.0;
};

PathErrors errors_of(const std::vector<FilterTape::Point>& path, const Trajectory& truth, double from_s, double to_s) {
  PathErrors errors;
  double count = 0.0;
  for (const FilterTape::Point& point : path) {
    if (point.time_s < from_s || point.time_s > to_s) {
      continue;
    }
    const auto i = static_cast<std::size_t>(std::lround(point.time_s / truth.dt_s));
    const Vector3 error = point.state.position_ecef_m - truth.states[i].position_ecef_m;
    errors.rms_m += error.squaredNorm();
    errors.nees += error.dot(point.covariance.topLeftCorner<3, 3>().ldlt().solve(error));
    count += 1.0;
  }
  errors.rms_m = std::sqrt(errors.rms_m / count);
  errors.nees /= count;
  return errors;
}

TEST(DriveSmoother, BridgesAGapFromBothSidesAndKnowsHowWell) {
  Drive drive = simulated_drive(38, {}, 6);
  std::erase_if(drive.fixes, [](const Fix& fix) { return fix.time_s > 200.0 && fix.time_s < 230.0; });
  const auto prepared = PreparedDrive::make(drive, {});
  ASSERT_TRUE(prepared);
  const auto path = smoothed_path(*prepared);
  ASSERT_GT(path.size(), 4000U);
  const auto motion = make_segment_motion(town_plan(6));
  const auto truth = make_trajectory(**motion, 100.0);
  ASSERT_TRUE(truth);
  FilterTask task;
  task.outages = {{200.0, 30.0}};
  const double at_the_end = prepared->run(0, task).outages.front().error_m();
  const PathErrors gap = errors_of(path, *truth, 205.0, 225.0);
  EXPECT_LT(gap.rms_m, 0.5 * at_the_end);
  const PathErrors whole = errors_of(path, *truth, 60.0, 600.0);
  EXPECT_LT(whole.nees, 6.0);  // 3 where everything is right; one drive's errors last
  EXPECT_GT(whole.nees, 1.0);
  const PathErrors fixed = errors_of(path, *truth, 300.0, 600.0);
  EXPECT_LT(fixed.rms_m, 0.02 * std::sqrt(3.0)) << "better than the fixes";
}

TEST(DriveSmoother, HasAPointEveryTenthOfASecondAtAnyRate) {
  // Steps of nine readings are half a second of a unit at 20 Hz.
  for (const double rate_hz : {10.0, 20.0, 100.0}) {
    Hidden hidden;
    hidden.rate_hz = rate_hz;
    const Drive drive = simulated_drive(41, hidden, 1);
    const auto prepared = PreparedDrive::make(drive, {});
    ASSERT_TRUE(prepared);
    const auto path = smoothed_path(*prepared);
    ASSERT_GT(path.size(), 600U);
    for (std::size_t i = 1; i < path.size(); ++i) {
      EXPECT_LT(path[i].time_s - path[i - 1].time_s, 0.17) << rate_hz << " Hz at " << path[i].time_s;
    }
  }
}

TEST(DriveSmoother, IsAReferenceWithANote) {
  const auto drive = with_smoothed_reference(simulated_drive(39), {});
  ASSERT_TRUE(drive) << drive.error().message;
  EXPECT_FALSE(drive->withheld_fixes);
  EXPECT_GT(drive->reference.size(), 3000U);
  EXPECT_LT(drive->document.reference.sd_m, 0.02);
  EXPECT_FALSE(drive->facts.notes.empty());
  const auto evaluation = evaluate_drive(*drive, {});
  ASSERT_TRUE(evaluation) << evaluation.error().message;
  EXPECT_NEAR(evaluation->durations.front().nees.value, 2.0, 0.8);
}

}  // namespace
}  // namespace driftlab::drive
