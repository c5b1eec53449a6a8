#include "core/campaign/regression/bias_check.hpp"

#include "core/campaign/regression/session_means.hpp"
#include "core/signal/condition.hpp"
#include "core/signal/significant.hpp"
#include "core/signal/unit.hpp"

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

}  // namespace

EventCheck check_bias(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate,
                      const BiasMargins& margins, double level) {
  const ShiftWords words{
      .check = "bias", .figure = "bias", .without = "no axis was recorded at rest in both arms", .text = text_of};
  return check_shift(arm_figures(baseline, candidate, means_of), candidate, {margins.gyroscope, margins.accelerometer},
                     words, level);
}

}  // namespace driftlab::regression
