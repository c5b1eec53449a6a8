// A regression run from stored curves to its sentence.
#include "core/campaign/regression/gross_errors.hpp"
#include "core/campaign/regression/report.hpp"
#include "core/process/model.hpp"
#include "tests/unit/campaign/regression_channels.hpp"
#include "tests/unit/fit/shared_data.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
  EXPECT_EQ(report->baseline.sessions.size(), 3U);
  EXPECT_TRUE(report->notes[1].starts_with("3 recordings are one session")) << report->notes[1];
  made.candidate.recordings[2].began_s = 1e6;
  EXPECT_EQ(run_regression(made)->candidate.sessions.size(), 2U);
  made.candidate.recordings[2].session = made.candidate.recordings[1].session = "one";
  EXPECT_EQ(run_regression(made)->candidate.sessions.size(), 2U);
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
  made.candidate.recordings[0].declared_hz.reset();
  EXPECT_EQ(check(*run_regression(made), "rate").verdict, CheckVerdict::Fail);
}

TEST(RegressionReport, FactsFailWhateverTheNoiseSays) {
  Request made = request(0.05);
  made.candidate.recordings[1].channels[0].facts.saturated = 12;
  const auto report = run_regression(made);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->verdict, Verdict::Fail);
  EXPECT_EQ(check(*report, "full_scale").sessions, std::vector<std::string>{"1.1/1"});
  EXPECT_EQ(report->summary.verdict, check(*report, "full_scale").sentence);
  made.baseline.recordings[0].channels[0].facts.saturated = 1;
  EXPECT_EQ(run_regression(made)->verdict, Verdict::Pass);
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
      recording.channels[0].facts.flagged = before;
    }
    for (ComparedRecording& recording : made.candidate.recordings) {
      recording.channels[0].facts.flagged = now;
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

}  // namespace
}  // namespace driftlab::regression
