// A regression run from stored curves to its sentence.
#include "core/campaign/regression/gross_errors.hpp"
#include "core/campaign/regression/ratios.hpp"
#include "core/campaign/regression/report.hpp"
#include "core/process/model.hpp"
#include "core/signal/angle.hpp"
#include "tests/unit/campaign/regression_channels.hpp"
#include "tests/unit/fit/shared_data.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <stop_token>
#include <thread>

namespace driftlab::regression {
namespace {

/// A session of one gyroscope axis: white noise and a Gauss-Markov process, 25 Hz, ten minutes.
ComparedRecording session(const std::string& id, double white, std::uint64_t stream, double dt_s = 0.04) {
  Random random(51, stream);
  const Model model{*make_process("white_noise", {white}), *make_process("gauss_markov", {0.2, 0.5})};
  const std::vector<double> x = simulate(model, random, dt_s, static_cast<std::size_t>(600.0 / dt_s));
  return recording_of(id, {channel_of(x, dt_s, "angular_rate", "z", "deg/s")});
}

Recordings arm(const std::string& name, std::size_t sessions, double white, std::uint64_t stream) {
  Recordings made{"firmware=" + name, {}};
  for (std::size_t s = 0; s < sessions; ++s) {
    made.recordings.push_back(session(name + "/" + std::to_string(s), white, stream + s));
  }
  return made;
}

Request request(double white) {
  Request made;
  made.device = "imu-07";
  made.baseline = arm("1.0", 3, 0.05, 0);
  made.candidate = arm("1.1", 3, white, 10);
  return made;
}

const EventCheck& check(const Report& report, const std::string& name) {
  return *std::find_if(report.checks.begin(), report.checks.end(),
                       [&](const EventCheck& each) { return each.check == name; });
}

TEST(RegressionReport, PassesWhatDidNotChangeAndSaysHowFar) {
  const auto report = run_regression(request(0.05));
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->verdict, Verdict::Pass) << report->summary.verdict;
  EXPECT_GE(report->scope_s, 0.64);
  EXPECT_TRUE(report->summary.verdict.starts_with("No worse than 10 % (gyro) to ")) << report->summary.verdict;
  EXPECT_EQ(report->summary.level, "fine");
}

TEST(RegressionReport, SaysOfTheFilesWhatTheirQualitySaysEachSentenceOnce) {
  Request asked = request(0.05);
  const std::string frozen = "The readings of gz do not move in 3001 of 4000 samples.";
  Quality quality;
  quality.notes = {frozen};
  for (ComparedRecording& recording : asked.baseline.recordings) {
    recording.tell(quality);
  }
  asked.candidate.recordings.back().tell(quality);
  const auto report = run_regression(asked);
  ASSERT_TRUE(report) << report.error().message;
  const std::string told = "1.0/0, 1.0/1, 1.0/2 and 1 more: " + frozen;
  EXPECT_EQ(std::count(report->notes.begin(), report->notes.end(), told), 1);
  EXPECT_EQ(std::count(report->summary.details.begin(), report->summary.details.end(), told), 1);
}

TEST(RegressionReport, FailsWhatGrewAndNamesAxisSizeAndMargin) {
  const auto report = run_regression(request(0.09));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->verdict, Verdict::Fail);
  EXPECT_TRUE(report->summary.verdict.starts_with("gyro z is worse: +")) << report->summary.verdict;
  EXPECT_NE(report->summary.verdict.find("margin 10 %"), std::string::npos);
}

TEST(RegressionReport, EstimatesTheChangeThatWasMade) {
  // 0.5 in ln deviation on every scale, which the comparison of the same noise times exp(0.5) must find exactly in the
  // mean; three against three sessions of these lengths know a scale of 0.32 s (edf 1400) to 0.02.
  Request scaled = request(0.05);
  for (ComparedRecording& recording : scaled.candidate.recordings) {
    for (double& variance : recording.channels[0].result.haar.variance) {
      variance *= std::exp(1.0);
    }
  }
  const auto report = run_regression(scaled);
  ASSERT_TRUE(report);
  for (const ScaleReport& test : report->units[0].tests) {
    if (test.name.empty() && test.test.tau_s < 0.5) {
      EXPECT_NEAR(test.theta, 0.5, 0.06) << test.test.tau_s;
    }
    const RatioReport ratios = ratios_of(test);
    ASSERT_EQ(ratios.deviations.has_value(), test.name.empty());
    if (ratios.deviations) {
      const auto& [before, after] = *ratios.deviations;
      EXPECT_NEAR(after.value / before.value, ratios.ratio, 1e-12);
      EXPECT_TRUE(before.ci95.low < before.value && before.value < before.ci95.high) << test.test.tau_s;
      if (test.test.tau_s < 0.05) {  // nearly white: N of 0.05 over the root of tau
        EXPECT_NEAR(before.value / (0.05 * kDegree / std::sqrt(test.test.tau_s)), 1.0, 0.1);
      }
    }
  }
}

