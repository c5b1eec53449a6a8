// Recorded drives: even readings out of stamped rows, dated fixes, outages that leave no trace, and what is refused.
#include "core/navigate/drive/evaluation.hpp"
#include "tests/unit/navigate/drive_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab::drive {
namespace {

ImuSample noisy(Random& random, double turn = 0.0) {
  return {0.01 * random.normal(), 0.01 * random.normal(), turn + 0.01 * random.normal(),
          0.1 * random.normal(),  0.1 * random.normal(),  -9.8 + 0.1 * random.normal()};
}

/// A sensor at 97.9 Hz that a computer asks at 100 Hz, for `seconds`.
SensorLog polled(double seconds) {
  Random random(3);
  std::vector<ImuSample> own;
  for (int i = 0; i < static_cast<int>(seconds * 97.9) + 2; ++i) {
    own.push_back(noisy(random, std::sin(0.01 * i)));
  }
  SensorLog log;
  for (int i = 0; i < static_cast<int>(seconds * 100.0); ++i) {
    log.time_s.push_back(0.01 * i);
    log.readings.push_back(own[static_cast<std::size_t>(97.9 * 0.01 * i)]);
  }
  return log;
}

TEST(DriveSampling, DropsWhatAFasterPollRepeatsAndFindsTheSensorsRate) {
  SamplingFacts facts;
  const auto runs = uniform_readings(polled(200.0), {SensorClock::Host, true}, facts);
  ASSERT_TRUE(runs) << runs.error().message;
  EXPECT_TRUE(facts.polled_faster);
  EXPECT_NEAR(static_cast<double>(facts.repeated) / static_cast<double>(facts.rows), 0.021, 0.001);
  EXPECT_NEAR(facts.sensor_rate_hz, 97.9, 0.02);
  ASSERT_EQ(runs->size(), 1U);
  EXPECT_EQ(runs->front().readings.size(), facts.rows - facts.repeated);
  EXPECT_NEAR(1.0 / runs->front().dt_s, 97.9, 0.02);
}

TEST(DriveSampling, KeepsTheRowsOfAStuckSensorAndCountsThem) {
  Random random(4);
  SensorLog log;
  ImuSample held = noisy(random);
  for (int i = 0; i < 5000; ++i) {
    held = i >= 1000 && i < 1200 ? held : noisy(random);
    log.time_s.push_back(0.01 * i);
    log.readings.push_back(held);
  }
  SamplingFacts facts;
  const auto runs = uniform_readings(log, {SensorClock::Sensor, true}, facts);
  ASSERT_TRUE(runs);
  EXPECT_FALSE(facts.polled_faster);
  EXPECT_EQ(facts.stuck, 200U);
  EXPECT_EQ(runs->front().readings.size(), 5000U);
}

TEST(DriveSampling, LosesNoAngleBetweenJitteringStampsAndTheEvenGrid) {
  // Each reading is the mean since the stamp before; the angle over the whole log is the same after resampling.
  Random random(5);
  SensorLog log;
  double angle = 0.0;
  double before = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double now = 0.01 * i + 0.002 * random.uniform();
    log.time_s.push_back(now);
    log.readings.push_back(noisy(random, 0.5));
    angle += i == 0 ? 0.0 : log.readings.back()[2] * (now - before);
    before = now;
  }
  SamplingFacts facts;
  const auto runs = uniform_readings(log, {SensorClock::Sensor, true}, facts);
  ASSERT_TRUE(runs);
  double resampled = 0.0;
  const UniformRun& run = runs->front();
  for (std::size_t i = 1; i < run.readings.size(); ++i) {
    resampled += run.readings[i][2] * run.dt_s;
  }
  EXPECT_NEAR(resampled, angle, 1e-9);
}

