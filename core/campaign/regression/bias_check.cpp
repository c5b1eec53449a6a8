#include "core/campaign/regression/bias_check.hpp"

#include "core/campaign/regression/session_means.hpp"
#include "core/signal/condition.hpp"
#include "core/signal/significant.hpp"
#include "core/signal/unit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace driftlab::regression {
namespace {

bool at_rest(const ComparedRecording& recording) {
  const auto condition = parse_condition(recording.condition);
  return condition && (condition->kind == ConditionKind::Static || condition->kind == ConditionKind::SixPosition);
}

/// The mean of each unit over one session [SI], weighted by samples. Channels without a unit or a mean have no share.
std::map<std::string, SessionFigure> means_of(const PowerUp& session) {
  struct Sum {
    double weighted = 0.0;
    double samples = 0.0;
    bool gyroscope = false;
  };
  std::map<std::string, Sum> sums;
  for (const ComparedRecording* recording : session.recordings) {
    for (const ComparedChannel& channel : recording->channels) {
      const std::string name = unit_name(*recording, channel.result);
      const driftlab::Unit unit = channel.result.parsed_unit();
      if (name.empty() || !channel.facts.mean || unit.dimension == Dimension::One || !at_rest(*recording)) {
        continue;
      }
      const auto samples = static_cast<double>(channel.result.samples);
      Sum& sum = sums[name];
      sum.weighted += samples * unit.to_si(*channel.facts.mean);
      sum.samples += samples;
      sum.gyroscope = unit.dimension == Dimension::AngularRate;
    }
  }
  std::map<std::string, SessionFigure> means;
  for (const auto& [name, sum] : sums) {
    if (sum.samples > 0.0) {
      means.emplace(name, SessionFigure{sum.weighted / sum.samples, sum.gyroscope});
    }
  }
  return means;
}

/// As people write it: `0.12 deg/s`, `-3.1 mg`.
std::string text_of(double value, bool gyroscope) {
  const auto unit = parse_unit(gyroscope ? "deg/s" : "mg");
  return significant(unit ? unit->from_si(value) : value) + (gyroscope ? " deg/s" : " mg");
}

/// A sentence where gravity lies along other axes than before, which no bias does.
std::string gravity_moved(const FiguresByUnit& figures) {
  constexpr double kOtherwise = 0.2 * kStandardGravity;
  const auto moved = [](const auto& one) { return one.second.gyroscope ? 0.0 : std::abs(one.second.difference()); };
  const auto most = std::max_element(figures.begin(), figures.end(),
                                     [&](const auto& a, const auto& b) { return moved(a) < moved(b); });
  if (most == figures.end() || moved(*most) < kOtherwise) {
    return "";
  }
  const double difference = most->second.difference();
  return most->first + ": the mean moved by " + (difference > 0.0 ? "+" : "") + text_of(difference, false) +
         "; the device lay otherwise, or its axes are swapped, turned or in another unit.";
}

}  // namespace

EventCheck check_bias(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate,
                      const BiasMargins& margins, double level) {
  const ShiftWords words{
      .check = "bias", .figure = "bias", .without = "no axis was recorded at rest in both arms", .text = text_of};
  const FiguresByUnit figures = arm_figures(baseline, candidate, means_of);
  EventCheck check = check_shift(figures, candidate, {margins.gyroscope, margins.accelerometer}, words, level);
  if (check.verdict != CheckVerdict::Fail && !(margins.accelerometer > 0.0)) {
    if (std::string sentence = gravity_moved(figures); !sentence.empty()) {
      check.verdict = CheckVerdict::Note;
      check.sentence = std::move(sentence);
    }
  }
  return check;
}

}  // namespace driftlab::regression