TEST(RegressionReport, CountsPartsOfOnePowerUpOnce) {
  Request made = request(0.05);
  for (std::size_t i = 0; i < 3; ++i) {
    made.candidate.recordings[i].began_s = 1000.0 * static_cast<double>(i);  // 600 s long: 400 s apart
  }
  const auto report = run_regression(made);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->candidate.sessions.size(), 1U);
  EXPECT_EQ(report->candidate.merged(), std::vector<std::string>{report->candidate.sessions[0].name});
  EXPECT_EQ(report->baseline.sessions.size(), 3U);
  EXPECT_TRUE(report->baseline.merged().empty());
  // One session says nothing of the scatter between sessions: the three of the baseline inform it.
  const std::vector<Report::InformingSession> informing = report->informing_sessions();
  ASSERT_EQ(informing.size(), 3U);
  for (std::size_t i = 0; i < informing.size(); ++i) {
    EXPECT_EQ(informing[i].label, "firmware=1.0");
    EXPECT_EQ(informing[i].session, report->baseline.sessions[i].name);
  }
  EXPECT_EQ(report->notes[1], "3 recordings are one session (1 Jan, 00:00-00:43) and count once.");
  made.candidate.recordings[2].began_s = 1e6;
  EXPECT_EQ(run_regression(made)->candidate.sessions.size(), 2U);
  made.candidate.recordings[2].session = made.candidate.recordings[1].session = "one";
  EXPECT_EQ(run_regression(made)->candidate.sessions.size(), 2U);
}

TEST(RegressionReport, ASessionOverMidnightNamesBothDays) {
  Request made = request(0.05);
  for (std::size_t i = 0; i < 3; ++i) {  // 22 November 2026, 23:55 UTC, and two at once with it
    made.candidate.recordings[i].began_s = 1795391700.0 + 60.0 * static_cast<double>(i);
  }
  const auto report = run_regression(made);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->notes[1], "3 recordings are one session (22 Nov, 23:55 to 23 Nov, 00:07) and count once.");
}

TEST(RegressionReport, StopsSoonAfterItIsAskedTo) {
  std::stop_source stop;
  std::size_t reports = 0;
  const RunControl control{stop.get_token(), [&](std::string_view /*stage*/, double /*fraction*/) {
                             ++reports;
                             stop.request_stop();
                           }};
  const auto report = run_regression(request(0.05), control);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::Cancelled);
  EXPECT_EQ(reports, 1U);
}

TEST(RegressionReport, ALongComparisonEndsWithinASecondOfTheStop) {
  // Six axes and sixty sessions of different lengths: each has a covariance of its own to factor, 81 times.
  Request made = request(0.05);
  for (std::size_t s = 0; s < 60; ++s) {
    ComparedRecording one =
        session("old/" + std::to_string(s), 0.05, 100 + s % 3, 0.04 + 1e-4 * static_cast<double>(s));
    made.history.push_back({"firmware=0." + std::to_string(s / 6), {}});
    made.history[s / 6].recordings.push_back(std::move(one));
  }
  std::erase_if(made.history, [](const Recordings& release) { return release.recordings.empty(); });
  const auto six = [](Recordings& arm) {
    for (ComparedRecording& recording : arm.recordings) {
      const ComparedChannel first = recording.channels.front();
      recording.channels.clear();
      for (int c = 0; c < 6; ++c) {
        recording.channels.push_back(first);
        recording.channels.back().result.quantity = c < 3 ? "angular_rate" : "specific_force";
        recording.channels.back().result.unit = c < 3 ? "deg/s" : "m/s^2";
        recording.channels.back().result.axis = std::string(1, "xyz"[c % 3]);
      }
    }
  };
  six(made.baseline);
  six(made.candidate);
  for (Recordings& release : made.history) {
    six(release);
  }
  std::stop_source stop;
  std::chrono::steady_clock::time_point asked;
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    asked = std::chrono::steady_clock::now();
    stop.request_stop();
  });
  const auto report = run_regression(made, {stop.get_token(), {}});
  const auto ended = std::chrono::steady_clock::now();
  later.join();
  ASSERT_FALSE(report) << "it ended before it was asked to: make it longer";
  EXPECT_EQ(report.error().code, ErrorCode::Cancelled);
  EXPECT_LT(std::chrono::duration<double>(ended - asked).count(), 1.0);
}