TEST(DriveSampling, BridgesThreeMissingSamplesAndSplitsAtMore) {
  Random random(6);
  SensorLog log;
  for (int i = 0; i < 3000; ++i) {
    const bool lost = (i > 500 && i < 504) || (i > 1500 && i < 1600);
    if (!lost) {
      log.time_s.push_back(0.01 * i);
      log.readings.push_back(noisy(random));
    }
  }
  SamplingFacts facts;
  const auto runs = uniform_readings(log, {SensorClock::Sensor, true}, facts);
  ASSERT_TRUE(runs);
  EXPECT_EQ(facts.gaps_bridged, 1U);
  EXPECT_EQ(facts.samples_bridged, 3U);
  EXPECT_EQ(facts.gaps_splitting, 1U);
  ASSERT_EQ(runs->size(), 2U);
  EXPECT_NEAR((*runs)[1].start_s, 15.99, 1e-9);
}

TEST(DriveTime, DatesUtcOnceAndGoesOnOverTheEndOfAWeek) {
  Table table{{"t"}, {{1751999658.0, 1751999659.0, 1751999660.0}}, {}, {}};
  TimeMeaning meaning{"t", 1.0, false, TimeScale::Utc, 0.0, {}, ""};
  const auto utc = stamp_rows(table, meaning);
  ASSERT_TRUE(utc);
  EXPECT_DOUBLE_EQ(utc->time_s.front(), 1751999658.0 + 18.0);
  table.columns = {{604799.0, 604799.5, 0.0, 0.5}};
  meaning.scale = TimeScale::Gps;
  const auto week = stamp_rows(table, meaning);
  ASSERT_TRUE(week);
  EXPECT_EQ(week->facts.week_rollovers, 1U);
  EXPECT_DOUBLE_EQ(week->time_s.back(), 604800.5);
}

TEST(DriveTime, GoesOnOverALeapSecond) {
  // The last second of 2016 was counted twice. By the leap seconds of the first row alone, half a drive was 1 s off.
  constexpr double kNewDay = 1483228800.0;
  TimeMeaning meaning{"t", 1.0, false, TimeScale::Utc, 0.0, {}, ""};
  const auto gps = [&](std::vector<double> utc) {
    const auto stamped = stamp_rows(Table{{"t"}, {std::move(utc)}, {}, {}}, meaning);
    EXPECT_TRUE(stamped && stamped->facts.leap_within);
    std::vector<double> since;
    for (const double time_s : stamped->time_s) {
      since.push_back(time_s - kNewDay - 17.0);
    }
    return since;
  };
  const std::vector<double> truth{-1.0, -0.5, 0.0, 0.5, 1.0, 1.5};
  EXPECT_EQ(gps({kNewDay - 1.0, kNewDay - 0.5, kNewDay, kNewDay + 0.5, kNewDay, kNewDay + 0.5}), truth)
      << "the first second of the new day twice, as POSIX has it";
  EXPECT_EQ(gps({kNewDay - 1.0, kNewDay - 0.5, kNewDay - 1.0, kNewDay - 0.5, kNewDay, kNewDay + 0.5}), truth)
      << "the last second of the old day twice, as computers count";
  EXPECT_EQ(gps({kNewDay - 1.0, kNewDay, kNewDay, kNewDay + 1.0}), (std::vector<double>{-1.0, 0.0, 1.0, 2.0}))
      << "rows once a second";
  EXPECT_EQ(gps({kNewDay - 1.0, kNewDay - 0.5, kNewDay + 0.5}), (std::vector<double>{-1.0, -0.5, 1.5}))
      << "no row in the second";
}

/// The drive without the fixes that lie in an outage.
Drive without_fixes_in(const Drive& drive, const std::vector<Outage>& outages) {
  Drive fewer = drive;
  std::erase_if(fewer.fixes, [&](const Fix& fix) {
    return std::any_of(outages.begin(), outages.end(), [&](const Outage& o) { return o.covers(fix.time_s); });
  });
  return fewer;
}

