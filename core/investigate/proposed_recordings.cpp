#include "core/investigate/proposed_recordings.hpp"

#include "core/investigate/study/inputs.hpp"
#include "core/signal/angle.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace driftlab::investigate {
namespace {

/// [s] Lengths between which a proposal is sought: what a lab records in a minute to an hour. Chosen.
constexpr double kShortest = 60.0;
constexpr double kLongest = 3600.0;
constexpr double kSlowRate = 36.0 * kDegree;  ///< [rad/s]; twice it is the other rate

/// The columns of one recording beside the channel itself.
struct Driven {
  std::function<double(double)> reference = {};    ///< [rad/s] at time t; empty: no reference column
  std::function<double(double)> temperature = {};  ///< [K]
};

class Maker {
 public:
  Maker(const ChannelGroup& group, std::deque<std::vector<double>>& memory)
      : group_(group), memory_(memory), rate_hz_(1.0 / group.members.front().recording->dt_s) {}

  void add(ProposedRecordings proposal, const std::vector<Condition>& conditions, double duration_s,
           const Driven& driven) {
    proposal.conditions = conditions;
    proposal.duration_s = duration_s;
    proposal.rate_hz = rate_hz_;
    proposal.columns.insert(proposal.columns.begin(), group_.column);
    for (std::size_t k = 0; k < conditions.size(); ++k) {
      std::string id = "proposed-" + std::to_string(k + 1);
      if (auto recording = blank(std::move(id), conditions[k], duration_s, driven)) {
        proposal.blank.push_back(*std::move(recording));
      }
    }
    if (proposal.blank.size() == conditions.size()) {
      made.push_back(std::move(proposal));
    }
  }

  std::vector<ProposedRecordings> made;

 private:
  Result<StudyRecording> blank(std::string id, const Condition& condition, double duration_s, const Driven& driven) {
    const auto samples = static_cast<std::size_t>(duration_s * rate_hz_);
    RecordingSpec spec;
    spec.id = std::move(id);
    spec.rate_hz = rate_hz_;
    spec.condition = condition;
    ColumnNames names;
    std::vector<std::size_t> place;
    const auto column = [&](const std::string& name, const ColumnRole& role, const std::function<double(double)>& at) {
      std::vector<double> values(samples, 0.0);
      for (std::size_t i = 0; at && i < samples; ++i) {
        values[i] = at(static_cast<double>(i) / rate_hz_);
      }
      names.push_back(name);
      spec.columns[name] = role;
      place.push_back(memory_.size());
      memory_.push_back(std::move(values));
    };
    column(group_.column, group_.role, {});
    if (driven.reference) {
      column("proposed reference", {Quantity::ReferenceAngularRate, group_.role.axis, *parse_unit("rad/s")},
             driven.reference);
    }
    if (driven.temperature) {
      column("proposed temperature", {Quantity::Temperature, "", *parse_unit("K")}, driven.temperature);
    }
    return make_study_recording(spec, names, samples,
                                [&](std::size_t i) { return std::span<const double>(memory_[place[i]]); });
  }

  const ChannelGroup& group_;
  std::deque<std::vector<double>>& memory_;
  double rate_hz_;
};

Condition rate_about(const std::string& axis, double rate) {
  Condition condition;
  condition.kind = ConditionKind::ConstantRate;
  condition.axis = axis;
  condition.value = rate;
  condition.unit = "deg/s";
  return condition;
}

Condition of_kind(ConditionKind kind) {
  Condition condition;
  condition.kind = kind;
  return condition;
}

}  // namespace

std::vector<ProposedRecordings> proposed_recordings(const ChannelGroup& group,
                                                    std::deque<std::vector<double>>& memory) {
  Maker maker(group, memory);
  const double usual = std::clamp(longest_s(group), kShortest, kLongest);
  const Condition rest = of_kind(ConditionKind::Static);
  maker.add({.title = "one recording at rest, four times as long"}, {rest}, std::min(4.0 * usual, 4.0 * kLongest), {});
  maker.add({.title = "four recordings at rest, switched off and on between them"}, {rest, rest, rest, rest}, usual,
            {});
  const double period = usual;
  maker.add({.title = "a recording at rest through rising and falling temperature", .columns = {"temperature"}}, {rest},
            2.0 * usual, {.temperature = [period](double t) {
              return 298.0 + 10.0 * std::sin(2.0 * std::numbers::pi * t / period);
            }});
  if (group.role.quantity == Quantity::AngularRate && axis_index(group.role.axis)) {
    const std::string& axis = group.role.axis;
    std::vector<Condition> rates;
    for (const double factor : {1.0, -1.0, 2.0, -2.0}) {
      rates.push_back(rate_about(axis, factor * kSlowRate));
    }
    maker.add({.title = "four constant rates, two of each sign"}, rates, std::max(kShortest, 0.5 * usual), {});
    maker.add({.title = "a turning profile with a reference column", .columns = {"reference rate"}},
              {of_kind(ConditionKind::Profile)}, usual, {.reference = [](double t) {
                double rate = 0.0;  // sinusoids whose periods have no common multiple within the recording
                for (const double f : {0.011, 0.037, 0.091, 0.23}) {
                  rate += 0.6 * kSlowRate * std::sin(2.0 * std::numbers::pi * f * t);
                }
                return rate;
              }});
  }
  return std::move(maker.made);
}

}  // namespace driftlab::investigate