TEST(RegressionReport, TheOrderOfRecordingsChangesNothing) {
  Request made = request(0.06);
  const auto before = run_regression(made);
  std::swap(made.candidate.recordings[0], made.candidate.recordings[2]);
  std::swap(made.baseline.recordings[0], made.baseline.recordings[1]);
  const auto after = run_regression(made);
  ASSERT_TRUE(before && after);
  EXPECT_EQ(before->summary.verdict, after->summary.verdict);
  for (std::size_t t = 0; t < before->units[0].tests.size(); ++t) {
    EXPECT_EQ(before->units[0].tests[t].theta, after->units[0].tests[t].theta);
    EXPECT_EQ(before->units[0].tests[t].outcome.lower, after->units[0].tests[t].outcome.lower);
  }
}

TEST(RegressionReport, ComparesRecordingsOfDifferentRatesAtEqualTau) {
  Request made = request(0.05);
  for (std::size_t i = 0; i < 3; ++i) {
    made.candidate.recordings[i] = session("fast/" + std::to_string(i), 0.05, 20 + i, 0.02);
  }
  const auto report = run_regression(made);
  ASSERT_TRUE(report);
  EXPECT_DOUBLE_EQ(report->units[0].tau_s.front(), 0.04);
  EXPECT_EQ(check(*report, "rate").verdict, CheckVerdict::Ok);  // declared
  EXPECT_NE(report->verdict, Verdict::Fail) << report->summary.verdict;
  // One density at both rates: at equal tau nothing differs (sd of theta 0.02, as above).
  for (const ScaleReport& test : report->units[0].tests) {
    if (test.name.empty() && test.test.tau_s < 0.5) {
      EXPECT_NEAR(test.theta, 0.0, 0.06) << test.test.tau_s;
    }
  }
  EXPECT_NE(std::find(report->notes.begin(), report->notes.end(),
                      "Baseline 25 Hz, candidate 50 Hz: compared from 0.04 s on; 0.02 s exists only in the candidate."),
            report->notes.end());
  EXPECT_EQ(report->candidate.rates_hz, std::vector<double>{50.0});
  made.candidate.recordings[0].declared_hz.reset();
  EXPECT_EQ(check(*run_regression(made), "rate").verdict, CheckVerdict::Fail);
}

TEST(RegressionReport, FactsFailWhateverTheNoiseSays) {
  Request made = request(0.05);
  made.candidate.recordings[1].channels[0].facts.saturated = 12;
  const auto report = run_regression(made);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->verdict, Verdict::Fail);
  EXPECT_EQ(check(*report, "saturation").sessions, std::vector<std::string>{"1.1/1"});
  EXPECT_EQ(report->summary.verdict, check(*report, "saturation").sentence);
  made.baseline.recordings[0].channels[0].facts.saturated = 1;
  EXPECT_EQ(run_regression(made)->verdict, Verdict::Pass);
}

TEST(RegressionReport, LimitsOfFactsAreSettings) {
  Request made = request(0.05);
  made.candidate.recordings[1].channels[0].facts.repeated = 300;  // 2 % of 15,000
  EXPECT_EQ(check(*run_regression(made), "repeated").verdict, CheckVerdict::Fail);
  made.settings.limits.missing = 0.03;
  EXPECT_EQ(check(*run_regression(made), "repeated").verdict, CheckVerdict::Ok);
}

TEST(RegressionReport, ACauseFailsInTwoSessionsIfTheBaselineWasInvestigatedToo) {
  Request made = request(0.05);
  const auto found = [&](std::size_t sessions, bool baseline) {
    for (std::size_t i = 0; i < 3; ++i) {
      made.baseline.recordings[i].investigated = baseline;
      made.candidate.recordings[i].investigated = true;
      made.candidate.recordings[i].causes =
          i < sessions ? std::vector<std::string>{"aliasing"} : std::vector<std::string>{};
    }
    return check(*run_regression(made), "findings").verdict;
  };
  EXPECT_EQ(found(2, true), CheckVerdict::Fail);
  EXPECT_EQ(found(1, true), CheckVerdict::Note);
  EXPECT_EQ(found(0, true), CheckVerdict::Ok);
  EXPECT_EQ(found(3, false), CheckVerdict::Note) << "nobody knows whether the baseline has it";
}