TEST(DriveFilter, AFixInsideAnOutageLeavesNoTrace) {
  const Drive drive = simulated_drive(11, {.velocity_latency_s = 0.12});
  FilterOptions options;
  options.velocity_latency_s = 0.12;  // the first returning fix describes a velocity of the outage
  options.constraint.emplace();
  options.gate = 25.0;
  const auto prepared = PreparedDrive::make(drive, options);
  ASSERT_TRUE(prepared) << prepared.error().message;
  FilterTask task;
  task.outages = {{100.0, 10.0}, {160.0, 30.0}};
  const FilterRun all = prepared->run(0, task);
  const Drive fewer = without_fixes_in(drive, task.outages);
  const auto prepared_fewer = PreparedDrive::make(fewer, options);
  ASSERT_TRUE(prepared_fewer);
  const FilterRun some = prepared_fewer->run(0, task);
  ASSERT_EQ(all.outages.size(), 2U);
  ASSERT_EQ(some.outages.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(all.outages[i].error_ned_m, some.outages[i].error_ned_m);
    EXPECT_EQ(all.outages[i].covariance_ned, some.outages[i].covariance_ned);
  }
}

TEST(DriveFilter, KnowsItselfOnADriveOfItsOwnModel) {
  // 64 outages of 10 s, eight phases: 2 for the mean NEES within 0.7 (neighbours share most of their noise).
  const Drive drive = simulated_drive(12, {}, 6);
  const auto evaluation = evaluate_drive(drive, options_of(drive.document));
  ASSERT_TRUE(evaluation) << evaluation.error().message;
  const DurationSummary& ten = evaluation->durations.front();
  EXPECT_GT(ten.outages.size(), 60U);
  EXPECT_NEAR(ten.nees.value, 2.0, 0.7);
  EXPECT_GT(ten.coverage95.value, 0.88);
  EXPECT_LT(ten.rms_m.value, ten.straight_line_rms_m);
  ASSERT_GE(evaluation->innovations.size(), 2U);
  EXPECT_NEAR(evaluation->innovations[0].normalised, 1.0, 0.15);
}

TEST(DriveFilter, EstimatesTheArmAndSaysHowWell) {
  const Drive drive = simulated_drive(13, {.lever_arm_m = {0.8, -0.4, 0.0}});
  FilterOptions options;
  Document document = drive.document;
  document.gnss.lever_arm_sd_m = 1.0;
  options.constants = declared_states(document, options);
  const auto prepared = PreparedDrive::make(drive, options);
  ASSERT_TRUE(prepared);
  FilterTask task;
  task.outages = {{300.0, 10.0}};
  const FilterRun with = prepared->run(0, task);
  const auto unaware = PreparedDrive::make(drive, FilterOptions{});
  ASSERT_TRUE(unaware);
  const FilterRun without = unaware->run(0, task);
  EXPECT_LT(with.outages.front().error_m(), without.outages.front().error_m());
}

TEST(DriveFilter, RejectsAWildFixAndBelievesTheReceiverAgainAfterFive) {
  Drive drive = simulated_drive(14);
  for (Fix& fix : drive.fixes) {
    if (fix.time_s > 120.0 && fix.time_s < 120.5) {
      fix.position_ecef_m += Vector3(0.0, 50.0, 0.0);
    }
  }
  FilterOptions options;
  options.gate = 50.0;
  const auto prepared = PreparedDrive::make(drive, options);
  ASSERT_TRUE(prepared);
  EXPECT_EQ(prepared->run(0, {}).rejected, 2U);
  for (Fix& fix : drive.fixes) {
    if (fix.time_s > 200.0) {
      fix.position_ecef_m += Vector3(0.0, 50.0, 0.0);  // the receiver moves for good
    }
  }
  const auto moved = PreparedDrive::make(drive, options);
  ASSERT_TRUE(moved);
  EXPECT_LT(moved->run(0, {}).rejected, 40U);
}

TEST(DriveOutages, NeverOverlapAndLeaveTwentySecondsOfFixes) {
  const Drive drive = simulated_drive(15);
  const auto start = find_start(drive, 0);
  ASSERT_TRUE(start);
  const auto runs = plan_outages(drive, *start);
  EXPECT_GT(runs.size(), 16U);
  for (const PlannedRun& run : runs) {
    for (std::size_t i = 1; i < run.outages.size(); ++i) {
      EXPECT_GE(run.outages[i].start_s, run.outages[i - 1].end_s() + 20.0);
    }
    EXPECT_GE(run.outages.front().start_s, start->time_s + 60.0);
  }
}

