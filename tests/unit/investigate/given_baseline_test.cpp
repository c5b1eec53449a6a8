/// What a given baseline says is known, and what a model that says too little does.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/investigate.hpp"
#include "core/investigate/search/simulate_channel.hpp"
#include "core/process/process_kind.hpp"
#include "core/process/random.hpp"
#include "core/process/sinusoid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace driftlab::investigate {
namespace {

constexpr double kRateHz = 20.0;
constexpr std::size_t kSamples = 6000;
constexpr double kDegree = std::numbers::pi / 180.0;

/// White noise of 0.1 deg/s a sample and a line of 0.04 deg/s at 3 Hz.
std::vector<double> with_line() {
  Random random(8);
  std::vector<double> rate(kSamples);
  for (std::size_t i = 0; i < rate.size(); ++i) {
    rate[i] = 0.1 * random.normal() + 0.04 * std::sin(2.0 * std::numbers::pi * 3.0 * static_cast<double>(i) / kRateHz);
  }
  return rate;
}

Study study_of(const std::vector<double>& rate) {
  RecordingSpec spec;
  spec.id = "a";
  spec.rate_hz = kRateHz;
  spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
  Study study;
  study.recordings.push_back(
      *make_study_recording(spec, {"gz"}, rate.size(), [&](std::size_t) { return std::span<const double>(rate); }));
  settle_channels(study);
  study.baseline.automatic = false;
  study.baseline.processes = {*make_process("white_noise", {0.1 * kDegree / std::sqrt(kRateHz)})};
  return study;
}

/// A model of white noise and a sinusoid was given for a recording of just these, and the report's first finding was
/// the sinusoid.
TEST(GivenBaseline, KnowsItsSinusoids) {
  const std::vector<double> rate = with_line();
  Study study = study_of(rate);
  const auto without = investigate(study);
  ASSERT_TRUE(without);
  ASSERT_EQ(without->findings.size(), 1U);
  EXPECT_EQ(without->findings[0].evidence.cause->name, "periodic_disturbance");
  study.baseline.processes.push_back(*make_process("sinusoid", {0.04 * kDegree, 3.0}));
  const auto with = investigate(study);
  ASSERT_TRUE(with);
  EXPECT_TRUE(with->findings.empty());
  ASSERT_FALSE(with->notes.empty());
  EXPECT_NE(with->notes.back().find("already"), std::string::npos) << with->notes.back();
}

TEST(GivenBaseline, FindsALineThatItsSinusoidIsNot) {
  const std::vector<double> rate = with_line();
  for (const std::vector<double>& other : {std::vector{0.04 * kDegree, 3.1}, std::vector{0.09 * kDegree, 3.0}}) {
    Study study = study_of(rate);
    study.baseline.processes.push_back(*make_process("sinusoid", other));
    const auto report = investigate(study);
    ASSERT_TRUE(report);
    ASSERT_EQ(report->findings.size(), 1U);
    EXPECT_EQ(report->findings[0].evidence.cause->name, "periodic_disturbance");
  }
}

/// A process that is simulated and has no law by which it could be taken out of a recording.
struct Hum : Sinusoid {
  static constexpr std::string_view kName = "hum";
};

TEST(GivenBaseline, SaysWhichProcessItCannotHold) {
  static const ProcessKind hum = kind_of<Hum>();
  const std::vector<double> rate = with_line();
  for (const bool of_column : {false, true}) {
    Study study = study_of(rate);
    (of_column ? study.baseline.by_channel["gz"] : study.baseline.processes).push_back({&hum, {0.04 * kDegree, 3.0}});
    const auto report = investigate(study);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::InvalidArgument);
    EXPECT_NE(report.error().message.find("the process hum, which an investigation can neither take out"),
              std::string::npos)
        << report.error().message;
  }
}

/// An effect that came without its second parameter made the simulation read behind the end of its values.
TEST(SimulatedChannel, LeavesOutAnEffectThatLacksAParameter) {
  const std::vector<double> blank(100, 0.0);
  for (const Cause& cause : cause_registry()) {
    Study study = study_of(blank);
    Baseline model = study.baseline;
    const auto all = cause.parameters.size();
    if (all == 0) {
      continue;  // nothing to lack
    }
    model.effects.push_back({std::string(cause.name), {}, {}, std::vector<double>(all - 1, 1.0)});
    const auto made =
        simulate_channel(model, study.recordings[0], "gz", {Quantity::AngularRate, "z", *parse_unit("deg/s")}, 1);
    ASSERT_EQ(made.left_out.size(), 1U) << cause.name;
    EXPECT_NE(made.left_out[0].find("lacks the parameter " + std::string(cause.parameters.back().name)),
              std::string::npos)
        << made.left_out[0];

    ChannelGroup group;
    Draft draft;
    draft.recording = study.recordings.data();
    draft.group = &group;
    draft.white.assign(100, 0.5);
    draft.slow = draft.mean = draft.shared = draft.white;
    Random random(1);
    inject(cause, draft, std::vector<double>(all - 1, 1.0), random);
    EXPECT_EQ(draft.white, std::vector<double>(100, 0.5)) << cause.name;
    EXPECT_EQ(draft.slow, std::vector<double>(100, 0.5)) << cause.name;
    EXPECT_EQ(draft.mean, std::vector<double>(100, 0.5)) << cause.name;
    EXPECT_TRUE(draft.output.empty() && draft.present.empty() && draft.stamp_error_s.empty()) << cause.name;
  }
}

}  // namespace
}  // namespace driftlab::investigate