/// The same on three axes, of which the candidate's variances are `factor` times as large from the scale `first` on.
Request on_three_axes(double factor, std::size_t first = 0) {
  Request made = request(0.05);
  for (Recordings* arm : {&made.baseline, &made.candidate}) {
    for (ComparedRecording& recording : arm->recordings) {
      const ComparedChannel z = recording.channels.front();
      for (const char* const axis : {"x", "y"}) {
        recording.channels.push_back(z);
        recording.channels.back().result.axis = axis;
      }
      for (ComparedChannel& channel : recording.channels) {
        std::vector<double>& variance = channel.result.haar.variance;
        for (std::size_t j = first; j < variance.size(); ++j) {
          variance[j] *= arm == &made.candidate ? factor : 1.0;
        }
      }
    }
  }
  return made;
}

TEST(RegressionReport, AClockThatIsOffIsANoteAndNotAFailure) {
  const auto report = run_regression(on_three_axes(1.12));  // a clock 12 % fast
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(check(*report, "time_base").verdict, CheckVerdict::Note);
  EXPECT_NE(check(*report, "time_base").sentence.find("% fast would"), std::string::npos);
  EXPECT_NE(report->verdict, Verdict::Fail) << report->summary.verdict;
}

TEST(RegressionReport, OnlyWhatAClockDoesIsCalledAClock) {
  const auto verdict = [](const Request& made) { return check(*run_regression(made), "time_base").verdict; };
  EXPECT_EQ(verdict(on_three_axes(1.12, 3)), CheckVerdict::Ok) << "the short scales did not move";
  EXPECT_EQ(verdict(on_three_axes(1.69)), CheckVerdict::Ok) << "no clock is 69 % fast";
  Request stamped = on_three_axes(1.12);
  Quality quality;
  quality.measured_rate_hz = 25.0;
  quality.clock_ratio = 1.0;
  for (Recordings* arm : {&stamped.baseline, &stamped.candidate}) {
    for (ComparedRecording& recording : arm->recordings) {
      recording.tell(quality);
    }
  }
  EXPECT_EQ(verdict(stamped), CheckVerdict::Ok) << "the clock is known";
}

/// Accelerometer readings on a lattice: what rounding makes equal is no lost sample, and moves with the noise.
TEST(RegressionReport, EqualNeighboursThatRoundingMakesAreNoFailure) {
  Random random(61, 0);
  const auto rounded = [&](const std::string& id, double sigma, double held) {
    std::vector<double> x(15000);
    std::size_t equal = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double value = std::round(sigma * random.normal() + 0.2);
      x[i] = i > 0 && random.uniform() < held ? x[i - 1] : value;
      equal += i > 0 && x[i] == x[i - 1] ? 1 : 0;
    }
    ComparedChannel channel = channel_of(x, 0.04, "specific_force", "z", "m/s^2");
    channel.facts.repeated = equal;
    channel.facts.resolution = 1.0;
    return recording_of(id, {channel});
  };
  Request unchanged;
  unchanged.device = "imu-07";
  unchanged.baseline = {"firmware=1.0", {rounded("a", 0.80, 0.0), rounded("b", 0.83, 0.0), rounded("c", 0.78, 0.0)}};
  unchanged.candidate = {"firmware=1.1", {rounded("d", 0.74, 0.0), rounded("e", 0.76, 0.0), rounded("f", 0.79, 0.0)}};
  const auto quiet = run_regression(unchanged);
  ASSERT_TRUE(quiet) << quiet.error().message;
  EXPECT_EQ(check(*quiet, "repeated").verdict, CheckVerdict::Ok) << check(*quiet, "repeated").sentence;
  Request made;
  made.device = "imu-07";
  made.baseline = {"firmware=1.0", {rounded("a", 3.0, 0.0), rounded("b", 3.0, 0.0)}};
  made.candidate = {"firmware=1.1", {rounded("c", 3.0, 0.2), rounded("d", 3.0, 0.2)}};
  const auto report = run_regression(made);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(check(*report, "repeated").verdict, CheckVerdict::Fail);
  EXPECT_NE(check(*report, "repeated").sentence.find("are held over from the one before"), std::string::npos);
}