TEST(DriveOutages, TheErrorIsFollowedFromTheLossOfTheFixesToTheirReturn) {
  // Its end alone does not say whether an outage is ruled by an error of velocity or of the gyroscope.
  const Drive drive = simulated_drive(23);
  const auto evaluation = evaluate_drive(drive, {});
  ASSERT_TRUE(evaluation);
  for (const DurationSummary& one : evaluation->durations) {
    const ErrorGrowth& growth = one.growth;
    ASSERT_EQ(growth.time_s.size(), kGrowthPoints);
    EXPECT_DOUBLE_EQ(growth.time_s.front(), one.duration_s / static_cast<double>(kGrowthPoints));
    EXPECT_DOUBLE_EQ(growth.time_s.back(), one.duration_s);
    EXPECT_EQ(growth.count.back(), one.outages.size());
    EXPECT_DOUBLE_EQ(growth.rms_m.back(), one.rms_m.value);
    EXPECT_DOUBLE_EQ(growth.median_m.back(), one.median_m.value);
    EXPECT_DOUBLE_EQ(growth.p95_m.back(), one.p95_m);
    for (std::size_t k = 0; k < kGrowthPoints; ++k) {
      EXPECT_LE(growth.p05_m[k], growth.median_m[k]);
      EXPECT_LE(growth.median_m[k], growth.p95_m[k]);
    }
    EXPECT_LT(growth.rms_m[kGrowthPoints / 2 - 1], 0.6 * growth.rms_m.back()) << "faster than the time";
    for (const DriveOutage& outage : one.outages) {
      EXPECT_EQ(outage.growth_m.size(), kGrowthPoints);
    }
  }
}

TEST(DriveOutages, AGapOfTheReferenceIsNoErrorOfZero) {
  Drive drive = simulated_drive(24);
  const auto before = evaluate_drive(drive, {});
  ASSERT_TRUE(before);
  const DriveOutage& first = before->durations.back().outages.front();
  const double middle = first.outage.start_s + 0.5 * first.outage.duration_s;
  std::erase_if(drive.reference, [&](const ReferencePoint& point) { return std::abs(point.time_s - middle) < 4.0; });
  const auto after = evaluate_drive(drive, {});
  ASSERT_TRUE(after);
  const DriveOutage& gappy = after->durations.back().outages.front();
  ASSERT_EQ(gappy.growth_m.size(), kGrowthPoints);
  EXPECT_TRUE(std::isnan(gappy.growth_m[kGrowthPoints / 2 - 1]));
  EXPECT_EQ(gappy.growth_m.front(), first.growth_m.front());
  EXPECT_LT(after->durations.back().growth.count[kGrowthPoints / 2 - 1], after->durations.back().growth.count.back());
}

TEST(DriveOutages, ThoseOfTheReceiverItselfAreListedAndNotScored) {
  Drive drive = simulated_drive(28);
  const auto whole = evaluate_drive(drive, {});
  ASSERT_TRUE(whole);
  EXPECT_TRUE(whole->natural.empty());
  const auto lost = [](double time_s) { return time_s > 200.1 && time_s < 207.2; };
  std::erase_if(drive.fixes, [&](const Fix& fix) { return lost(fix.time_s); });
  std::erase_if(drive.reference, [&](const ReferencePoint& point) { return lost(point.time_s); });
  const auto evaluation = evaluate_drive(drive, {});
  ASSERT_TRUE(evaluation);
  ASSERT_EQ(evaluation->natural.size(), 1U);
  EXPECT_NEAR(evaluation->natural.front().start_s, 200.0037, 1e-9);
  EXPECT_NEAR(evaluation->natural.front().duration_s, 7.25, 1e-9);
  const auto ends_in_it = [](const DriveOutage& one) {
    return std::min(std::abs(one.outage.start_s - 203.6), std::abs(one.outage.end_s() - 203.6)) < 2.0;
  };
  for (const DurationSummary& one : evaluation->durations) {
    EXPECT_EQ(std::count_if(one.outages.begin(), one.outages.end(), ends_in_it), 0) << "no reference lies at its end";
  }
}

TEST(DriveOutages, StatedStartsThatAreNotScoredAreNamed) {
  Drive drive = simulated_drive(29);
  drive.document.outages.duration_s = {10.0};
  drive.document.outages.at_s = {5.0, 100.0, 115.0, 200.0};
  const auto evaluation = evaluate_drive(drive, {});
  ASSERT_TRUE(evaluation);
  EXPECT_EQ(evaluation->durations.front().outages.size(), 2U);
  ASSERT_FALSE(evaluation->notes.empty());
  EXPECT_NE(evaluation->notes.front().find("outages of 10 s from 5 s, 10 s from 115 s."), std::string::npos)
      << evaluation->notes.front();
}

TEST(DriveOutages, ClassesAreByTheMotionWithoutFixes) {
  Drive drive = simulated_drive(30);
  drive.document.outages.duration_s = {4.0};
  drive.document.outages.at_s = {132.5, 213.0, 241.0};  // a turn of 12 deg/s; standing; straight on
  const auto evaluation = evaluate_drive(drive, {});
  ASSERT_TRUE(evaluation);
  const DurationSummary& summary = evaluation->durations.front();
  ASSERT_EQ(summary.outages.size(), 3U);
  EXPECT_EQ(summary.outages[0].outage_class, OutageClass::Turning);
  EXPECT_EQ(summary.outages[1].outage_class, OutageClass::Rest);
  EXPECT_EQ(summary.outages[2].outage_class, OutageClass::Straight);
  ASSERT_EQ(summary.classes.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(summary.classes[i].count, 1U);
  }
}

TEST(DriveOutages, TheSameForAnyNumberOfThreads) {
  const Drive drive = simulated_drive(16);
  Executor executor(2);
  RunControl control;
  control.threads.executor = &executor;
  const auto one = evaluate_drive(drive, {});
  const auto two = evaluate_drive(drive, {}, {}, control);
  ASSERT_TRUE(one && two);
  for (std::size_t d = 0; d < one->durations.size(); ++d) {
    EXPECT_EQ(one->durations[d].rms_m.value, two->durations[d].rms_m.value);
    EXPECT_EQ(one->durations[d].nees.ci95.high, two->durations[d].nees.ci95.high);
  }
}

TEST(DriveStart, FindsRestTiltAndCourse) {
  const Drive drive = simulated_drive(17);
  const auto rests = rests_of(drive, 0);
  ASSERT_FALSE(rests.empty());
  EXPECT_NEAR(rests.front().to_s, 20.0, 1.0);
  const auto start = find_start(drive, 0);
  ASSERT_TRUE(start);
  EXPECT_EQ(start->tilt_from, TiltFrom::Rest);
  EXPECT_EQ(start->heading_from, HeadingFrom::Course);
  EXPECT_NEAR(start->time_s, 21.6, 0.6);
}

/// A drive whose readings begin where it gains speed by 2 m/s^2, so that no rest shows the tilt.
Drive begun_in_motion(std::uint64_t seed) {
  Drive drive = simulated_drive(seed);
  UniformRun& run = drive.runs.front();
  const auto first = static_cast<std::ptrdiff_t>(std::lround(21.0 / run.dt_s));
  run.readings.erase(run.readings.begin(), run.readings.begin() + first);
  run.start_s += static_cast<double>(first) * run.dt_s;
  return drive;
}

TEST(DriveStart, ChangesOfSpeedAreNoTilt) {
  // Over one second of 2 m/s^2 the mean force leans by 12 deg, stated as 3.
  const Drive drive = begun_in_motion(25);
  const auto start = find_start(drive, 0);
  ASSERT_TRUE(start) << start.error().message;
  EXPECT_EQ(start->tilt_from, TiltFrom::Motion);
  EXPECT_NEAR(start->attitude().pitch_rad, 0.0, 2.0 * kDegree);
  EXPECT_NEAR(start->attitude().roll_rad, 0.0, 2.0 * kDegree);
  EXPECT_NEAR(start->uncertainty.tilt_sd_rad, std::hypot(3.0, 5.8) * kDegree, 1.5 * kDegree) << "half of 12 deg";
  Drive silent = drive;
  for (Fix& fix : silent.fixes) {
    fix.has_course = false;
    fix.velocity_ned_m_s.reset();
  }
  silent.document.start.heading_rad = 0.0;
  const auto leaning = find_start(silent, 0);
  ASSERT_TRUE(leaning);
  EXPECT_GT(std::abs(leaning->attitude().pitch_rad), 8.0 * kDegree) << "else the test shows nothing";
}