TEST(RegressionReport, AStepThatTheNoiseHidesIsNotCompared) {
  Request made = request(0.05);
  made.baseline.recordings[0].channels[0].facts.resolution = 1e-7;
  made.candidate.recordings[0].channels[0].facts.resolution = 1e-5;  // digits of a float beside a noise of 0.3 deg/s
  EXPECT_EQ(check(*run_regression(made), "resolution").verdict, CheckVerdict::Ok);
  made.candidate.recordings[0].channels[0].facts.resolution = 0.1;
  EXPECT_EQ(check(*run_regression(made), "resolution").verdict, CheckVerdict::Fail);
}

TEST(RegressionReport, GravityAlongAnotherAxisIsTold) {
  Request made = request(0.05);
  for (Recordings* arm : {&made.baseline, &made.candidate}) {
    for (ComparedRecording& recording : arm->recordings) {
      ComparedChannel up = recording.channels.front();
      up.result.quantity = "specific_force";
      up.result.unit = "m/s^2";
      up.facts.mean = arm == &made.baseline ? 9.8 : 0.1;
      recording.channels.push_back(up);
      recording.channels.front().facts.mean = arm == &made.baseline ? 0.1 : 0.3;
    }
  }
  const auto report = run_regression(made);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(check(*report, "bias").verdict, CheckVerdict::Note);
  EXPECT_TRUE(check(*report, "bias").sentence.starts_with("accelerometer z: the mean moved by -"))
      << check(*report, "bias").sentence;
  EXPECT_NE(std::find(report->summary.details.begin(), report->summary.details.end(), check(*report, "bias").sentence),
            report->summary.details.end());
}

/// Noise with heavy tails as a characterisation would store it: what the robust estimator sees is 30 % less deviation.
TEST(RegressionReport, GrossErrorsInOneArmLetBothBeComparedByRobustVariances) {
  // The story: three power-ups of a sensor with heavy-tailed noise, unchanged; cables were touched in the baseline. Its
  // recordings were compared by robust variances and the candidate's by classical ones, and the run failed with +35 %.
  const auto stored = [](Recordings& arm, const char* verdict) {
    for (ComparedRecording& recording : arm.recordings) {
      ReportedHaar& haar = recording.channels[0].result.haar;
      haar.robust_variance.clear();
      for (const double variance : haar.variance) {
        haar.robust_variance.push_back(variance / (1.35 * 1.35));
      }
      haar.robust_efficiency.assign(haar.variance.size(), 0.6);
      recording.channels[0].result.contamination = verdict;
    }
  };
  Request made = request(0.05);
  stored(made.baseline, "contaminated");
  stored(made.candidate, "undecided");
  const auto report = run_regression(made);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(report->units[0].robust);
  EXPECT_NE(report->verdict, Verdict::Fail) << report->summary.verdict;
  for (const ScaleReport& test : report->units[0].tests) {
    if (test.name.empty() && test.test.tau_s < 0.5) {
      EXPECT_NEAR(test.theta, 0.0, 0.06) << test.test.tau_s;  // sd 0.02, as above
    }
  }
  // One estimator an arm, as it was: the candidate's robust curve put in the place of a classical one of that size.
  Request mixed = made;
  for (ComparedRecording& recording : mixed.candidate.recordings) {
    recording.channels[0].result.haar.robust_variance.clear();
  }
  EXPECT_EQ(run_regression(mixed)->verdict, Verdict::Fail) << "the old way";
}

TEST(RegressionReport, WhatCannotBeComparedIsInconclusive) {
  Request made = request(0.05);
  made.candidate.recordings[0].temperature_degc = 40.0;
  made.baseline.recordings[0].temperature_degc = 25.0;
  const auto warm = run_regression(made);
  EXPECT_EQ(warm->verdict, Verdict::Inconclusive);
  EXPECT_EQ(warm->comparability.front().item, "temperature");
  made = request(0.05);
  for (ComparedRecording& recording : made.baseline.recordings) {
    recording.channels.push_back(recording.channels.front());
    recording.channels.back().result.axis = "x";
    recording.channels.back().result.haar.variance[0] *= 1.01;
  }
  const auto lacking = run_regression(made);
  ASSERT_TRUE(lacking) << lacking.error().message;
  EXPECT_EQ(lacking->verdict, Verdict::Inconclusive);
  EXPECT_EQ(lacking->comparability.front().sentence, "Candidate lacks gyroscope x.");
}

TEST(RegressionReport, ASessionWithoutAnAxisOfItsArmIsNotLeftOutInSilence) {
  Request made = request(0.05);
  made.candidate.recordings[0].channels[0].result.axis = "";  // nobody can say what it measures
  const auto report = run_regression(made);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->verdict, Verdict::Inconclusive);
  ASSERT_EQ(report->comparability.size(), 1U);
  EXPECT_NE(report->comparability.front().sentence.find("lacks gyroscope"), std::string::npos);
}