TEST(DriveStart, WhatTheDocumentStatesIsTrueOfTheBeginningAlone) {
  // A stated place was taken for that of the first fast fix, a minute later, and of every run behind a gap.
  Drive drive = simulated_drive(26);
  const Geodetic elsewhere{48.1 * kDegree, 9.0 * kDegree, 300.0};
  drive.document.start.position = elsewhere;
  const auto late = find_start(drive, 0);
  ASSERT_TRUE(late);
  EXPECT_GT((late->state.position_ecef_m - to_ecef(elsewhere)).norm(), 5000.0) << "it starts after 21 s";
  drive.document.start.heading_rad = 0.3;
  drive.document.start.velocity_ned_m_s = Vector3(0.5, 0.0, 0.0);
  const auto first = find_start(drive, 0);
  ASSERT_TRUE(first);
  EXPECT_LT(first->time_s, 2.0);
  EXPECT_LT((first->state.position_ecef_m - to_ecef(elsewhere)).norm(), 2.0);
  EXPECT_NEAR(first->attitude().heading_rad, 0.3, 1e-9);
  UniformRun& whole = drive.runs.front();
  const auto half = static_cast<std::ptrdiff_t>(whole.readings.size() / 2);
  UniformRun behind{whole.start_s + static_cast<double>(half + 200) * whole.dt_s,
                    whole.dt_s,
                    {whole.readings.begin() + half + 200, whole.readings.end()}};
  whole.readings.resize(static_cast<std::size_t>(half));
  drive.runs.push_back(std::move(behind));
  const auto second = find_start(drive, 1);
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(second->heading_from, HeadingFrom::Course);
  EXPECT_GT((second->state.position_ecef_m - to_ecef(elsewhere)).norm(), 5000.0);
  EXPECT_GT(second->state.velocity_ecef_m_s.norm(), 3.0);
  const auto evaluation = evaluate_drive(drive, {});
  ASSERT_TRUE(evaluation);
  EXPECT_EQ(evaluation->starts.size(), 2U);
}

TEST(DriveStart, ARunThatCannotBeginIsNamedWithTheReason) {
  Drive drive = simulated_drive(27);
  UniformRun& whole = drive.runs.front();
  const auto kept = static_cast<std::ptrdiff_t>(std::lround(300.0 / whole.dt_s));
  UniformRun behind{whole.start_s + 410.0, whole.dt_s, {}};
  behind.readings.assign(whole.readings.begin() + std::lround(410.0 / whole.dt_s), whole.readings.end());
  whole.readings.resize(static_cast<std::size_t>(kept));
  drive.runs.push_back(std::move(behind));  // the last ten seconds, at rest
  const auto evaluation = evaluate_drive(drive, {});
  ASSERT_TRUE(evaluation) << evaluation.error().message;
  ASSERT_FALSE(evaluation->notes.empty());
  EXPECT_NE(evaluation->notes.back().find("The filter cannot begin in the readings from 410 to 420 s: No fix moves"),
            std::string::npos)
      << evaluation->notes.back();
}

TEST(DriveStart, SaysThatADriveAtRestHasNoHeading) {
  Drive drive = simulated_drive(18);
  for (Fix& fix : drive.fixes) {
    fix.velocity_ned_m_s = Vector3::Zero();
    fix.has_course = false;
  }
  const auto start = find_start(drive, 0);
  ASSERT_FALSE(start);
  EXPECT_NE(start.error().message.find("heading is not observable"), std::string::npos);
}

TEST(DriveSimulation, CoversItselfWithAndWithoutAVelocityConstraint) {
  // The simulated truth has the side slip of the recorded attitude; the constraint must not count it as an error.
  const Drive drive = simulated_drive(19);
  for (const bool constrained : {false, true}) {
    FilterOptions options;
    if (constrained) {
      options.constraint.emplace();
    }
    const auto evaluation = evaluate_drive(drive, options);
    ASSERT_TRUE(evaluation);
    const auto prepared = PreparedDrive::make(drive, options);
    const auto simulated = simulate_outages(*prepared, evaluation->durations, {.runs = 8, .seed = 2});
    ASSERT_TRUE(simulated) << simulated.error().message;
    for (const SimulatedDuration& one : *simulated) {
      EXPECT_GT(one.coverage95.value, 0.91) << one.duration_s << (constrained ? " constrained" : "");
      EXPECT_NEAR(one.nees.value, 2.0, 0.5) << one.duration_s << (constrained ? " constrained" : "");
      EXPECT_TRUE(one.nees.ci95.contains(one.nees.value));
      EXPECT_TRUE(one.coverage95.ci95.contains(one.coverage95.value));
      EXPECT_TRUE(one.coverage95.ci95.contains(0.95)) << one.coverage95.ci95.low << " to " << one.coverage95.ci95.high;
    }
  }
}

TEST(DriveSimulation, HasTheOdometerThatWasMeasuredWith) {
  // Without readings of the wheel the simulated outages were those of fixes and unit alone, and measured ones with it
  // looked better than their simulation.
  Drive drive = simulated_drive(21);
  OdometerSource& source = drive.document.odometer.emplace();
  source.sd_m_s = 0.05;
  Random random(21, 8);
  for (const Fix& fix : drive.fixes) {
    drive.odometer.push_back({fix.time_s, 1.02 * fix.velocity_ned_m_s->head<2>().norm() + 0.05 * random.normal()});
  }
  FilterOptions with;
  with.odometer = true;
  with.odometer_scale = 0.02;
  FilterOptions without;
  std::array<double, 2> rms{};
  for (const bool wheel : {false, true}) {
    const auto evaluation = evaluate_drive(drive, wheel ? with : without);
    const auto prepared = PreparedDrive::make(drive, wheel ? with : without);
    ASSERT_TRUE(evaluation && prepared);
    const auto simulated = simulate_outages(*prepared, evaluation->durations, {.runs = 8, .seed = 2});
    ASSERT_TRUE(simulated);
    const SimulatedDuration& longest = simulated->back();
    rms[wheel ? 1 : 0] = longest.rms_m;
    EXPECT_NEAR(longest.nees.value, 2.0, 0.6) << wheel;
    EXPECT_GT(longest.coverage95.value, 0.9) << wheel;
    EXPECT_GT(longest.ratio.value, 0.75) << wheel;  // one measured drive has some ten such outages
    EXPECT_LT(longest.ratio.value, 1.5) << wheel;
  }
  EXPECT_LT(rms[1], 0.7 * rms[0]) << "the speed along the way is known";
}

TEST(DriveSimulation, TheRatiosIntervalHoldsTheScatterOfTheSimulationToo) {
  // Fewer simulated drives say less of the simulated rms: the interval of the ratio widens, where that of the measured
  // rms alone, divided by the simulated one, would stay.
  const Drive drive = simulated_drive(20);
  const auto evaluation = evaluate_drive(drive, {});
  const auto prepared = PreparedDrive::make(drive, {});
  ASSERT_TRUE(evaluation && prepared);
  const auto few = simulate_outages(*prepared, evaluation->durations, {.runs = 1, .seed = 3});
  const auto many = simulate_outages(*prepared, evaluation->durations, {.runs = 12, .seed = 3});
  ASSERT_TRUE(few && many);
  const auto width = [](const SimulatedDuration& one) {
    return (one.ratio.ci95.high - one.ratio.ci95.low) / one.ratio.value;
  };
  const Estimate& rms = evaluation->durations.front().rms_m;
  EXPECT_GT(width(few->front()), 1.1 * (rms.ci95.high - rms.ci95.low) / rms.value);
  EXPECT_GT(width(few->front()), width(many->front()));
}

}  // namespace
}  // namespace driftlab::drive