TEST(RegressionReport, RefusesTheSameSamplesTwice) {
  Request made = request(0.05);
  made.candidate.recordings[0] = made.baseline.recordings[0];
  made.candidate.recordings[0].id = "copy";
  const auto report = run_regression(made);
  ASSERT_FALSE(report);
  EXPECT_NE(report.error().message.find("hold the same samples"), std::string::npos);
}

TEST(RegressionReport, TheBetaProbabilityIsThatOfClosedForms) {
  EXPECT_NEAR(beta_probability(0.3, 1.0, 1.0), 0.3, 1e-14);
  EXPECT_NEAR(beta_probability(0.3, 2.0, 1.0), 0.09, 1e-14);
  EXPECT_NEAR(beta_probability(0.9, 1.0, 3.0), 1.0 - 1e-3, 1e-14);
  EXPECT_NEAR(beta_probability(0.5, 0.5, 0.5), 0.5, 1e-13);
}

TEST(RegressionReport, MoreGrossErrorsThanTwiceAsManyFail) {
  Request made = request(0.05);
  const auto with = [&](std::size_t before, std::size_t now) {
    for (ComparedRecording& recording : made.baseline.recordings) {
      recording.channels[0].facts.bursts = before;
    }
    for (ComparedRecording& recording : made.candidate.recordings) {
      recording.channels[0].facts.bursts = now;
      recording.channels[0].result.contamination = "contaminated";
    }
    for (ComparedRecording& recording : made.baseline.recordings) {
      recording.channels[0].result.contamination = "contaminated";
    }
    return check(*run_regression(made), "contamination").verdict;
  };
  EXPECT_EQ(with(10, 15), CheckVerdict::Ok);
  EXPECT_EQ(with(10, 60), CheckVerdict::Fail);
  EXPECT_EQ(with(0, 1), CheckVerdict::Ok);
}

/// Fifteen minutes of a recording of the ADIS16405, six axes.
ComparedRecording adis(const std::vector<std::vector<double>>& columns, std::size_t from, const std::string& id,
                       double factor) {
  std::vector<ComparedChannel> channels;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::vector<double> x(columns[c].begin() + static_cast<std::ptrdiff_t>(from),
                          columns[c].begin() + static_cast<std::ptrdiff_t>(from + 90000));
    for (double& value : x) {
      value *= c == 0 ? factor : 1.0;
    }
    channels.push_back(channel_of(x, 0.01, c < 3 ? "angular_rate" : "specific_force", std::string(1, "xyz"[c % 3]),
                                  c < 3 ? "deg/s" : "g"));
  }
  return recording_of(id, std::move(channels));
}

TEST(RegressionReport, RecordedSessionsThatDidNotChangeDoNotFailAndATwofoldGyroDoes) {
  const auto shared = shared_data::folder();
  if (!shared) {
    GTEST_SKIP() << "SKIPPED: no recordings; set DRIFTLAB_SHARED to the directory that holds data/";
  }
  std::vector<std::vector<std::vector<double>>> recordings;
  for (const char* const name : {"adis_16405_imu1", "adis_16405_imu2", "adis_16405_imu3"}) {
    recordings.push_back(shared_data::read_npy_xz(*shared / "data" / (std::string(name) + ".npy.xz"), 6));
  }
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      if (a == b) {
        continue;
      }
      Request made;
      made.device = "adis";
      made.baseline.recordings = {adis(recordings[a], 100000, "before", 1.0)};
      made.candidate.recordings = {adis(recordings[b], 500000, "after", 1.0)};
      const auto same = run_regression(made);
      ASSERT_TRUE(same) << same.error().message;
      EXPECT_NE(same->verdict, Verdict::Fail) << a << " against " << b << ": " << same->summary.verdict;
      made.candidate.recordings = {adis(recordings[b], 500000, "after", 2.0)};
      const auto doubled = run_regression(made);
      EXPECT_EQ(doubled->verdict, Verdict::Fail) << a << " against " << b << ": " << doubled->summary.verdict;
    }
  }
}

TEST(RegressionRatios, ArePerCentAboveOrBelowOne) {
  EXPECT_NEAR(change_percent(1.1), 10.0, 1e-12);
  EXPECT_NEAR(change_percent(0.5), -50.0, 1e-12);
}

}  // namespace
}  // namespace driftlab::regression
